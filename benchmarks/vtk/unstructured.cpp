// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/vtk/unstructured.h"

#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkLogger.h>
#include <vtkMultiThreader.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkRayCastImageDisplayHelper.h>
#include <vtkRenderWindow.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridBunykRayCastFunction.h>
#include <vtkUnstructuredGridLinearRayIntegrator.h>
#include <vtkUnstructuredGridPreIntegration.h>
#include <vtkUnstructuredGridVolumeRayCastMapper.h>
#include <vtkUnstructuredGridVolumeZSweepMapper.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "benchmarks/vtk/vtk_scene.h"
#include "tests/support/one_layer.h"

namespace pellucid::bench {
namespace {

/// Takes the picture that a mapper would draw.
class Taker : public vtkRayCastImageDisplayHelper {
 public:
  static Taker* New();
  Taker(const Taker&) = delete;
  Taker& operator=(const Taker&) = delete;

  void RenderTexture(vtkVolume*, vtkRenderer*, int memory[2], int*, int used[2], int origin[2],
                     float, unsigned char* pixels) override {
    std::copy_n(memory, 2, memory_);
    std::copy_n(used, 2, used_);
    std::copy_n(origin, 2, origin_);
    pixels_ = pixels;
  }
  void RenderTexture(vtkVolume*, vtkRenderer*, int*, int*, int*, int*, float,
                     unsigned short*) override {}
  void RenderTexture(vtkVolume*, vtkRenderer*, vtkFixedPointRayCastImage*, float) override {}

  /// Row 0 was at the bottom.
  Image picture(ImageSize size) const {
    Image image;
    image.width = size.width;
    image.height = size.height;
    image.pixels.resize(static_cast<std::size_t>(size.width) *
                        static_cast<std::size_t>(size.height));
    for (int y = 0; pixels_ != nullptr && y < used_[1]; ++y) {
      const int row = size.height - 1 - (origin_[1] + y);
      for (int x = 0; x < used_[0]; ++x) {
        const int column = origin_[0] + x;
        if (row < 0 || row >= size.height || column < 0 || column >= size.width) continue;
        for (int c = 0; c < 4; ++c) {
          image.at(column, row)[static_cast<std::size_t>(c)] =
              static_cast<float>(pixels_[4 * (y * memory_[0] + x) + c]) / 255.0F;
        }
      }
    }
    return image;
  }

 protected:
  Taker() = default;
  ~Taker() override = default;

 private:
  int memory_[2] = {0, 0}, used_[2] = {0, 0}, origin_[2] = {0, 0};
  const unsigned char* pixels_ = nullptr;
};
vtkStandardNewMacro(Taker);

/// A mapper whose picture goes to a Taker.
template <class Mapper>
class Taken : public Mapper {
 public:
  static Taken* New() {
    auto* made = new Taken;
    made->InitializeObjectBase();
    return made;
  }
  Image picture(ImageSize size) const { return taker_->picture(size); }

 protected:
  Taken() {
    if (this->ImageDisplayHelper != nullptr) this->ImageDisplayHelper->Delete();
    this->ImageDisplayHelper = taker_;
    taker_->Register(this);
  }

 private:
  vtkNew<Taker> taker_;
};

/// Another integrator, and what goes through it. For one thread.
class Counter : public vtkUnstructuredGridVolumeRayIntegrator {
 public:
  static Counter* New();
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;

  vtkSmartPointer<vtkUnstructuredGridVolumeRayIntegrator> inner;
  MeshCrossings found;

  void Initialize(vtkVolume* volume, vtkDataArray* scalars) override {
    inner->Initialize(volume, scalars);
  }
  void Integrate(vtkDoubleArray* lengths, vtkDataArray* front, vtkDataArray* back,
                 float color[4]) override {
    const auto finite = [&] {
      return std::all_of(color, color + 4, [](float x) { return std::isfinite(x); });
    };
    const bool was_finite = finite();
    inner->Integrate(lengths, front, back, color);
    found.segments += static_cast<std::uint64_t>(lengths->GetNumberOfTuples());
    if (was_finite && !finite()) ++found.nan_pixels;
  }

 protected:
  Counter() = default;
  ~Counter() override = default;
};
vtkStandardNewMacro(Counter);

using RayCaster = Taken<vtkUnstructuredGridVolumeRayCastMapper>;
using Sweeper = Taken<vtkUnstructuredGridVolumeZSweepMapper>;

bool in_line(double x0, double y0, double x1, double y1, double x2, double y2) {
  return std::fabs((y1 - y0) * (x2 - x0) - (y2 - y0) * (x1 - x0)) <= 1e-12 * (x2 - x0);
}

/// Whether the color is as straight at point i as if the point were not there.
bool is_straight(const std::vector<TransferFunction::Point>& points, std::size_t i) {
  if (i == 0 || i + 1 == points.size()) return false;
  const auto &a = points[i - 1], &b = points[i], &c = points[i + 1];
  return in_line(a.value, a.color.r, b.value, b.color.r, c.value, c.color.r) &&
         in_line(a.value, a.color.g, b.value, b.color.g, c.value, c.color.g) &&
         in_line(a.value, a.color.b, b.value, b.color.b, c.value, c.color.b);
}

/// What one scene needs for itself.
struct Stage {
  vtkNew<vtkVolume> volume;
  vtkSmartPointer<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;  ///< asked for its size alone: it is never opened
  ImageSize size;

  Stage(const MeshScene& shown, const Box<double>& bounds) : size(shown.scene.size) {
    vtkNew<vtkPiecewiseFunction> opacity;
    vtkNew<vtkColorTransferFunction> color;
    const auto& points = test::mesh_of(shown.scene).univariate()->points();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& p = points[i];
      opacity->AddPoint(p.value, p.extinction);
      if (shown.colors_apart && is_straight(points, i)) continue;
      color->AddRGBPoint(p.value, p.color.r, p.color.g, p.color.b);
    }
    vtkVolumeProperty* property = volume->GetProperty();
    property->SetScalarOpacity(opacity);
    property->SetColor(color);
    property->SetScalarOpacityUnitDistance(1);
    property->SetInterpolationTypeToLinear();
    property->ShadeOff();

    renderer = vtk_renderer(shown.scene);
    const CameraFrame<double> frame = make_camera_frame(shown.scene.camera, size);
    const Vec3<double> here = frame.ray(0, 0, 0, 1).origin;
    const Vec3<double> shift =
        0.5 * (frame.ray(1, 0, 0, 1).origin - here) - 0.5 * (frame.ray(0, 1, 0, 1).origin - here);
    vtkCamera* camera = renderer->GetActiveCamera();
    const Vec3<double> from = shown.scene.camera.position + shift;
    const Vec3<double> to = shown.scene.camera.focal_point + shift;
    camera->SetPosition(from.x, from.y, from.z);
    camera->SetFocalPoint(to.x, to.y, to.z);
    renderer->AddVolume(volume);
    window->SetSize(size.width, size.height);
    window->AddRenderer(renderer);
    renderer->ResetCameraClippingRange(bounds.lower.x, bounds.upper.x, bounds.lower.y,
                                       bounds.upper.y, bounds.lower.z, bounds.upper.z);
  }

  template <class Mapper>
  TimedFrame frame(Mapper* mapper) {
    volume->SetMapper(mapper);
    const auto start = std::chrono::steady_clock::now();
    mapper->Render(renderer, volume);
    TimedFrame timed;
    timed.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    timed.image = mapper->picture(size);
    return timed;
  }
};

vtkSmartPointer<RayCaster> ray_caster(vtkUnstructuredGrid* grid,
                                      vtkUnstructuredGridBunykRayCastFunction* function,
                                      vtkUnstructuredGridVolumeRayIntegrator* integrator) {
  const auto mapper = vtkSmartPointer<RayCaster>::New();
  mapper->SetInputData(grid);
  mapper->SetRayCastFunction(function);
  mapper->SetRayIntegrator(integrator);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetImageSampleDistance(1);
  mapper->IntermixIntersectingGeometryOff();
  return mapper;
}

}  // namespace

struct VtkMesh {
  vtkNew<vtkUnstructuredGrid> grid;
  Box<double> bounds;
  /// Its list of triangles is made once.
  vtkNew<vtkUnstructuredGridBunykRayCastFunction> function;
  vtkSmartPointer<Sweeper> sweeper = vtkSmartPointer<Sweeper>::New();
};

std::shared_ptr<VtkMesh> vtk_mesh(const UnstructuredGrid& tetrahedra, const Box<double>& bounds) {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_ERROR);
  auto made = std::make_shared<VtkMesh>();
  made->bounds = bounds;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(tetrahedra.points.size()));
  vtkNew<vtkFloatArray> values;
  values->SetName("value");
  values->SetNumberOfTuples(static_cast<vtkIdType>(tetrahedra.points.size()));
  for (std::size_t i = 0; i < tetrahedra.points.size(); ++i) {
    const Vec3<double>& p = tetrahedra.points[i];
    points->SetPoint(static_cast<vtkIdType>(i), p.x, p.y, p.z);
  }
  std::visit(
      [&](const auto& given) {
        vtkIdType i = 0;
        for (const auto value : given) values->SetValue(i++, static_cast<float>(value));
      },
      tetrahedra.arrays.at(0).values);
  made->grid->SetPoints(points);
  made->grid->GetPointData()->SetScalars(values);
  made->grid->Allocate(static_cast<vtkIdType>(tetrahedra.shapes.size()));
  for (std::size_t t = 0; t < tetrahedra.corners.size(); t += 4) {
    const std::int32_t* corner = tetrahedra.corners.data() + t;
    const vtkIdType ids[4] = {corner[0], corner[1], corner[2], corner[3]};
    made->grid->InsertNextCell(VTK_TETRA, 4, ids);
  }
  made->sweeper->SetInputData(made->grid);
  made->sweeper->AutoAdjustSampleDistancesOff();
  made->sweeper->SetImageSampleDistance(1);
  made->sweeper->IntermixIntersectingGeometryOff();
  return made;
}

std::vector<MeshContender> vtk_mesh_contenders(const std::shared_ptr<VtkMesh>& mesh,
                                               const MeshScene& shown) {
  vtkMultiThreader::SetGlobalMaximumNumberOfThreads(VTK_MAX_THREADS);
  const auto stage = std::make_shared<Stage>(shown, mesh->bounds);
  const auto cast = [=](const char* name, vtkUnstructuredGridVolumeRayIntegrator* integrator,
                        vtkUnstructuredGridVolumeRayIntegrator* to_count) {
    const auto mapper = ray_caster(mesh->grid, mesh->function, integrator);
    const vtkSmartPointer<vtkUnstructuredGridVolumeRayIntegrator> inner = to_count;
    return MeshContender{name, true,
                         [=](int threads) {
                           mapper->SetNumberOfThreads(threads);
                           return stage->frame(mapper.Get());
                         },
                         [=] {
                           vtkNew<Counter> counter;
                           counter->inner = inner;
                           const auto one = ray_caster(mesh->grid, mesh->function, counter);
                           one->SetNumberOfThreads(1);
                           stage->frame(one.Get());
                           return counter->found;
                         }};
  };
  vtkNew<vtkUnstructuredGridLinearRayIntegrator> linear;
  vtkNew<vtkUnstructuredGridPreIntegration> preintegration;
  return {
      cast("VTK linear", linear, linear), cast("VTK default", nullptr, preintegration),
      MeshContender{"VTK ZSweep", false, [=](int) { return stage->frame(mesh->sweeper.Get()); }}};
}

}  // namespace pellucid::bench
