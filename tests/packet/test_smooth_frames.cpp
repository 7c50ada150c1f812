// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <vector>

#include "pellucid/cpu/render.h"
#include "tests/packet/against_one_by_one.h"
#include "tests/packet/smooth_frames.h"

namespace pellucid {
namespace {

TEST_F(SmoothFrames, OfWaves) {
  Seen seen;
  int n = 0;
  for (const Vec3<double>& direction : directions) {
    const auto volume = make_volume({41, 37, 44}, waves(1 + n % 3, 12));
    compare(make_scene(volume, n % 2 == 0 ? line(1.5, 40) : table(1.5, 40), direction, n % 3 != 2),
            {1e-2, 1.0 / 512, 4e-4, 1e-4}, seen);
    if (HasFatalFailure()) return;
    ++n;
  }
  EXPECT_GT(seen.with_strides, seen.frames / 2);
  RecordProperty("largest_error_of_said", std::to_string(seen.largest_of_error));
}

TEST_F(SmoothFrames, OfWhatBendsTheSameEverywhere) {
  // r² and x²: no error cancels another.
  Seen seen;
  for (const Vec3<double>& direction : directions) {
    for (const bool round : {true, false}) {
      const Field field = [&](double x, double y, double z) {
        x = (x - 16) / 32;
        y = (y - 16) / 32;
        z = (z - 16) / 32;
        return round ? x * x + y * y + z * z : 4 * x * x;
      };
      const auto volume = make_volume({33, 33, 33}, field);
      compare(make_scene(volume, line(2, 33), direction, true), {1e-2, 1e-3, 1e-4}, seen);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(seen.with_strides, seen.frames / 2);
}

TEST_F(SmoothFrames, OfStepsThatAreTheSameInAllCells) {
  // Four steps, the shortest but two and others, are whole cells along x: all err alike.
  Seen seen;
  const Field field = [](double x, double, double) { return (x - 32) * (x - 32) / 1024; };
  const auto volume = make_volume({65, 65, 9}, field);
  for (const double x : {0.616, 0.66, 0.7071, 0.87, 0.933}) {
    const Vec3<double> direction{x, std::sqrt(1 - x * x), 0};
    compare(make_scene(volume, line(2, 65), direction, true), {1e-3, 2e-4, 5e-5, 1.7e-5}, seen);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(seen.with_strides, seen.frames / 2);
}

TEST_F(SmoothFrames, OfSingleBlocksBetweenHoles) {
  // A stretch of eight cells could be done in steps of two, all on planes of cells.
  Seen seen;
  const Field field = [](double x, double y, double z) {
    const bool hole = static_cast<int>(x) % 16 == 12 && y < 1 && z < 1;
    return hole ? std::numeric_limits<double>::quiet_NaN() : 4e-4 * (x - 40) * (x - 40) + 0.001 * y;
  };
  const auto volume = make_volume({97, 9, 9}, field);
  for (const Vec3<double> direction : {Vec3<double>{1, 0, 0}, Vec3<double>{1, 0.02, 0.03}}) {
    Scene scene = make_scene(volume, line(1, 97), direction, true);
    scene.camera.parallel_scale = 4;
    compare(scene, {3e-2, 1e-2, 1e-3, 1e-4}, seen);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(seen.with_strides, 0);
}

TEST_F(SmoothFrames, WithWhatSamplesCouldMiss) {
  Seen seen;
  const auto volume = make_volume({40, 36, 40}, waves(2, 20));
  Points narrow = table(1, 40), teeth, dense = table(4000, 40), far = line(1, 40);
  for (int i = 120; i < 126; ++i) narrow[static_cast<std::size_t>(i)].color = {1, 1, 1};
  for (int i = 0; i <= 64; ++i) {
    teeth.push_back({i / 64.0, (i % 2 == 0 ? 0.5 : 0.55) / 40 * (1 + i / 64.0), {1, 0.5, 0.2}});
  }
  far.front().value = -3e4;
  far.insert(far.begin() + 1, {0, 0.01, {1, 1, 0.2}});
  far.insert(far.begin() + 2, {1, 0.04, {0.1, 1, 0.2}});
  far.back().value = 3e4;
  Points peak;  // a smooth one, in a table, a fiftieth of the range wide
  for (int i = 0; i < 256; ++i) {
    const double v = i / 255.0, s = (v - 0.6) / 0.02;
    peak.push_back({v, 0.1 * std::exp(-0.5 * s * s), {v, 1 - v, 0.5}});
  }
  for (const Points& points : {narrow, teeth, dense, far, peak}) {
    for (const Vec3<double> direction : {Vec3<double>{1, 1, 1}, Vec3<double>{0.7, 0.2, -0.4}}) {
      compare(make_scene(volume, points, direction, true), {3e-2, 1.0 / 512, 2e-4}, seen);
      if (HasFatalFailure()) return;
    }
  }
}

TEST_F(SmoothFrames, WithNoiseAndOddVoxels) {
  Seen seen;
  for (const double noise : {1e-4, 1e-3, 3e-3}) {
    const Field field = waves(2, 16);
    const auto volume = make_volume({40, 36, 40}, [&](double x, double y, double z) {
      return field(x, y, z) + (random_() % 2 == 0 ? noise : -noise);
    });
    compare(make_scene(volume, line(1, 40), {0.6, 0.5, -0.4}, false), {3e-2, 1.0 / 512, 2e-4},
            seen);
    const auto odd = make_volume({40, 36, 40}, [&](double x, double y, double z) {
      return field(x, y, z) + (x == 20 ? 5 * noise : 0);
    });
    compare(make_scene(odd, line(1, 40), {1, 0.2, 0.1}, true), {3e-2, 1.0 / 512, 2e-4}, seen);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(seen.with_strides, 0);
}

TEST_F(SmoothFrames, AreWithinWhatTheySay) {
  const Seen seen = compare_random_scenes(40, {3e-2, 1.0 / 512, 4e-4, 1e-4}, [&](unsigned seed) {
    random_.seed(seed);
    const auto size = [&] { return static_cast<int>(uniform(20, 60)); };
    const std::array<int, 3> values{size(), size(), size()};
    const double size_of_all = (values[0] + values[1] + values[2]) / 3.0;
    Field field = waves(1 + static_cast<int>(uniform(0, 4)), uniform(9, 40));
    if (uniform(0, 1) < 0.3) {
      const double noise = std::pow(10, uniform(-5, -2.5)), odd = std::floor(uniform(0, 40));
      field = [=](double x, double y, double z) { return with_noise(field, x, y, z, noise, odd); };
    }
    const Vec3<double> spacing{uniform(0.7, 1.4), uniform(0.7, 1.4), uniform(0.7, 1.4)};
    const auto volume = make_volume(values, field, spacing);
    const double depth = std::pow(10, uniform(-1, 1));
    Points points = uniform(0, 1) < 0.5 ? line(depth, size_of_all) : table(depth, size_of_all);
    Vec3<double> direction{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    if (uniform(0, 1) < 0.3) direction = directions[seed % std::size(directions)];
    return make_scene(volume, std::move(points), direction, uniform(0, 1) < 0.5);
  });
  EXPECT_GT(seen.with_strides, seen.frames / 2);
}

TEST_F(SmoothFrames, OfQuadraticsAreWithinWhatTheySay) {
  // What trilinear data are off by has one sign everywhere.
  const Seen seen = compare_random_scenes(100, {3e-2, 1e-2, 1e-3, 1e-4}, [&](unsigned seed) {
    random_.seed(seed);
    const auto size = [&] { return static_cast<int>(uniform(20, 60)); };
    const std::array<int, 3> values{size(), size(), size()};
    const auto share = [&] { return one_of(3) ? 0 : uniform(0, 1); };
    const Vec3<double> k{share(), share(), share()};
    const double all = std::max(k.x + k.y + k.z, 1e-3);
    const Field field = [=](double x, double y, double z) {
      x = 2 * x / values[0] - 1;
      y = 2 * y / values[1] - 1;
      z = 2 * z / values[2] - 1;
      return (k.x * x * x + k.y * y * y + k.z * z * z) / all;
    };
    const auto volume = make_volume(values, field);
    Vec3<double> direction = aside();
    if (one_of(2)) direction = directions[random_() % std::size(directions)];
    return make_scene(volume, line(power(0.3, 10), values[0]), direction, one_of(2));
  });
  EXPECT_GT(seen.with_strides, seen.frames / 2);
}

TEST_F(SmoothFrames, BehindCornersAreWithinWhatTheySay) {
  const Seen seen = compare_random_scenes(60, {3e-2, 1.0 / 512, 4e-4, 1e-4}, [&](unsigned seed) {
    random_.seed(seed);
    const auto size = [&] { return static_cast<int>(uniform(20, 60)); };
    const std::array<int, 3> values{size(), size(), size()};
    const auto volume =
        make_volume(values, waves(1 + static_cast<int>(uniform(0, 3)), power(9, 200)),
                    {uniform(0.7, 1.4), uniform(0.7, 1.4), uniform(0.7, 1.4)});
    Points points = corners(power(0.1, 10), values[0]);
    const Vec3<double> direction = one_of(3) ? directions[seed % std::size(directions)] : aside();
    return make_scene(volume, std::move(points), direction, one_of(2));
  });
  EXPECT_GT(seen.with_strides, seen.frames / 2);
}

TEST_F(SmoothFrames, BesideVacuumAreWithinWhatTheySay) {
  // Packets stop in the middle of cells here, and binary64 integrates the rest of the ray.
  const Seen seen = compare_random_scenes(100, {3e-2, 1.0 / 512, 4e-4, 1e-4}, [&](unsigned seed) {
    random_.seed(seed);
    const int across = static_cast<int>(uniform(10, 30)), first = static_cast<int>(uniform(9, 30)),
              apart = static_cast<int>(uniform(3, 40));
    const Field field = waves(1 + static_cast<int>(uniform(0, 3)), uniform(30, 200));
    const auto with_empty_planes = [&](double x, double y, double z) {
      const int from_first = static_cast<int>(x) - first;
      const bool empty = from_first >= 0 && from_first % apart == 0;
      return empty ? std::numeric_limits<double>::quiet_NaN() : field(x, y, z);
    };
    const auto volume = make_volume({50, across, across}, with_empty_planes);
    Points points = line(power(0.1, 10), 50);
    points.insert(points.begin(), {-1, uniform(0, 1) < 0.5 ? 0 : 1e-3, {1, 1, 1}});
    return make_scene(volume, std::move(points), aside(), uniform(0, 1) < 0.5);
  });
  EXPECT_GT(seen.with_strides, seen.frames / 2);
}

TEST_F(SmoothFrames, AreTheSameWhateverElseIsInAPacket) {
  const auto volume = make_volume({40, 36, 40}, waves(2, 20), {1, 0.8, 1.3});
  Scene scene = make_scene(volume, table(2, 40), {0.6, 0.5, -0.4}, false);
  scene.size = {36, 36};
  scene.integration.tolerance = 1e-2;
  RenderOptions options;
  options.outputs.error = true;
  options.machine.threads = 1;
  const auto [whole, report] = render(scene, options);
  EXPECT_GT(report.spans.strides, 0u);
  options.machine.threads = 3;
  options.monitor.preview = 3;  // other pixels beside each other
  const Image other = render(scene, options).image;
  EXPECT_EQ(whole.pixels, other.pixels);
  EXPECT_EQ(whole.error, other.error);
}

TEST_F(SmoothFrames, ProvedOnesHaveNone) {
  const auto volume = make_volume({40, 36, 40}, waves(1, 20));
  Scene scene = make_scene(volume, line(1, 40), {0.6, 0.5, -0.4}, false);
  RenderOptions options;
  options.outputs.error = true;
  RenderReport report;
  report = render(scene, options).report;
  EXPECT_GT(report.spans.strides, 0u);
  EXPECT_LT(report.pixels_proved, report.pixels);
  scene.integration.grade = Grade::proved;
  report = render(scene, options).report;
  EXPECT_EQ(report.spans.strides, 0u);
  EXPECT_EQ(report.pixels_proved, report.pixels);
}

}  // namespace
}  // namespace pellucid
