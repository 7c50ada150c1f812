// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/packet/against_one_by_one.h"
#include "tests/packet/random_frames.h"
#include "tests/support/one_layer.h"

namespace pellucid {
namespace {

class CellFrames : public RandomFrames {
 protected:
  CellFrames() : RandomFrames(1) {}

  /// Between 0 and 1: waves, steps, single values that stand out, noise; or one number for the most
  /// part. NaN in single places, in planes, or beyond one.
  std::vector<double> field(const std::array<int, 3>& values) {
    const Vec3<double> k = aside() * power(0.05, 3);
    const double noise = one_of(3) ? 0 : power(1e-6, 0.3), odd = one_of(3) ? 0.02 : 0;
    const bool steps = one_of(4), mostly_one = one_of(6), vacuum = one_of(2);
    const double holes = vacuum && one_of(2) ? power(1e-3, 0.2) : 0;
    const int empty_axis = vacuum && one_of(2) ? static_cast<int>(random_() % 3) : -1;
    const int apart = 2 + static_cast<int>(random_() % 20), edge = vacuum && one_of(3) ? 9 : 1000;
    std::vector<double> data;
    for (int z = 0; z < values[2]; ++z) {
      for (int y = 0; y < values[1]; ++y) {
        for (int x = 0; x < values[0]; ++x) {
          const int at[3] = {x, y, z};
          double v = 0.5 + 0.4 * std::sin(dot(k, Vec3<double>{1.0 * x, 1.0 * y, 1.0 * z}));
          if (steps) v = std::floor(5 * v) / 5;
          if (mostly_one) v = std::max(v, 0.6);
          v += noise * uniform(-1, 1);
          if (uniform(0, 1) < odd) v = uniform(0, 1);
          const bool empty = uniform(0, 1) < holes ||
                             (empty_axis >= 0 && at[empty_axis] % apart == apart - 1) ||
                             x + y > edge;
          data.push_back(empty ? std::numeric_limits<double>::quiet_NaN() : v);
        }
      }
    }
    return data;
  }

  /// Of integers that have no NaN, 0 in its place.
  template <class Value>
  static VolumeData as(const std::vector<double>& field, double offset, double width) {
    std::vector<Value> data;
    for (const double v : field) {
      const double value = offset + width * v;
      if constexpr (std::is_integral_v<Value>) {
        data.push_back(std::isnan(v) ? Value{0} : static_cast<Value>(std::lround(value)));
      } else {
        data.push_back(static_cast<Value>(value));
      }
    }
    return DataArray<Value>(std::move(data));
  }

  /// The same extinction, with colors that bend up to forty times between its corners, as those of
  /// a table do, or at random.
  std::shared_ptr<const TransferFunction> with_many_colors(const TransferFunction& from) {
    const std::vector<TransferFunction::Point> corners = from.points();
    const bool smooth = one_of(2);
    const Vec3<double> waves = aside() * power(1, 30);
    std::vector<TransferFunction::Point> all;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const TransferFunction::Point& a = corners[i];
      const double width = i + 1 < corners.size() ? corners[i + 1].value - a.value : 0;
      const int parts =
          width > 1e-13 * std::fabs(a.value) ? 1 + static_cast<int>(random_() % 40) : 1;
      for (int k = 0; k < parts; ++k) {
        const double s = static_cast<double>(k) / parts;
        TransferFunction::Point p = a;
        if (k > 0) {
          const TransferFunction::Point& b = corners[i + 1];
          p.value = a.value + s * (b.value - a.value);
          p.extinction = a.extinction + s * (b.extinction - a.extinction);
        }
        const double place = static_cast<double>(i) + s;
        p.color = smooth ? Rgb<double>{0.5 + 0.5 * std::sin(waves.x * place),
                                       0.5 + 0.5 * std::sin(waves.y * place), 0.5}
                         : Rgb<double>{uniform(0, 1), uniform(0, 1), uniform(0, 1)};
        all.push_back(p);
      }
    }
    return std::make_shared<const TransferFunction>(std::move(all));
  }

  /// With another point close behind some of the points, down to where binary32 does not know them
  /// apart, or in the same place; now and then all at whole numbers, as data are.
  std::shared_ptr<const TransferFunction> with_narrow_intervals(const TransferFunction& from) {
    std::vector<TransferFunction::Point> corners = from.points();
    const bool whole = one_of(4), jumps = one_of(2);
    std::vector<TransferFunction::Point> all;
    const auto add = [&](const TransferFunction::Point& p) {
      const std::size_t n = all.size();
      if (n > 1 && all[n - 2].value >= p.value) return;  // a third one
      all.push_back(p);
    };
    for (TransferFunction::Point& p : corners) {
      if (whole) p.value = std::round(p.value);
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      add(corners[i]);
      if (one_of(2)) continue;
      TransferFunction::Point p = corners[i];
      const double size = one_of(2) ? 1 : std::max(std::fabs(p.value), 1.0);
      if (i + 1 < corners.size() && (!jumps || one_of(2))) {
        p.value += std::min(power(1e-13, 3e-4) * size, 0.5 * (corners[i + 1].value - p.value));
      }
      if (!one_of(4)) p.extinction = one_of(3) ? 0 : uniform(0, 2) * std::max(p.extinction, 0.1);
      p.color = {uniform(0, 1), uniform(0, 1), uniform(0, 1)};
      add(p);
    }
    return std::make_shared<const TransferFunction>(std::move(all));
  }

  Scene scene(unsigned seed) {
    random_.seed(seed);
    const auto size = [&] {
      return one_of(4) ? 2 + static_cast<int>(random_() % 8) : 9 + static_cast<int>(random_() % 26);
    };
    Volume::Description description;
    description.dimensions = {size(), size(), size()};
    const double unit = one_of(4) ? power(1e-4, 1e4) : 1;
    description.placement.spacing = {unit, unit * uniform(0.4, 2.5), unit * uniform(0.4, 2.5)};
    description.centering = one_of(3) ? Centering::cell : Centering::point;
    description.name = "random";
    const std::vector<double> numbers = field(description.dimensions);
    double offset = 0, width = 1;
    VolumeData data = as<std::uint8_t>(numbers, 0, 255);
    switch (random_() % 6) {
      case 0:
        width = 255;
        break;
      case 1:
        width = 4000;
        offset = -1024;
        data = as<std::int16_t>(numbers, offset, width);
        break;
      case 2:
        width = 60000;
        data = as<std::uint16_t>(numbers, offset, width);
        break;
      case 3:
        offset = one_of(2) ? power(1, 1e4) * (one_of(2) ? 1 : -1) : 0;
        width = one_of(2) ? power(1e-3, 1e3) : 1;
        data = as<double>(numbers, offset, width);
        break;
      default:
        offset = one_of(3) ? power(1, 1e4) * (one_of(2) ? 1 : -1) : 0;
        width = one_of(3) ? power(1e-3, 1e3) : 1;
        data = as<float>(numbers, offset, width);
    }
    Scene scene;
    const auto volume = std::make_shared<const Volume>(description, std::move(data));
    test::volume_of(scene).volume = volume;
    const int most =
        *std::max_element(description.dimensions.begin(), description.dimensions.end());
    test::volume_of(scene).transfer_function = table(unit * most, offset, width);
    if (one_of(3)) {
      test::volume_of(scene).transfer_function =
          with_many_colors(*test::volume_of(scene).transfer_function);
    }
    scene.size = {12, 9};
    scene.camera = default_camera(*volume, scene.size);
    const Vec3<double> middle = scene.camera.focal_point;
    const double far = length(scene.camera.position - middle);
    Vec3<double> direction = aside();
    if (one_of(4)) direction = Vec3<double>{1.0 * one_of(2), 1.0 * one_of(2), 1};
    scene.camera.position = middle + direction * ((one_of(5) ? 0.05 : 1) * far / length(direction));
    scene.camera.up = {0.1, 1, 0.2};
    if (one_of(3)) {
      scene.camera.projection = Projection::orthographic;
      scene.camera.parallel_scale = far * uniform(0.05, 0.4);
    }
    return scene;
  }
};

TEST_F(CellFrames, AreWithinWhatTheySay) {
  // At the last of these most of what absorbs is gone through in double.
  expect_honest_scenes(150, [&](unsigned seed) { return scene(seed); },
                       {1e-2, 1.0 / 512, 2e-4, 2e-5});
}

// A ray through edges of cells: of some that it is in for no length no slope is known.
TEST_F(CellFrames, BehindCellsWithoutALengthAreWithinWhatTheySay) {
  Seen seen;
  compare(scene(2187), {1e-2, 2e-4}, seen);
}

// A point that stands twice where nothing absorbs: behind it a steep slope, which rounding of the
// data reaches, and in front of it another color, for values that binary32 does not tell apart.
TEST_F(CellFrames, BesideAPointThatStandsTwiceAreWithinWhatTheySay) {
  Seen seen;
  const auto of_two = [](float a, float b, int along) {
    std::vector<float> data;
    for (int n = 0; n < 17 * 17 * 17; ++n) {
      data.push_back((along == 0 ? n % 17 : n / 289) % 2 == 0 ? a : b);
    }
    Volume::Description description;
    description.dimensions = {17, 17, 17};
    return std::make_shared<const Volume>(description, DataArray<float>(std::move(data)));
  };
  using Points = std::vector<TransferFunction::Point>;
  for (const int along : {0, 2}) {
    for (const double steep : {2.0, 50.0, 1e4}) {
      SCOPED_TRACE(testing::Message() << along << ", " << steep);
      Scene one;
      test::volume_of(one).volume = of_two(999.99994f, 1000.0f, along);
      test::volume_of(one).transfer_function =
          std::make_shared<const TransferFunction>(Points{{999, steep, {1, 0, 0}},
                                                          {1000, 0, {1, 0, 0}},
                                                          {1000, 0, {0, 0, 1}},
                                                          {1001, 0, {0, 0, 1}}});
      one.size = {12, 9};
      one.camera = default_camera(*test::volume_of(one).volume, one.size);
      one.camera.projection = Projection::orthographic;
      one.camera.focal_point = {8.15, 8.3, 8};
      one.camera.position = {8.15, 8.3, -30};
      one.camera.up = {0, 1, 0};
      one.camera.parallel_scale = 3.3;
      compare(one, {1e-2, 2e-4}, seen, Promise::honest);
      if (HasFatalFailure()) return;
      test::volume_of(one).volume = of_two(999.9999f, 1000.00006f, along);
      compare(one, {1e-2, 2e-4}, seen, Promise::honest);
      if (HasFatalFailure()) return;
    }
  }
}

// Jumps, and intervals of the transfer function that binary32 hardly knows, are gone through in
// double.
TEST_F(CellFrames, BehindNarrowIntervalsAreWithinWhatTheySay) {
  expect_honest_scenes(100,
                       [&](unsigned seed) {
                         Scene one = scene(seed);
                         test::volume_of(one).transfer_function =
                             with_narrow_intervals(*test::volume_of(one).transfer_function);
                         if (one_of(3)) {  // some of them closer than values in binary32
                           test::volume_of(one).transfer_function =
                               with_many_colors(*test::volume_of(one).transfer_function);
                         }
                         return one;
                       },
                       {1e-2, 1.0 / 512, 2e-4, 2e-5});
}

// Both sides of a jump of the color have one value in binary32.
TEST_F(CellFrames, AtAJumpAmongValuesAlikeInFloatAreWithinWhatTheySay) {
  Seen seen;
  for (const double change : {1e-10, 1e-9, 1e-8, 1e-7, 1e-6}) {
    SCOPED_TRACE(testing::Message() << "change " << change);
    std::vector<double> data;
    for (int n = 0; n < 12 * 12 * 12; ++n) data.push_back(0.5 + change * (n % 12 - 5.3));
    Volume::Description description;
    description.dimensions = {12, 12, 12};
    Scene one;
    test::volume_of(one).volume =
        std::make_shared<const Volume>(description, DataArray<double>(std::move(data)));
    test::volume_of(one).transfer_function = std::make_shared<const TransferFunction>(
        std::vector<TransferFunction::Point>{{0, 0.1, {1, 0, 0}},
                                             {0.5, 0.1, {1, 0, 0}},
                                             {0.5, 0.1, {0, 0, 1}},
                                             {1, 0.1, {0, 0, 1}}});
    one.size = {12, 9};
    one.camera = default_camera(*test::volume_of(one).volume, one.size);
    compare(one, {1e-2, 2e-4}, seen, Promise::honest);
    if (HasFatalFailure()) return;
  }
}

// Rays that hardly rise over planes behind which there is nothing: what one cell has too much no
// other has too little.
TEST_F(CellFrames, OfRaysAlongVacuumAreWithinWhatTheySay) {
  constexpr int points = 22, cube = 4;
  std::vector<float> data;
  for (int z = 0; z < points; ++z) {
    for (int y = 0; y < points; ++y) {
      for (int x = 0; x < points; ++x) {
        const bool empty = (x / cube + y / cube + z / cube) % 2 == 0;
        data.push_back(empty ? std::numeric_limits<float>::quiet_NaN()
                             : 0.4f + 0.01f * static_cast<float>(x % 5));
      }
    }
  }
  Volume::Description description;
  description.dimensions = {points, points, points};
  const auto volume =
      std::make_shared<const Volume>(description, DataArray<float>(std::move(data)));
  Seen seen;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "scene " << seed);
    random_.seed(seed);
    Scene one;
    test::volume_of(one).volume = volume;
    const double dense = power(0.1, 10);
    test::volume_of(one).transfer_function = std::make_shared<const TransferFunction>(
        std::vector<TransferFunction::Point>{{0, 0, {1, 1, 1}}, {1, dense, {1, 0.5, 0}}});
    one.size = {12, 9};
    one.camera = default_camera(*volume, one.size);
    // All of them meet a plane where data end, in the middle of a block.
    const double rise = power(1e-5, 1e-1);
    one.camera.focal_point = {uniform(1, 20), 11, uniform(8, 11)};
    one.camera.position =
        one.camera.focal_point + 100 * Vec3<double>{1, one_of(2) ? rise : -rise, uniform(0, 0.02)};
    one.camera.up = {0, 0, 1};
    one.camera.projection = Projection::orthographic;
    one.camera.parallel_scale = 5 * rise;
    compare(one, {1e-2, 1e-4}, seen);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(seen.pixels, 8000U * static_cast<unsigned>(set_count()));
}

TEST_F(CellFrames, AreTheSameWhateverElseIsInAPacket) {
  std::uint64_t in_double = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(testing::Message() << "scene " << seed);
    Scene one = scene(seed);
    one.size = {21, 19};
    one.integration.tolerance = seed % 2 == 0 ? 1.0 / 512 : 1e-4;
    RenderOptions options;
    options.outputs.error = true;
    options.machine.threads = 1;
    const auto [whole, report] = render(one, options);
    in_double += report.spans.in_double;
    options.machine.threads = 3;
    options.monitor.preview = 3;  // other pixels beside each other
    const Image other = render(one, options).image;
    ASSERT_EQ(whole.pixels, other.pixels);
    ASSERT_EQ(whole.error, other.error);
  }
  EXPECT_GT(in_double, 10000U);
}

}  // namespace
}  // namespace pellucid
