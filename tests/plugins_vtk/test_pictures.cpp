// SPDX-License-Identifier: Apache-2.0
//
// The window's framebuffer against render() of the same scene.
#include <gtest/gtest.h>

#include "mapper_core.h"
#include "pellucid/cpu/render.h"
#include "tests/plugins_vtk/stage.h"
#include "vtkPellucidVolumeMapper.h"

namespace pellucid::test {
namespace {

constexpr double half_a_step = 0.5 / 255;
/// Of the display's 15 bits.
constexpr double rounding = 1.0 / 32767;

Image truth_of(Stage& stage, vtkPellucidVolumeMapper* mapper, vtkVolume* volume) {
  Scene scene = mapper->GetCore().scene_of(*mapper, {}, *stage.renderer, *volume);
  scene.integration.tolerance = 1e-5;
  return render(scene).image;
}

TEST(VtkPictures, PerspectiveIsTheIntegral) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image());
  vtkVolume* const volume = stage.add(mapper, soft_property());
  stage.look();
  const Messages messages;
  const Image shown = stage.picture();
  EXPECT_EQ(messages.text(), "");
  EXPECT_EQ(stage.gl_errors(), "");
  const Image truth = truth_of(stage, mapper, volume);
  const double off = largest_difference(shown, truth);
  EXPECT_LE(off, half_a_step + mapper->GetTolerance() + rounding);
  EXPECT_TRUE(mapper->GetExact());
  EXPECT_LE(mapper->GetLargestError(), mapper->GetTolerance());
}

}  // namespace
}  // namespace pellucid::test
