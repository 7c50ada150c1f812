// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "expect_error.h"
#include "pellucid/scene/scene.h"

namespace pellucid::test_methods {
namespace {

std::shared_ptr<const Volume> grid() {
  Volume::Description description;
  description.dimensions = {2, 2, 2};
  return std::make_shared<Volume>(description,
                                  VolumeData(DataArray<float>(std::vector<float>(8, 0.5F))));
}

std::shared_ptr<const MeshChannels> mesh() {
  TetrahedralMesh::Description description;
  description.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  description.tetrahedra = {{0, 1, 2, 3}};
  MeshChannel channel;
  channel.name = "a";
  channel.values = DataArray<float>({0, 1, 2, 3});
  return std::make_shared<MeshChannels>(std::make_shared<TetrahedralMesh>(description),
                                        std::vector<MeshChannel>{channel});
}

Scene scene_of(bool of_mesh, bool of_gaussians) {
  Scene scene;
  const auto gaussians = std::make_shared<const MultivariateTransferFunction>(
      1, std::vector<GaussianPrimitive>{{{0}, {0.5}, {{4}}, 1, {1, 1, 1}}});
  const auto table = std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 1, {1, 1, 1}}});
  if (of_mesh) {
    MeshContent content{mesh(), table};
    if (of_gaussians) content.transfer_function = gaussians;
    scene.layers = {{content}};
  } else if (of_gaussians) {
    scene.layers = {{ChannelsContent{
        std::make_shared<Channels>(std::vector<Channel>{{"a", "", grid()}}), gaussians}}};
  } else {
    scene.layers = {{VolumeContent{grid(), table, nullptr}}};
  }
  check_data(scene);
  return scene;
}

constexpr Method all_methods[] = {Method::exact,    Method::rectangle,     Method::taylor,
                                  Method::midpoint, Method::trapezoid,     Method::simpson,
                                  Method::linear,   Method::preintegrated, Method::kniss,
                                  Method::gaussian, Method::homogeneous,   Method::average,
                                  Method::partial};

/// All but these are refused, with a line that has the parts.
void expect_methods(Scene scene, const std::vector<Method>& taken) {
  for (const Method method : all_methods) {
    scene.integration.method = method;
    const std::string name(method_name(method));
    SCOPED_TRACE(name);
    if (std::find(taken.begin(), taken.end(), method) != taken.end()) {
      EXPECT_NO_THROW(check_method(scene));
    } else {
      expect_error([&] { check_method(scene); },
                   {"integration: the method ", name.c_str(), "but the scene has", "take "});
    }
  }
}

TEST(CheckMethod, OfAVolume) {
  expect_methods(scene_of(false, false),
                 {Method::exact, Method::rectangle, Method::taylor, Method::midpoint,
                  Method::trapezoid, Method::simpson, Method::linear, Method::preintegrated});
}

TEST(CheckMethod, OfChannels) {
  expect_methods(scene_of(false, true), {Method::exact, Method::rectangle, Method::taylor,
                                         Method::midpoint, Method::trapezoid, Method::simpson,
                                         Method::linear, Method::kniss, Method::gaussian});
}

TEST(CheckMethod, OfAMesh) {
  expect_methods(scene_of(true, false),
                 {Method::exact, Method::rectangle, Method::taylor, Method::midpoint,
                  Method::trapezoid, Method::simpson, Method::linear, Method::preintegrated,
                  Method::homogeneous, Method::average, Method::partial});
}

TEST(CheckMethod, OfAMeshWithGaussians) {
  expect_methods(scene_of(true, true),
                 {Method::exact, Method::rectangle, Method::taylor, Method::midpoint,
                  Method::trapezoid, Method::simpson, Method::linear, Method::homogeneous,
                  Method::average, Method::partial, Method::kniss, Method::gaussian});
}

/// Each layer has to suit the method, but those that are not seen or projected.
TEST(CheckMethod, OfSeveralLayers) {
  Scene scene = scene_of(true, true);
  scene.layers.push_back(scene_of(false, false).layers[0]);
  expect_methods(
      scene, {Method::exact, Method::rectangle, Method::taylor, Method::midpoint, Method::trapezoid,
              Method::simpson, Method::linear, Method::kniss, Method::gaussian});
  scene.layers[0].visible = false;
  expect_methods(
      scene, {Method::exact, Method::rectangle, Method::taylor, Method::midpoint, Method::trapezoid,
              Method::simpson, Method::linear, Method::preintegrated});
}

}  // namespace
}  // namespace pellucid::test_methods
