// SPDX-License-Identifier: Apache-2.0
//
// What vtkPropPicker finds in a window with volumes.
#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkPolyDataMapper.h>
#include <vtkPropPicker.h>
#include <vtkSphereSource.h>

#include <array>

#include "mapper_core.h"
#include "override_mappers.h"
#include "tests/plugins_vtk/stage.h"
#include "vtkPellucidVolumeMapper.h"

namespace pellucid::test {
namespace {

vtkSmartPointer<vtkActor> ball_at(double x, double y, double z, double radius) {
  vtkNew<vtkSphereSource> source;
  source->SetCenter(x, y, z);
  source->SetRadius(radius);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

vtkProp* found_at(Stage& stage, double x, double y) {
  vtkNew<vtkPropPicker> picker;
  picker->Pick(x, y, 0, stage.renderer);
  return picker->GetViewProp();
}

TEST(Picking, FindsVolumesAndWhatIsInFrontOfThem) {
  const vtkSmartPointer<vtkGPUVolumeRayCastMapper> override_mapper =
      vtkSmartPointer<vtkGPUVolumeRayCastMapper>::Take(plugin::new_gpu_override());
  const auto own = vtkSmartPointer<vtkPellucidVolumeMapper>::New();
  for (vtkVolumeMapper* const mapper : {static_cast<vtkVolumeMapper*>(override_mapper.Get()),
                                        static_cast<vtkVolumeMapper*>(own.Get())}) {
    Stage stage(96, 64);
    mapper->SetInputDataObject(ball_image());
    vtkVolume* const volume = stage.add(mapper, soft_property());
    const std::array center{volume->GetCenter()[0], volume->GetCenter()[1], volume->GetCenter()[2]};
    // Beside the volume, and later in front of it and behind it.
    const auto actor = ball_at(center[0] + 40, center[1], center[2], 4);
    stage.renderer->AddActor(actor);
    stage.renderer->ResetCamera();
    stage.camera->SetFocalPoint(center[0] + 12, center[1], center[2]);
    stage.camera->SetPosition(center[0] + 12, center[1], center[2] + 150);
    stage.renderer->ResetCameraClippingRange();
    stage.window->Render();
    const auto pixel = [&](double x) {
      stage.renderer->SetWorldPoint(x, center[1], center[2], 1);
      stage.renderer->WorldToDisplay();
      return std::array{stage.renderer->GetDisplayPoint()[0], stage.renderer->GetDisplayPoint()[1]};
    };
    const auto middle = pixel(center[0]), aside = pixel(center[0] + 40);
    EXPECT_EQ(found_at(stage, middle[0], middle[1]), volume);
    EXPECT_EQ(found_at(stage, aside[0], aside[1]), actor);
    EXPECT_EQ(found_at(stage, 1, 1), nullptr);
    const auto front = ball_at(center[0], center[1], center[2] + 40, 4);
    stage.renderer->AddActor(front);
    stage.renderer->ResetCameraClippingRange();
    EXPECT_EQ(found_at(stage, middle[0], middle[1]), front);
    front->AddPosition(0, 0, -90);
    stage.renderer->ResetCameraClippingRange();
    EXPECT_EQ(found_at(stage, middle[0], middle[1]), volume);
    EXPECT_EQ(stage.gl_errors(), "");
    // What is known of the last picture stays.
    stage.window->Render();
    const double error = plugin::core_of(mapper)->outcome.largest_error;
    found_at(stage, middle[0], middle[1]);
    EXPECT_EQ(plugin::core_of(mapper)->outcome.largest_error, error);
    EXPECT_TRUE(plugin::core_of(mapper)->outcome.exact);
  }
}

}  // namespace
}  // namespace pellucid::test
