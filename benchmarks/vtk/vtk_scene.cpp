// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/vtk/vtk_scene.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkContourValues.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/support/one_layer.h"

namespace pellucid::bench {
namespace {

/// Points of the opacity function on each stretch of the scene's: where O bends most, at a depth of
/// 1 per unit distance, chords of a 32nd leave it by 1.2e-4.
constexpr int points_per_stretch = 32;

/// Two points of a jump may not have one place in VTK's functions.
double apart(const TransferFunction& transfer_function, std::size_t i) {
  const auto& points = transfer_function.points();
  const double value = points[i].value;
  const bool after_a_jump = i > 0 && points[i - 1].value == value;
  return after_a_jump ? value + 1e-9 * (points.back().value - points.front().value) : value;
}

void set_opacity(const TransferFunction& transfer_function, double unit,
                 vtkPiecewiseFunction* opacity) {
  const auto& points = transfer_function.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double front = apart(transfer_function, i);
    opacity->AddPoint(front, -std::expm1(-points[i].extinction * unit));
    if (i + 1 == points.size() || points[i].extinction == points[i + 1].extinction) continue;
    for (int k = 1; k < points_per_stretch; ++k) {
      const double share = static_cast<double>(k) / points_per_stretch;
      const double extinction = std::lerp(points[i].extinction, points[i + 1].extinction, share);
      opacity->AddPoint(std::lerp(front, points[i + 1].value, share),
                        -std::expm1(-extinction * unit));
    }
  }
}

/// VTK's isosurfaces, in place of the medium. Each has the color and the opacity of its value.
void show_surfaces(const std::vector<Isosurface>& surfaces, vtkVolumeMapper* mapper,
                   vtkVolumeProperty* property) {
  vtkNew<vtkPiecewiseFunction> opacity;
  vtkNew<vtkColorTransferFunction> color;
  mapper->SetBlendModeToIsoSurface();
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Isosurface& surface = surfaces[i];
    property->GetIsoSurfaceValues()->SetValue(static_cast<int>(i), surface.value);
    opacity->AddPoint(surface.value, surface.opacity);
    color->AddRGBPoint(surface.value, surface.color.r, surface.color.g, surface.color.b);
  }
  property->SetScalarOpacity(opacity);
  property->SetColor(color);
}

}  // namespace

std::string not_for_vtk(const Scene& scene) {
  const Volume::Description& d = test::volume_of(scene).volume->description();
  for (const auto& axis : d.coordinates) {
    if (!axis.empty()) return "its volume mappers take no rectilinear grid";
  }
  if (d.centering == Centering::cell) return "its volume mappers end at the outermost data values";
  if (scene.samples != 1) return "it renders one sample per pixel";
  return {};
}

vtkSmartPointer<vtkImageData> vtk_image(const Scene& scene) {
  const Volume::Description& d = test::volume_of(scene).volume->description();
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(d.dimensions.data());
  image->SetSpacing(d.placement.spacing.x, d.placement.spacing.y, d.placement.spacing.z);
  std::visit(
      [&](const auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        vtkNew<vtkAOSDataArrayTemplate<Value>> array;
        array->SetName("data");
        array->SetArray(const_cast<Value*>(values.data()), static_cast<vtkIdType>(values.size()),
                        1);
        image->GetPointData()->SetScalars(array);
      },
      test::volume_of(scene).volume->data());
  return image;
}

vtkSmartPointer<vtkVolume> vtk_volume(const Scene& scene, vtkVolumeMapper* mapper) {
  const double unit = test::volume_of(scene).volume->voxel_size();
  vtkNew<vtkPiecewiseFunction> opacity;
  set_opacity(*test::volume_of(scene).transfer_function, unit, opacity);
  vtkNew<vtkColorTransferFunction> color;
  const auto& points = test::volume_of(scene).transfer_function->points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Rgb<double>& c = points[i].color;
    color->AddRGBPoint(apart(*test::volume_of(scene).transfer_function, i), c.r, c.g, c.b);
  }

  const auto volume = vtkSmartPointer<vtkVolume>::New();
  vtkVolumeProperty* property = volume->GetProperty();
  property->SetScalarOpacity(opacity);
  property->SetColor(color);
  property->SetScalarOpacityUnitDistance(unit);
  property->SetInterpolationTypeToLinear();
  property->ShadeOff();
  if (const std::optional<Shading>& shading = scene.layers.front().shading) {
    property->ShadeOn();
    property->SetAmbient(shading->ambient);
    property->SetDiffuse(shading->diffuse);
    property->SetSpecular(shading->specular);
    property->SetSpecularPower(shading->power);
  }

  const std::vector<Isosurface>& surfaces = scene.layers.front().isosurfaces;
  if (!surfaces.empty()) show_surfaces(surfaces, mapper, property);

  const GridPlacement& placement = test::volume_of(scene).volume->description().placement;
  vtkNew<vtkMatrix4x4> matrix;
  for (int c = 0; c < 3; ++c) {
    const Vec3<double>& column = placement.direction.column[c];
    matrix->SetElement(0, c, column.x);
    matrix->SetElement(1, c, column.y);
    matrix->SetElement(2, c, column.z);
  }
  matrix->SetElement(0, 3, placement.origin.x);
  matrix->SetElement(1, 3, placement.origin.y);
  matrix->SetElement(2, 3, placement.origin.z);
  volume->SetUserMatrix(matrix);
  volume->SetMapper(mapper);
  return volume;
}

vtkSmartPointer<vtkRenderer> vtk_renderer(const Scene& scene) {
  const auto renderer = vtkSmartPointer<vtkRenderer>::New();
  renderer->SetBackground(0, 0, 0);
  renderer->SetBackgroundAlpha(0);
  vtkCamera* camera = renderer->GetActiveCamera();
  const Camera& c = scene.camera;
  camera->SetPosition(c.position.x, c.position.y, c.position.z);
  camera->SetFocalPoint(c.focal_point.x, c.focal_point.y, c.focal_point.z);
  camera->SetViewUp(c.up.x, c.up.y, c.up.z);
  camera->SetParallelProjection(c.projection == Projection::orthographic);
  camera->SetViewAngle(c.vertical_angle);
  camera->SetParallelScale(c.parallel_scale);
  return renderer;
}

}  // namespace pellucid::bench
