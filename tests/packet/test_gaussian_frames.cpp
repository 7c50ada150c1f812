// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/packet/against_one_by_one.h"
#include "tests/packet/random_frames.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid {
namespace {

/// Random scenes of several variables behind Gaussians, by either way to go through them.
class GaussianFrames : public RandomFrames, public testing::WithParamInterface<GaussianMarch> {
 protected:
  GaussianFrames() : RandomFrames(29) {}

  static RenderOptions options() {
    RenderOptions options;
    options.machine.gaussian_march = GetParam();
    return options;
  }
  static void compare(const Scene& scene, const std::vector<double>& tolerances, Seen& seen) {
    pellucid::compare(scene, tolerances, seen, Promise::within_tolerance, options());
  }
  /// At least so many frames in steps, where these are what is tested.
  static void expect_steps(const Seen& seen, int frames) {
    if (GetParam() == GaussianMarch::steps) {
      EXPECT_GE(seen.with_strides, frames);
    } else {
      EXPECT_EQ(seen.with_strides, 0);
    }
  }

  int whole(int a, int b) { return std::uniform_int_distribution<int>(a, b)(random_); }

  /// Between 0 and 1: waves, ridges that are sharp, noise, single values that stand out.
  std::shared_ptr<const Volume> volume(const std::array<int, 3>& values, Vec3<double> spacing,
                                       Centering centering, double offset, double size) {
    const int kind = whole(0, 7);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    // On planes of blocks, and beside them.
    const double bend = 8 * whole(1, 3) - 1 + whole(0, 2);
    const double shortest = power(2.5, 60), noise = kind == 4 ? power(1e-4, 0.3) : 0;
    struct Wave {
      Vec3<double> k;
      double phase;
    };
    std::vector<Wave> waves;
    for (int n = whole(1, 3); n > 0; --n) {
      Vec3<double> k{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      k = k * (2 * std::numbers::pi / (shortest * uniform(1, 3) * length(k)));
      waves.push_back({k, uniform(0, 6.3)});
    }
    std::vector<double> data;
    for (int z = 0; z < values[2]; ++z) {
      for (int y = 0; y < values[1]; ++y) {
        for (int x = 0; x < values[0]; ++x) {
          double sum = 0;
          for (const Wave& w : waves) {
            const double s = std::sin(dot(w.k, Vec3<double>{x + 0.0, y + 0.0, z + 0.0}) + w.phase);
            sum += kind == 3 ? 2 * std::fabs(s) - 1 : s;
          }
          double value = 0.5 + 0.5 * sum / static_cast<double>(waves.size());
          value += noise * uniform(-1, 1);
          if (kind == 5 && random_() % 97 == 0) value = uniform(0, 1);
          if (kind == 6) value = std::fabs(x - bend) / 20 + 0.01 * std::fabs(y - 8.0);
          if (kind == 7 && std::fabs(x + 0.7 * y - 0.4 * z - bend) < 0.6) value = nan;
          data.push_back(size * value + offset);
        }
      }
    }
    Volume::Description description;
    description.dimensions = values;
    description.placement.spacing = spacing;
    description.centering = centering;
    if (size > 1) return in_whole_numbers(description, data);
    if (random_() % 4 == 0) {
      return std::make_shared<Volume>(description, DataArray<double>(std::move(data)));
    }
    return std::make_shared<Volume>(description,
                                    DataArray<float>(std::vector<float>(data.begin(), data.end())));
  }

  /// Data from 0 to 255.
  std::shared_ptr<const Volume> in_whole_numbers(const Volume::Description& description,
                                                 const std::vector<double>& data) {
    const auto as = [&]<class T>(T) {
      std::vector<T> rounded;
      for (const double v : data) {
        rounded.push_back(static_cast<T>(std::isnan(v) ? 0 : std::clamp(v, 0.0, 255.0)));
      }
      return std::make_shared<const Volume>(description, DataArray<T>(std::move(rounded)));
    };
    switch (random_() % 5) {
      case 0:
        return as(std::uint8_t{});
      case 1:
        return as(std::int16_t{});
      case 2:
        return as(std::uint16_t{});
      case 3:
        return as(std::int32_t{});
      default:
        return as(std::uint32_t{});
    }
  }

  Scene scene() {
    std::array<int, 3> values{whole(2, 40), whole(2, 40), whole(2, 40)};
    if (random_() % 8 == 0) values[0] = whole(100, 900);
    const Vec3<double> spacing{power(0.5, 2), power(0.5, 2), power(0.5, 2)};
    const int channels = std::array<int, 6>{1, 1, 1, 2, 2, 3}[random_() % 6];
    const Centering centering = random_() % 4 == 0 ? Centering::cell : Centering::point;
    // Far from 0 rounding of the data counts.
    const double size = random_() % 4 == 0 ? 200 : 1;
    const double offset = size == 1 && random_() % 3 == 0 ? power(1, 1000) : 0;
    std::vector<Channel> all;
    for (int c = 0; c < channels; ++c) {
      all.push_back({std::to_string(c), "", volume(values, spacing, centering, offset, size)});
    }
    Scene scene;
    test::channels_of(scene).channels = std::make_shared<const Channels>(std::move(all));
    test::channels_of(scene).transfer_function =
        std::make_shared<const MultivariateTransferFunction>(
            channels, primitives(channels, offset, size, 40));
    scene.size = {12, 12};
    scene.camera = default_camera(test::channels_of(scene).channels->grid(), scene.size);
    const Vec3<double> axis[] = {{1, 0, 0}, {0, 1, 1}, {1, 1, 1}, {1, 0.01, 0}};
    Vec3<double> direction{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    if (random_() % 3 == 0) direction = axis[random_() % 4];
    const double far = length(scene.camera.position - scene.camera.focal_point);
    scene.camera.position = scene.camera.focal_point + direction * (far / length(direction));
    scene.camera.up = std::fabs(direction.z) > 0.9 * length(direction) ? Vec3<double>{0, 1, 0}
                                                                       : Vec3<double>{0, 0, 1};
    if (random_() % 2 == 0) {
      scene.camera.projection = Projection::orthographic;
      scene.camera.parallel_scale = 0.3 * far;
    }
    return scene;
  }
};

/// A ramp along x from `least` on, over a range of 1, seen along it; every other value is off it.
Scene ramp_scene(int cells, float least, float off = 0) {
  std::vector<float> data;
  for (int i = 0; i < 4 * (cells + 1); ++i) {
    const int x = i % (cells + 1);
    data.push_back(least + static_cast<float>(x) / static_cast<float>(cells) +
                   (x % 2 == 0 ? 0 : off));
  }
  Volume::Description description;
  description.dimensions = {cells + 1, 2, 2};
  Scene scene;
  test::channels_of(scene).channels = std::make_shared<const Channels>(std::vector<Channel>{
      {"ramp", "", std::make_shared<Volume>(description, DataArray<float>(std::move(data)))}});
  scene.size = {4, 4};
  look_along_x(scene, 0.3);
  return scene;
}

/// One Gaussian of so much depth where a ramp over `cells` passes it.
std::shared_ptr<const MultivariateTransferFunction> one_on_ramp(double center, double width,
                                                                double depth, int cells) {
  GaussianPrimitive p;
  p.channels = {0};
  p.center = {center};
  p.matrix = matrix_from_widths({width});
  p.extinction = depth / (cells * width * std::sqrt(std::numbers::pi));
  p.color = {1, 0.5, 0.25};
  return std::make_shared<const MultivariateTransferFunction>(1, std::vector<GaussianPrimitive>{p});
}

/// Steps where they may be long, cells where the Gaussian is narrow, or where data bend more than
/// the tolerance lets steps pass over.
TEST(GaussianMarchOfAFrame, IsTheOneThatIsLikelyToBeFaster) {
  if (no_packets()) GTEST_SKIP() << "this machine has no instruction set for packets";
  Scene scene = ramp_scene(48, 0, 0.005f);
  const auto in_steps = [&](double width, double tolerance) {
    test::channels_of(scene).transfer_function = one_on_ramp(0.4, width, 1, 48);
    scene.integration.tolerance = tolerance;
    RenderReport report;
    report = render(scene).report;
    EXPECT_GT(report.spans.strides + report.spans.panels + report.spans.lines, 0u);
    return report.spans.strides > 0;
  };
  EXPECT_TRUE(in_steps(0.1, 1e-2));
  EXPECT_FALSE(in_steps(0.01, 1e-2));
  EXPECT_FALSE(in_steps(0.1, 1e-4));
  scene = ramp_scene(48, 0);
  EXPECT_TRUE(in_steps(0.1, 1e-4));
}

/// A narrow Gaussian somewhere on a ramp, which steps of the longest kind would pass: its depth is
/// the integral of all of it.
TEST_P(GaussianFrames, DoNotPassANarrowOneUnseen) {
  constexpr int cells = 48;
  Scene scene = ramp_scene(cells, 0);
  RenderOptions options = GaussianFrames::options();
  options.outputs.error = true;
  int places = 0;
  double worst = 0;
  for (const InstructionSet set : packet_sets) {
    if (!test::runs_here(set)) continue;
    options.machine.instruction_set = set;
    for (double center = 0.1; center < 0.9; center += 0.0137) {
      for (const double width : {0.03, 0.004, 0.0006}) {
        test::channels_of(scene).transfer_function = one_on_ramp(center, width, 1, cells);
        for (const double tolerance : {1e-2, 1.0 / 512, 1e-4}) {
          scene.integration.tolerance = tolerance;
          const auto [image, report] = render(scene, options);
          EXPECT_EQ(report.spans.strides > 0, GetParam() == GaussianMarch::steps);
          for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const double said = double{image.error[i]};
            const double off = std::fabs(double{image.pixels[i][3]} - (1 - std::exp(-1.0)));
            EXPECT_LE(said, tolerance);
            EXPECT_LE(off, said) << name_of(set) << ", center " << center << ", width " << width
                                 << ", tolerance " << tolerance;
            worst = std::max(worst, off / said);
          }
          ++places;
        }
      }
    }
  }
  RecordProperty("largest_error_of_said", std::to_string(worst));
  EXPECT_GT(places, 500);
}

/// Units of binary32 at 1000 are a 500th of the width: next to the center they do not count.
TEST_P(GaussianFrames, LargeValuesCostNoDigits) {
  Seen seen;
  Scene scene = ramp_scene(48, 1000);
  for (const double center : {1000.21, 1000.4, 1000.77}) {
    test::channels_of(scene).transfer_function = one_on_ramp(center, 0.03, 1, 48);
    compare(scene, {1e-4}, seen);
    if (HasFatalFailure()) return;
  }
  expect_steps(seen, seen.frames);
}

/// Data that turn at a plane between two blocks, in each of which their slope is one number.
TEST_P(GaussianFrames, SeeWhatTurnsBetweenBlocks) {
  Seen seen;
  for (const Centering centering : {Centering::point, Centering::cell}) {
    for (const int turn : {15, 16, 17, 23, 24}) {
      std::vector<float> data;
      for (int i = 0; i < 48 * 8 * 8; ++i) {
        data.push_back(static_cast<float>(std::abs(i % 48 - turn)));
      }
      Volume::Description description;
      description.dimensions = {48, 8, 8};
      description.centering = centering;
      Scene scene = ramp_scene(47, 0);
      test::channels_of(scene).channels = std::make_shared<const Channels>(std::vector<Channel>{
          {"turn", "", std::make_shared<Volume>(description, DataArray<float>(std::move(data)))}});
      test::channels_of(scene).transfer_function = one_on_ramp(0, 0.1, 40, 48);
      look_along_x(scene, 3);
      compare(scene, {1e-2, 1e-4}, seen);
      if (HasFatalFailure()) return;
    }
  }
  expect_steps(seen, seen.frames / 2 + 1);
}

/// A wall of vacuum, thinner than a step, before which a narrow Gaussian lies.
TEST_P(GaussianFrames, DoNotStepOverVacuum) {
  constexpr int n = 44;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<float> data;
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const int sum = x + y + z;
        const double value = sum / 120.0 - (sum > 60 ? 0.5 : 0);
        data.push_back(static_cast<float>(sum == 60 ? nan : value));
      }
    }
  }
  Volume::Description description;
  description.dimensions = {n, n, n};
  Scene scene = ramp_scene(n, 0);
  test::channels_of(scene).channels = std::make_shared<const Channels>(std::vector<Channel>{
      {"wall", "", std::make_shared<Volume>(description, DataArray<float>(std::move(data)))}});
  test::channels_of(scene).transfer_function = one_on_ramp(0.4815, 0.0003, 3, 1);
  scene.size = {16, 16};
  scene.camera = default_camera(test::channels_of(scene).channels->grid(), scene.size);
  const double far = length(scene.camera.position - scene.camera.focal_point);
  scene.camera.position = scene.camera.focal_point - Vec3<double>{1, 1, 1} * (far / std::sqrt(3));
  scene.camera.up = {0, 0, 1};
  Seen seen;
  compare(scene, {1e-2, 1.0 / 512}, seen);
}

/// Cubes of blocks to skip reach beyond the grid.
TEST_P(GaussianFrames, KeepRaysInTheFacesBehindWhatIsSkipped) {
  Seen seen;
  for (const int points : {17, 20, 21, 25, 33}) {
    SCOPED_TRACE(points);
    Scene scene = ramp_seen_in_faces(points, 18);
    test::channels_of(scene).transfer_function = one_on_ramp(0.5, 0.1, 1, 30);
    RenderOptions options = GaussianFrames::options();
    const Image image = render(scene, options).image;
    for (const auto& pixel : image.pixels) EXPECT_NEAR(pixel[3], 1 - std::exp(-1.0), 3e-3);
    compare(scene, {1e-2, 1e-4}, seen);
    if (HasFatalFailure()) return;
  }
}

/// One datum so large that binary32, and in the end double too, have few digits of the others.
TEST_P(GaussianFrames, LiveWithOutliers) {
  for (const double outlier : {1e6, 3e7, 2e9, 1e13}) {
    SCOPED_TRACE(outlier);
    std::vector<double> data;
    for (int i = 0; i < 41 * 9 * 9; ++i) data.push_back(20 - i % 41 * 1.01);
    data[40 + 41 * 8] = outlier;
    Volume::Description description;
    description.dimensions = {41, 9, 9};
    Scene scene = ramp_scene(40, 0);
    test::channels_of(scene).channels = std::make_shared<const Channels>(std::vector<Channel>{
        {"ramp", "", std::make_shared<Volume>(description, DataArray<double>(std::move(data)))}});
    test::channels_of(scene).transfer_function = one_on_ramp(0.05, 0.02, 2, 1);
    Seen seen;
    pellucid::compare(scene, {1e-2, 1e-4}, seen, Promise::honest, options());
    EXPECT_GT(seen.pixels, 0u);
  }
}

/// Large terms of K (v - c) that cancel.
TEST_P(GaussianFrames, DoNotTrustWhatCancels) {
  Volume::Description description;
  description.dimensions = {9, 9, 9};
  const auto constant = [&](float value) {
    return std::make_shared<const Volume>(description,
                                          DataArray<float>(std::vector<float>(9 * 9 * 9, value)));
  };
  Scene scene = ramp_scene(9, 0);
  test::channels_of(scene).channels = std::make_shared<const Channels>(
      std::vector<Channel>{{"a", "", constant(1.4e7f)}, {"b", "", constant(6000001.0f)}});
  GaussianPrimitive p;
  p.channels = {0, 1};
  p.center = {0, 0};
  p.matrix = {{0.3, -0.7}};
  p.extinction = 0.1;
  p.color = {1, 0.5, 0.25};
  test::channels_of(scene).transfer_function =
      std::make_shared<const MultivariateTransferFunction>(2, std::vector<GaussianPrimitive>{p});
  scene.camera = default_camera(test::channels_of(scene).channels->grid(), scene.size);
  Seen seen;
  compare(scene, {1e-2, 1e-4}, seen);
}

/// Long rays along an axis of the grid: samples that keep in step with the cells would all err
/// alike.
TEST_P(GaussianFrames, DoNotKeepInStepWithTheCells) {
  Seen seen;
  for (const int cells : {700, 6000}) {
    std::vector<float> data;
    for (int i = 0; i < 4 * (cells + 1); ++i) {
      const double x = 2 * std::numbers::pi * (i % (cells + 1)) / 24.3;
      data.push_back(static_cast<float>(std::sin(x)));
    }
    Volume::Description description;
    description.dimensions = {cells + 1, 2, 2};
    Scene scene = ramp_scene(cells, 0);
    test::channels_of(scene).channels = std::make_shared<const Channels>(std::vector<Channel>{
        {"wave", "", std::make_shared<Volume>(description, DataArray<float>(std::move(data)))}});
    const double depth = 4 * 0.6 * std::sqrt(std::numbers::pi);
    test::channels_of(scene).transfer_function = one_on_ramp(0, 0.6, depth, cells);
    look_along_x(scene, 0.3, 2.0 * cells);
    compare(scene, {1e-2, 7e-3, 4e-3, 1.0 / 512, 1.4e-3, 1e-3}, seen);
    if (HasFatalFailure()) return;
  }
  expect_steps(seen, seen.frames);
}

TEST_P(GaussianFrames, AreTheSameForAnyNumberOfThreads) {
  for (unsigned seed = 400; seed < 406; ++seed) {
    random_.seed(seed);
    Scene one = scene();
    one.size = {40, 40};
    RenderOptions options = GaussianFrames::options();
    options.outputs.error = true;
    options.machine.threads = 1;
    const Image alone = render(one, options).image;
    options.machine.threads = 3;
    options.monitor.preview = 3;  // other pixels beside each other
    const Image together = render(one, options).image;
    EXPECT_EQ(alone.pixels, together.pixels) << seed;
    EXPECT_EQ(alone.error, together.error) << seed;
  }
}

/// The smallest tolerance for steps is one for them.
TEST_P(GaussianFrames, GoDownToTheirSmallestTolerance) {
  Scene scene = ramp_scene(48, 0);
  test::channels_of(scene).transfer_function = one_on_ramp(0.4, 0.1, 0.5, 48);
  for (const auto& [tolerance, steps] : {std::pair{1e-5, true}, {0.9e-5, false}}) {
    scene.integration.tolerance = tolerance;
    RenderReport report;
    report = render(scene, options()).report;
    EXPECT_EQ(report.spans.strides > 0, steps && GetParam() == GaussianMarch::steps) << tolerance;
  }
}

TEST_P(GaussianFrames, AreWithinWhatTheySay) {
  const auto make = [&](unsigned seed) {
    random_.seed(seed);
    return scene();
  };
  const Seen seen = compare_random_scenes(60, {3e-2, 1.0 / 512, 1e-4}, make,
                                          Promise::within_tolerance, options());
  expect_steps(seen, seen.frames / 2 + 1);
}

INSTANTIATE_TEST_SUITE_P(, GaussianFrames,
                         testing::Values(GaussianMarch::steps, GaussianMarch::cells),
                         [](const auto& one) {
                           return one.param == GaussianMarch::steps ? "Steps" : "Cells";
                         });

}  // namespace
}  // namespace pellucid
