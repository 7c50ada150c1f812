// SPDX-License-Identifier: Apache-2.0
//
// The methods for comparison on meshes, whole frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/scenes/meshes.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_mesh_sampler {
namespace {

using scenes::MeshChannelsPointer;
using scenes::MeshPointer;
using Place = Vec3<double>;

constexpr Method models[] = {Method::homogeneous, Method::average, Method::linear, Method::partial};

Scene scene_of(MeshChannelsPointer mesh) {
  Scene scene;
  test::mesh_of(scene).mesh = std::move(mesh);
  scene.size = {31, 29};
  scene.camera = default_camera(world_corners(scene), scene.size);
  scene.integration.tolerance = smallest_tolerance;
  return scene;
}

Image image_of(Scene scene, Method method, bool depth = false) {
  scene.integration.method = method;
  RenderOptions options;
  options.machine.threads = 1;
  options.outputs.depth = depth;
  return render(scene, options).image;
}

struct Difference {
  double largest = 0, rms = 0;
};

Difference difference(const Image& a, const Image& b) {
  Difference result;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double off = std::fabs(static_cast<double>(a.pixels[i][c] - b.pixels[i][c]));
      EXPECT_TRUE(std::isfinite(off)) << "pixel " << i;
      result.largest = std::max(result.largest, off);
      result.rms += off * off;
    }
  }
  result.rms = std::sqrt(result.rms / (4.0 * static_cast<double>(a.pixels.size())));
  return result;
}

/// In [0, 1] within [-1,1]³.
double wave(const Place& p) {
  return 0.5 + 0.28 * std::sin(2 * p.x + 1.7 * p.y) * std::cos(2.1 * p.z - 0.4) +
         0.2 * std::sin(1.3 * p.y - p.z);
}

double other_wave(const Place& p) {
  return 0.5 + 0.3 * std::cos(1.9 * p.x - 0.7 * p.z) + 0.19 * std::sin(2.3 * p.y + p.x);
}

/// Crooked cubes whose points have the value i/4: of a cell's data none passes a multiple of it.
/// One point has none.
MeshChannelsPointer in_layers() {
  constexpr int n = 4;
  const auto place = [](int i, int j, int k) {
    const auto crooked = [](int a, int b, int c) {
      return -1 + 2.0 * a / n + 0.12 * std::sin(5.0 * a + 3.0 * b + 7.0 * c);
    };
    return Place{crooked(i, j, k), crooked(j, k, i), crooked(k, i, j)};
  };
  const MeshPointer mesh = scenes::make_mesh(scenes::tetrahedralize({{n, n, n}, place}));
  std::vector<double> values;
  values.reserve(mesh->points().size());
  for (std::size_t p = 0; p < mesh->points().size(); ++p) {
    values.push_back(static_cast<double>(p % (n + 1)) / n);
  }
  values[62] = std::numeric_limits<double>::quiet_NaN();
  MeshChannel channel;
  channel.name = "layer";
  channel.values = DataArray<double>(std::move(values));
  return scenes::on_mesh(mesh, {channel});
}

std::shared_ptr<const TransferFunction> points_at_layers() {
  return std::make_shared<TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 0.2, {0.9, 0.1, 0.1}},
                                           {0.25, 3, {0.1, 0.9, 0.3}},
                                           {0.5, 0.1, {0.2, 0.4, 1}},
                                           {0.75, 2, {1, 0.9, 0.2}},
                                           {1, 1, {0.3, 0.2, 0.7}}});
}

TEST(MeshSampler, LinearIsExactWhereNoControlPointIsInsideOfACell) {
  Scene scene = scene_of(in_layers());
  test::mesh_of(scene).transfer_function = points_at_layers();
  const Image exact = image_of(scene, Method::exact);
  EXPECT_LE(difference(image_of(scene, Method::linear), exact).largest, 3e-7);
  EXPECT_LE(difference(image_of(scene, Method::partial), exact).largest, 1e-4);
  EXPECT_GE(difference(image_of(scene, Method::homogeneous), exact).largest, 1e-3);
  EXPECT_GE(difference(image_of(scene, Method::average), exact).largest, 1e-3);
}

TEST(MeshSampler, LinearMissesWhatIsBetweenTheEnds) {
  Scene scene = scene_of(in_layers());
  test::mesh_of(scene).transfer_function =
      std::make_shared<TransferFunction>(std::vector<TransferFunction::Point>{
          {0.55, 0, {1, 1, 1}}, {0.6, 20, {1, 1, 1}}, {0.65, 0, {1, 1, 1}}});
  EXPECT_GE(difference(image_of(scene, Method::linear), image_of(scene, Method::exact)).largest,
            0.3);
}

TEST(MeshSampler, AllAreExactWhereCellsAreConstant) {
  const MeshPointer mesh = scenes::make_mesh(scenes::box_of_cubes(5));
  Scene scene = scene_of(scenes::on_mesh(mesh, {scenes::at_cells(*mesh, "wave", wave)}));
  test::mesh_of(scene).transfer_function = points_at_layers();
  const Image exact = image_of(scene, Method::exact);
  for (const Method method : models) {
    // Equal colors leave nothing of the table's error.
    EXPECT_LE(difference(image_of(scene, method), exact).largest, 3e-7) << method_name(method);
  }
}

/// The order in which a method comes near the exact one between 8³ and 16³ cubes.
template <class SceneOn>
double order_of(Method method, const SceneOn& scene_on, double& last) {
  std::vector<double> errors;
  for (const int cubes : {4, 8, 16}) {
    const Scene scene = scene_on(scenes::make_mesh(scenes::box_of_cubes(cubes)));
    errors.push_back(difference(image_of(scene, method), image_of(scene, Method::exact)).rms);
  }
  EXPECT_LT(errors[1], errors[0]) << method_name(method);
  last = errors[2];
  return std::log2(errors[1] / errors[2]);
}

TEST(MeshSampler, AllComeNearTheExactOneInSecondOrder) {
  const auto scene_on = [](const MeshPointer& mesh) {
    Scene scene = scene_of(scenes::on_mesh(mesh, {scenes::at_points(*mesh, "wave", wave)}));
    // So many points that the function is smooth to any cell.
    std::vector<TransferFunction::Point> points;
    for (int i = 0; i <= 400; ++i) {
      const double v = i / 400.0;
      points.push_back(
          {v, 1 + std::sin(5 * v), {0.5 + 0.5 * std::cos(4 * v), v, 0.5 - 0.5 * std::cos(6 * v)}});
    }
    test::mesh_of(scene).transfer_function = std::make_shared<TransferFunction>(std::move(points));
    return scene;
  };
  for (const Method method : models) {
    double last = 0;
    const double order = order_of(method, scene_on, last);
    EXPECT_GE(order, 1.8) << method_name(method);
    EXPECT_LE(order, 2.2) << method_name(method);
    EXPECT_LE(last, 1e-3) << method_name(method);
    RecordProperty(std::string(method_name(method)), std::to_string(order));
  }
}

Scene gaussian_scene(const MeshPointer& mesh, std::vector<GaussianPrimitive> primitives) {
  Scene scene = scene_of(scenes::on_mesh(mesh, {scenes::at_points(*mesh, "wave", wave),
                                                scenes::at_points(*mesh, "other", other_wave)}));
  test::mesh_of(scene).transfer_function =
      std::make_shared<MultivariateTransferFunction>(2, std::move(primitives));
  return scene;
}

GaussianPrimitive blob(double a, double b, double width, double extinction, Rgb<double> color) {
  return {{0, 1}, {a, b}, matrix_from_widths({width, 1.3 * width}), extinction, color};
}

TEST(MeshSampler, OneNarrowGaussianIsNotMissed) {
  const Scene scene = gaussian_scene(scenes::make_mesh(scenes::box_of_cubes(6)),
                                     {blob(0.45, 0.5, 0.02, 60, {0.9, 0.5, 0.2})});
  const Image exact = image_of(scene, Method::exact);
  EXPECT_LE(difference(image_of(scene, Method::gaussian), exact).largest, 3e-7);
  const double kniss = difference(image_of(scene, Method::kniss), exact).largest;
  EXPECT_LE(kniss, 2e-3);
  EXPECT_GE(kniss, 1e-6);
  EXPECT_GE(difference(image_of(scene, Method::homogeneous), exact).largest, 0.1);
}

TEST(MeshSampler, GaussiansOfSeveralColorsComeNearTheExactImage) {
  const auto scene_on = [](const MeshPointer& mesh) {
    return gaussian_scene(mesh, {blob(0.4, 0.5, 0.3, 1.5, {0.9, 0.2, 0.1}),
                                 blob(0.6, 0.6, 0.25, 2, {0.1, 0.4, 0.9})});
  };
  for (const Method method : {Method::homogeneous, Method::average, Method::linear, Method::partial,
                              Method::gaussian, Method::kniss}) {
    double last = 0;
    const double order = order_of(method, scene_on, last);
    RecordProperty(std::string(method_name(method)), std::to_string(order));
    EXPECT_LE(last, 1e-3) << method_name(method);
    // Short pieces make the error of Kniss's erf larger, not smaller.
    if (method == Method::kniss) continue;
    EXPECT_GE(order, 1.8) << method_name(method);
    EXPECT_LE(order, 2.2) << method_name(method);
  }
}

TEST(MeshSampler, TheDepthIsWhereHalfOfTheOpacityIsReached) {
  constexpr double extinction = 1.5;
  const MeshPointer mesh = scenes::make_mesh(scenes::box_of_cubes(3));
  Scene scene = scene_of(scenes::on_mesh(mesh, {scenes::at_points(*mesh, "wave", wave)}));
  test::mesh_of(scene).transfer_function = std::make_shared<TransferFunction>(
      std::vector<TransferFunction::Point>{{0, extinction, {1, 1, 1}}});
  scene.camera = {};
  scene.camera.projection = Projection::orthographic;
  scene.camera.position = {0, 0, 4};
  scene.camera.parallel_scale = 0.9;
  scene.size = {5, 5};
  // From z = 1 on, through a box of length 2.
  const double opacity = -std::expm1(-2 * extinction);
  const double place = 3 - std::log1p(-0.5 * opacity) / extinction;
  for (const Method method : models) {
    const Image image = image_of(scene, method, true);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      EXPECT_NEAR(image.depth[i], place, 1e-6) << method_name(method);
      EXPECT_NEAR(image.pixels[i][3], opacity, 1e-6) << method_name(method);
    }
  }
}

TEST(MeshSampler, NothingIsSaidOfTheError) {
  Scene scene = scene_of(in_layers());
  test::mesh_of(scene).transfer_function = points_at_layers();
  scene.integration.method = Method::linear;
  RenderOptions options;
  options.outputs.error = true;
  const Image image = render(scene, options).image;
  for (const float error : image.error) EXPECT_GE(error, 1);
  for (const auto proved : image.proved) EXPECT_EQ(proved, 0);
}

}  // namespace
}  // namespace pellucid::test_mesh_sampler
