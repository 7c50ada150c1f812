// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "tests/scenes/makers.h"
#include "tests/scenes/meshes.h"

namespace pellucid::test_projections {
namespace {

using scenes::grid_description;
using scenes::make_volume;
using scenes::transfer;

constexpr Rgb<double> black{0, 0, 0}, white{1, 1, 1};

scenes::TransferPointer greys(double lower, double upper) {
  return transfer({{lower, 1, black}, {upper, 1, white}});
}

Layer projected(scenes::VolumePointer volume, LayerProjection projection,
                scenes::TransferPointer function = greys(0, 1)) {
  Layer layer{VolumeContent{std::move(volume), std::move(function), nullptr}};
  layer.projection = projection;
  return layer;
}

/// One pixel, whose ray goes from `origin` along `direction`.
Scene scene_of(std::vector<Layer> layers, Vec3<double> origin, Vec3<double> direction) {
  Scene scene;
  scene.layers = std::move(layers);
  scene.camera.projection = pellucid::Projection::orthographic;
  scene.camera.position = origin;
  scene.camera.focal_point = origin + direction;
  scene.camera.up = {0.3, -0.5, 0.8};
  scene.size = {1, 1};
  scene.integration.tolerance = smallest_tolerance;
  return scene;
}

struct Seen {
  double value;
  std::array<double, 4> pixel;
  double error;
};

Seen see(const Scene& scene) {
  RenderOptions options;
  options.outputs.values = options.outputs.error = true;
  options.machine.threads = 1;
  const Image image = render(scene, options).image;
  const auto& p = image.pixels[0];
  EXPECT_EQ(image.proved[0], 1);
  return {static_cast<double>(image.values[0]),
          {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]),
           static_cast<double>(p[3])},
          static_cast<double>(image.error[0])};
}

double value_of(const Scene& scene) {
  const Seen seen = see(scene);
  EXPECT_LT(seen.error, 1e-6);
  return seen.value;
}

/// f = x y (1 - z) in one cell; along the diagonal u² (1 - u), on a length of √3.
scenes::VolumePointer one_cell() {
  return make_volume<float>(grid_description({2, 2, 2}),
                            [](int i, int j, int k) { return i * j * (1 - k); });
}

double along_diagonal(LayerProjection projection, std::vector<Clip> clips = {}) {
  Scene scene = scene_of({projected(one_cell(), projection)}, {-1, -1, -1}, {1, 1, 1});
  scene.clips = std::move(clips);
  return value_of(scene);
}

TEST(Projections, OfAKnownCubic) {
  EXPECT_NEAR(along_diagonal(LayerProjection::maximum), 4.0 / 27, 1e-8);
  EXPECT_NEAR(along_diagonal(LayerProjection::minimum), 0, 1e-8);
  EXPECT_NEAR(along_diagonal(LayerProjection::mean), 1.0 / 12, 1e-8);
  EXPECT_NEAR(along_diagonal(LayerProjection::sum), std::sqrt(3.0) / 12, 1e-8);
}

TEST(Projections, ClipsCutExactly) {
  // Keeps u < 1/2, where the cubic rises to 1/8; its integral there is √3 (1/24 - 1/64).
  const std::vector<Clip> half{{ClipPlane{{0.5, 0.5, 0.5}, {-1, -1, -1}}}};
  EXPECT_NEAR(along_diagonal(LayerProjection::maximum, half), 0.125, 1e-8);
  EXPECT_NEAR(along_diagonal(LayerProjection::sum, half), std::sqrt(3.0) * 5 / 192, 1e-8);
  EXPECT_NEAR(along_diagonal(LayerProjection::mean, half), 5.0 / 96, 1e-8);
  // What is left on both sides of a ball counts once: u < 1/4 and u > 3/4.
  Clip ball{ClipSphere{{0.5, 0.5, 0.5}, std::sqrt(3.0) / 4}};
  ball.keep_inside = false;
  EXPECT_NEAR(along_diagonal(LayerProjection::maximum, {ball}), 9.0 / 64, 1e-8);
}

TEST(Projections, SumThroughAConstantBoxIsValueTimesLength) {
  const auto box = make_volume<std::uint8_t>(
      grid_description({30, 20, 11}, {3, -4, 5}, {0.5, 0.25, 2}), [](int, int, int) { return 7; });
  Layer layer = projected(box, LayerProjection::sum, greys(0, 200));
  Scene scene = scene_of({layer}, {-5, -1, 9.5}, {1, 0, 0});
  EXPECT_NEAR(value_of(scene), 7 * 14.5, 1e-5);
  // Moved and turned a quarter about z, the ray goes along y through 19 cells of 1/4.
  scene.layers[0].transform.matrix = {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
  scene.layers[0].transform.translation = {-4, -4.5, 0};
  EXPECT_NEAR(value_of(scene), 7 * 4.75, 1e-5);
  scene.layers[0].projection = LayerProjection::mean;
  EXPECT_EQ(value_of(scene), 7);
}

TEST(Projections, VacuumIsSkipped) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto holed = make_volume<float>(grid_description({9, 2, 2}), [&](int i, int, int) {
    return i == 4 ? nan : i < 4 ? 1 + i : 20 - i;
  });
  const auto seen = [&](LayerProjection projection) {
    return value_of(
        scene_of({projected(holed, projection, greys(0, 20))}, {-3, 0.4, 0.7}, {1, 0, 0}));
  };
  EXPECT_EQ(seen(LayerProjection::maximum), 15);
  EXPECT_EQ(seen(LayerProjection::minimum), 1);
  EXPECT_NEAR(seen(LayerProjection::sum), 3 * 2.5 + 3 * 13.5, 1e-5);
  EXPECT_NEAR(seen(LayerProjection::mean), 8, 1e-6);
}

TEST(Projections, OfMeshes) {
  const auto mesh = scenes::make_mesh(scenes::box_of_cubes(3));
  for (const auto& [projection, value] : {std::pair{LayerProjection::maximum, 1.0},
                                          {LayerProjection::minimum, -1.0},
                                          {LayerProjection::mean, 0.0},
                                          {LayerProjection::sum, 0.0}}) {
    Layer layer{MeshContent{
        scenes::on_mesh(mesh,
                        {scenes::at_points(*mesh, "x", [](const Vec3<double>& p) { return p.x; })}),
        greys(-1, 1)}};
    layer.projection = projection;
    EXPECT_NEAR(value_of(scene_of({layer}, {-4, 0.137, 0.281}, {1, 0, 0})), value, 1e-7)
        << projection_name(projection);
  }
}

TEST(Projections, RaysWithoutDataAreTransparent) {
  for (const auto projection : {LayerProjection::maximum, LayerProjection::minimum,
                                LayerProjection::mean, LayerProjection::sum}) {
    const Seen seen = see(scene_of({projected(one_cell(), projection)}, {5, 5, 5}, {1, 1, 1}));
    if (projection == LayerProjection::sum) {
      EXPECT_EQ(seen.value, 0);
    } else {
      EXPECT_TRUE(std::isnan(seen.value));
    }
    EXPECT_EQ(seen.pixel, (std::array<double, 4>{0, 0, 0, 0}));
    EXPECT_EQ(seen.error, 0);
  }
}

/// A ray for which rounding decides whether it meets the data says that it knows nothing.
TEST(Projections, RaysThatGrazeTheBoxAreUnknown) {
  const Seen seen =
      see(scene_of({projected(one_cell(), LayerProjection::maximum)}, {-1, 1, 0.5}, {1, 0, 0}));
  EXPECT_GE(seen.error, 1);
}

TEST(Projections, ShowTheColorWithTheShareOfTheLargestExtinction) {
  const auto function = transfer({{0, 0, {1, 0, 0}}, {0.1, 6, {0, 1, 0}}, {0.2, 12, {0, 0, 1}}});
  Layer layer = projected(one_cell(), LayerProjection::mean, function);
  const Seen seen = see(scene_of({layer}, {-1, -1, -1}, {1, 1, 1}));
  // 1/12 is 5/6 of the way to the second point.
  const double opacity = 5.0 / 6 * 0.5;
  EXPECT_NEAR(seen.pixel[3], opacity, 1e-7);
  EXPECT_NEAR(seen.pixel[0], opacity / 6, 1e-7);
  EXPECT_NEAR(seen.pixel[1], opacity * 5 / 6, 1e-7);
  EXPECT_EQ(seen.pixel[2], 0);
}

/// The value is within rounding of the table's jump: the pixel must not claim to know its side.
TEST(Projections, AValueAtAJumpIsAsUncertainAsTheJump) {
  const double value = 4.0 / 27;
  const auto function = transfer({{0, 1, black}, {value, 1, black}, {value, 1, white}});
  EXPECT_GE(see(scene_of({projected(one_cell(), LayerProjection::maximum, function)}, {-1, -1, -1},
                         {1, 1, 1}))
                .error,
            1);
  // Where the data themselves are the value, no rounding is in it.
  const auto saturated = make_volume<std::uint8_t>(grid_description({5, 4, 4}),
                                                   [](int i, int, int) { return i < 2 ? 9 : 255; });
  const Seen seen =
      see(scene_of({projected(saturated, LayerProjection::maximum,
                              transfer({{0, 1, black}, {255, 1, black}, {255, 1, white}}))},
                   {-1, 1.3, 1.6}, {1, 0.01, 0.02}));
  EXPECT_EQ(seen.pixel[0], 1);
  EXPECT_LT(seen.error, 1e-6);
}

TEST(Projections, LieOverEverythingElseInTheOrderOfTheList) {
  const auto constant =
      make_volume<float>(grid_description({3, 3, 3}), [](int, int, int) { return 0.5; });
  const auto tinted = [&](Rgb<double> color, double opacity) {
    return projected(constant, LayerProjection::maximum,
                     transfer({{0.25, opacity, color}, {0.75, opacity, color}, {1, 1, black}}));
  };
  const Layer haze{VolumeContent{constant, transfer({{0, 0.3, {0.2, 0.4, 0.6}}}), nullptr}};
  const Layer red = tinted({1, 0, 0}, 0.25), blue = tinted({0, 0, 1}, 0.5);
  const auto pixel = [](std::vector<Layer> layers) {
    const Scene scene = scene_of(std::move(layers), {-3, 0.7, 1.1}, {1, 0, 0});
    return render(scene).image.pixels[0];
  };
  const double hazed = -std::expm1(-0.6);
  // Red below blue, both over the haze, wherever that is in the list.
  const double below_blue = 0.25 + 0.75 * 0.2 * hazed;
  for (const auto& layers : {std::vector<Layer>{haze, red, blue}, {red, haze, blue}}) {
    const auto p = pixel(layers);
    EXPECT_NEAR(static_cast<double>(p[0]), 0.5 * below_blue, 1e-6);
    EXPECT_NEAR(static_cast<double>(p[2]), 0.5 + 0.5 * 0.75 * 0.6 * hazed, 1e-6);
    EXPECT_NEAR(static_cast<double>(p[3]), 1 - 0.5 * 0.75 * std::exp(-0.6), 1e-6);
  }
  const auto other = pixel({haze, blue, red});
  EXPECT_NEAR(static_cast<double>(other[0]), 0.25 + 0.75 * 0.5 * 0.2 * hazed, 1e-6);
  Layer hidden = blue;
  hidden.visible = false;
  EXPECT_EQ(pixel({haze, red, hidden}), pixel({haze, red}));
}

TEST(Projections, SamplesAreAveragedAsColors) {
  Scene scene =
      scene_of({projected(one_cell(), LayerProjection::maximum)}, {0.5, 0.5, 3}, {0, 0, -1});
  scene.camera.up = {0, 1, 0};
  scene.camera.parallel_scale = 1;
  scene.samples = 2;
  // Rays at (0, 0), (1, 0), (0, 1), (1, 1), moved inside by a scale a little smaller.
  scene.camera.parallel_scale = 0.9;
  const double a = 0.05, b = 0.95;
  EXPECT_NEAR(static_cast<double>(render(scene).image.pixels[0][0]),
              (a * a + 2 * a * b + b * b) / 4, 1e-6);
}

std::string refusal(const Scene& scene, bool values = false) {
  try {
    RenderOptions options;
    options.outputs.values = values;
    render(scene, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_refused(const Scene& scene, const std::string& text, bool values = false) {
  const std::string message = refusal(scene, values);
  EXPECT_NE(message.find(text), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

/// Projections are no integrals: they are the same over layers that are sampled.
TEST(Projections, LieOverSampledLayers) {
  Layer haze = projected(one_cell(), LayerProjection::maximum);
  haze.projection.reset();
  Scene scene =
      scene_of({projected(one_cell(), LayerProjection::maximum), haze}, {-1, -1, -1}, {1, 1, 1});
  const Image exact = render(scene).image;
  scene.integration.method = Method::midpoint;
  scene.integration.step = 0.01;
  const Image sampled = render(scene).image;
  for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_NEAR(sampled.pixels[i][c], exact.pixels[i][c], 4e-3f) << i;
    }
  }
}

TEST(Projections, RefuseWhatHasNoOneValue) {
  const Scene good =
      scene_of({projected(one_cell(), LayerProjection::maximum)}, {-1, -1, -1}, {1, 1, 1});
  EXPECT_EQ(refusal(good, true), "");
  Scene scene = good;
  scene.samples = 2;
  expect_refused(scene, "samples is 2", true);
  scene = good;
  scene.layers.push_back(scene.layers[0]);
  expect_refused(scene, "2 visible layers are projected", true);
  scene.layers[0].visible = false;
  EXPECT_EQ(refusal(scene, true), "");
  scene = good;
  scene.layers[0].projection.reset();
  expect_refused(scene, "0 visible layers are projected", true);
  const auto labels = std::make_shared<const LabelVolume>(
      make_volume<std::uint8_t>(grid_description({2, 2, 2}), [](int i, int, int) { return i; }));
  scene = good;
  std::get<VolumeContent>(scene.layers[0].content).mask =
      std::make_shared<const LabelMask>(labels, std::vector<LabelMask::Choice>{{1, greys(0, 1)}});
  expect_refused(scene, "has a mask");
  scene.layers[0].content = LabelContent{
      labels, std::make_shared<const LabelTable>(std::vector<LabelStyle>{{1, "", white, 1}})};
  expect_refused(scene, "has labels");
  scene.layers[0].content = ChannelsContent{
      std::make_shared<const Channels>(std::vector<Channel>{{"a", "", one_cell()}}),
      std::make_shared<const MultivariateTransferFunction>(
          1, std::vector<GaussianPrimitive>{},
          std::vector<ChannelTransferFunction>{{0, TransferFunction({{0, 1, white}})}})};
  expect_refused(scene, "a function of several");
}

TEST(Projections, DefaultFunctionsAreGreysOverTheRange) {
  const auto volume = make_volume<std::int16_t>(grid_description({3, 5, 2}, {0, 0, 0}, {2, 1, 3}),
                                                [](int i, int j, int) { return 10 * i - j; });
  const auto ends = [](const TransferFunction& function) {
    EXPECT_EQ(function.points().front().extinction, 1);
    EXPECT_EQ(function.points().back().extinction, 1);
    EXPECT_EQ(function.points().back().color, white);
    return std::pair(function.points().front().value, function.points().back().value);
  };
  EXPECT_EQ(ends(projection_transfer_function(*volume, LayerProjection::maximum)),
            std::pair(-4.0, 20.0));
  // The longest edge is 4.
  EXPECT_EQ(ends(projection_transfer_function(*volume, LayerProjection::sum)),
            std::pair(-16.0, 80.0));
  const auto flat =
      make_volume<float>(grid_description({2, 2, 2}), [](int, int, int) { return 3; });
  EXPECT_EQ(projection_transfer_function(*flat, LayerProjection::mean).points().size(), 1u);
}

}  // namespace
}  // namespace pellucid::test_projections
