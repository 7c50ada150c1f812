// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/vtk/fixed_point.h"

#include <vtkFixedPointRayCastImage.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkNew.h>

#include <chrono>
#include <map>
#include <memory>

#include "benchmarks/vtk/vtk_scene.h"
#include "tests/support/one_layer.h"

namespace pellucid::bench {
namespace {

/// One mapper for each step: it makes its tables anew where the step changes.
struct Caster {
  vtkNew<vtkFixedPointVolumeRayCastMapper> mapper;
  vtkSmartPointer<vtkVolume> volume;
};

void cast(Caster& caster, vtkRenderer* renderer) {
  double none[3] = {0, 0, 0};
  int extent[6] = {0, 0, 0, 0, 0, 0};
  vtkFixedPointVolumeRayCastMapper* mapper = caster.mapper;
  mapper->PerImageInitialization(renderer, caster.volume, 0, none, none, extent);
  mapper->PerVolumeInitialization(renderer, caster.volume);
  mapper->PerSubVolumeInitialization(renderer, caster.volume, 0);
  mapper->RenderSubVolume();
}

/// Of 15 bits, over the part of the viewport that the volume covers, row 0 at the bottom.
Image picture(vtkFixedPointRayCastImage* cast, ImageSize size) {
  Image image;
  image.width = size.width;
  image.height = size.height;
  image.pixels.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  int memory[2], used[2], origin[2];
  cast->GetImageMemorySize(memory);
  cast->GetImageInUseSize(used);
  cast->GetImageOrigin(origin);
  const unsigned short* values = cast->GetImage();
  for (int y = 0; y < used[1]; ++y) {
    const int row = size.height - 1 - (origin[1] + y);
    for (int x = 0; x < used[0]; ++x) {
      const int column = origin[0] + x;
      if (row < 0 || row >= size.height || column < 0 || column >= size.width) continue;
      for (int c = 0; c < 4; ++c) {
        image.at(column, row)[static_cast<std::size_t>(c)] =
            static_cast<float>(values[4 * (y * memory[0] + x) + c]) / 32767.0F;
      }
    }
  }
  return image;
}

}  // namespace

Contender fixed_point_contender(const Scene& scene, vtkRenderer* renderer, vtkImageData* image,
                                int threads) {
  const auto casters = std::make_shared<std::map<double, std::unique_ptr<Caster>>>();
  const vtkSmartPointer<vtkRenderer> view = renderer;
  const vtkSmartPointer<vtkImageData> data = image;
  Contender contender{"VTK fixed point", Knob::step, {}, {}};
  contender.render = [=](double step) {
    std::unique_ptr<Caster>& caster = (*casters)[step];
    if (!caster) {
      caster = std::make_unique<Caster>();
      caster->mapper->SetInputData(data);
      caster->mapper->AutoAdjustSampleDistancesOff();
      caster->mapper->SetImageSampleDistance(1);
      caster->mapper->SetSampleDistance(
          static_cast<float>(step * test::volume_of(scene).volume->voxel_size()));
      caster->mapper->IntermixIntersectingGeometryOff();
      caster->mapper->SetNumberOfThreads(threads);
      if (scene.layers.front().projection == LayerProjection::maximum) {
        caster->mapper->SetBlendModeToMaximumIntensity();
      }
      caster->volume = vtk_volume(scene, caster->mapper);
      cast(*caster, view);
    }
    const auto start = std::chrono::steady_clock::now();
    cast(*caster, view);
    TimedFrame frame;
    frame.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    frame.image = picture(caster->mapper->GetRayCastImage(), scene.size);
    return frame;
  };
  return contender;
}

}  // namespace pellucid::bench
