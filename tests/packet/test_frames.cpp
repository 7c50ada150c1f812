// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/packet/instruction_sets.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid {
namespace {

/// Waves and noise in [0, 1], as values of a type: bytes over all of their range, the others over
/// some thousands.
template <class Value>
VolumeData waves(const std::array<int, 3>& values, double vacuum, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<Value> data;
  for (int z = 0; z < values[2]; ++z) {
    for (int y = 0; y < values[1]; ++y) {
      for (int x = 0; x < values[0]; ++x) {
        double v = 0.5 + 0.2 * std::sin(0.9 * x) + 0.2 * std::cos(0.7 * y + 0.5 * z);
        v += 0.1 * (2 * uniform(random) - 1);
        const bool empty = uniform(random) < vacuum;
        if constexpr (std::is_floating_point_v<Value>) {
          data.push_back(empty ? std::numeric_limits<Value>::quiet_NaN() : static_cast<Value>(v));
        } else if constexpr (sizeof(Value) == 1) {
          data.push_back(static_cast<Value>(255 * v + std::numeric_limits<Value>::min()));
        } else {
          data.push_back(static_cast<Value>(4000 * v - (std::is_signed_v<Value> ? 2000 : 0)));
        }
      }
    }
  }
  return DataArray<Value>(std::move(data));
}

/// Smooth stretches, a narrow band, a gap and a jump over the range of the data.
std::shared_ptr<TransferFunction> table_over(const VolumeStatistics& data, bool jump) {
  const auto at = [&](double s) { return data.minimum + s * (data.maximum - data.minimum); };
  std::vector<TransferFunction::Point> points{
      {at(0.1), 0, {1, 0.2, 0.1}},  {at(0.3), 0.4, {0.2, 0.9, 0.4}}, {at(0.45), 0, {0.1, 0.3, 1}},
      {at(0.55), 0, {0.1, 1, 0.2}}, {at(0.552), 3, {1, 1, 0}},       {at(0.554), 0, {1, 0, 1}},
      {at(0.7), 0.1, {0.3, 0.4, 1}}};
  if (jump) points.push_back({at(0.7), 1.5, {1, 0.5, 0}});
  points.push_back({at(0.9), 0.2, {0.5, 1.5, 0.2}});
  return std::make_shared<TransferFunction>(std::move(points));
}

struct Wanted {
  std::array<int, 3> values{9, 17, 12};
  Centering centering = Centering::point;
  double vacuum = 0;
  bool jump = false;
  bool inside = false;
  double origin = 0;
};

template <class Value>
Scene make_scene(const Wanted& wanted, unsigned seed) {
  Scene scene;
  Volume::Description description;
  description.dimensions = wanted.values;
  description.centering = wanted.centering;
  description.placement.spacing = {1, 0.75, 1.25};
  description.placement.origin = {wanted.origin, wanted.origin, wanted.origin};
  description.name = "waves";
  test::volume_of(scene).volume =
      std::make_shared<Volume>(description, waves<Value>(wanted.values, wanted.vacuum, seed));
  test::volume_of(scene).transfer_function =
      table_over(test::volume_of(scene).volume->statistics(), wanted.jump);
  scene.size = {23, 18};
  scene.camera = default_camera(*test::volume_of(scene).volume, scene.size);
  if (wanted.inside) {
    scene.camera.position =
        scene.camera.focal_point + (scene.camera.position - scene.camera.focal_point) * 0.02;
    scene.camera.vertical_angle = 80;
  }
  return scene;
}

/// What was seen over many frames.
struct Seen {
  double largest_of_error = 0;  ///< share of a pixel's own error
  double largest = 0;
  std::uint64_t scalar_fallback = 0, pixels = 0, bright = 0;
};

/// The scene in packets of each instruction set, at some tolerances, against rays one by one in
/// binary64 at a tolerance that is a thousandth of them.
void compare(Scene scene, Seen& seen) {
  constexpr double judge_tolerance = 1e-6;
  RenderOptions options;
  options.machine.threads = 1;
  options.outputs.error = true;
  options.machine.instruction_set = InstructionSet::scalar;
  scene.integration.tolerance = judge_tolerance;
  scene.integration.precision = Precision::float64;
  const Image truth = render(scene, options).image;
  scene.integration.precision = Precision::automatic;
  for (const InstructionSet set : packet_sets) {
    if (!test::runs_here(set)) continue;
    options.machine.instruction_set = set;
    for (const double tolerance : {1e-2, default_tolerance, 1e-4}) {
      SCOPED_TRACE(testing::Message() << name_of(set) << " at " << tolerance);
      scene.integration.tolerance = tolerance;
      const auto [image, report] = render(scene, options);
      seen.scalar_fallback += report.spans.in_double;
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const double said = static_cast<double>(image.error[i]);
        ASSERT_LE(said, tolerance * (1 + 1e-6)) << "pixel " << i;
        for (std::size_t c = 0; c < 4; ++c) {
          const double off = std::fabs(static_cast<double>(image.pixels[i][c]) -
                                       static_cast<double>(truth.pixels[i][c]));
          ASSERT_LE(off, said + 1.3 * judge_tolerance) << "pixel " << i << ", channel " << c;
          if (said > 30 * judge_tolerance) {
            seen.largest_of_error = std::max(seen.largest_of_error, off / said);
          }
          seen.largest = std::max(seen.largest, off / tolerance);
        }
        ++seen.pixels;
        if (truth.pixels[i][3] > 0.1f) ++seen.bright;
      }
    }
  }
}

template <class Value>
class PacketFrames : public testing::Test {};
using Values = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                              std::int32_t, float, double>;
TYPED_TEST_SUITE(PacketFrames, Values);

TYPED_TEST(PacketFrames, AreWithinTheirErrors) {
  if (no_packets()) GTEST_SKIP() << "this machine has no instruction set for packets";
  const Wanted cases[] = {
      {},
      {.centering = Centering::cell, .jump = true},
      {.values = {2, 9, 17}, .jump = true},
      {.values = {2, 2, 2}, .centering = Centering::cell},
      {.values = {17, 2, 9}, .vacuum = 0.05, .inside = true},
      {.values = {17, 17, 9}, .centering = Centering::cell, .vacuum = 0.02},
      {.jump = true, .inside = true},
      {.centering = Centering::cell, .inside = true},
      {.values = {9, 9, 9}, .origin = 1e6},
      {.values = {17, 9, 10}, .centering = Centering::cell, .jump = true, .origin = -1e6},
  };
  Seen seen;
  unsigned number = 0;
  for (const Wanted& wanted : cases) {
    SCOPED_TRACE(testing::Message() << "case " << number);
    compare(make_scene<TypeParam>(wanted, ++number), seen);
    if (this->HasFatalFailure()) return;
  }
  EXPECT_GT(seen.scalar_fallback, 100u);
  EXPECT_GT(seen.bright, seen.pixels / 10);
  this->RecordProperty("largest_error_of_said", std::to_string(seen.largest_of_error));
  this->RecordProperty("largest_error_of_tolerance", std::to_string(seen.largest));
}

TEST(PacketFrame, RaysAlongAxesAndDiagonals) {
  if (no_packets()) GTEST_SKIP() << "this machine has no instruction set for packets";
  Seen seen;
  for (const Vec3<double> from :
       {Vec3<double>{1, 0, 0}, Vec3<double>{0, -1, 0}, Vec3<double>{0, 0, 1}, Vec3<double>{1, 1, 0},
        Vec3<double>{-1, 1, 1}}) {
    for (const Centering centering : {Centering::point, Centering::cell}) {
      Scene scene = make_scene<float>({.values = {9, 17, 10}, .centering = centering}, 3);
      scene.camera.projection = Projection::orthographic;
      // On planes between cells and of blocks, and on edges, as the spacing is 1 along x.
      scene.camera.focal_point = {4, 6, 5};
      scene.camera.position = scene.camera.focal_point + 100.0 * from;
      scene.camera.up = from.z != 0 && from.x == 0 ? Vec3<double>{0, 1, 0} : Vec3<double>{0, 0, 1};
      scene.camera.parallel_scale = 4.5;
      scene.size = {18, 18};
      compare(scene, seen);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(seen.bright, seen.pixels / 10);
  RecordProperty("largest_error_of_said", std::to_string(seen.largest_of_error));
}

TEST(PacketFrame, BordersBesideVacuum) {
  if (no_packets()) GTEST_SKIP() << "this machine has no instruction set for packets";
  // Cell-centred, NaN in the middle: the half cells at the border have no corner there.
  std::vector<float> values(27, 0.5f);
  values[0] = 0.51f;
  values[13] = std::numeric_limits<float>::quiet_NaN();
  Volume::Description description;
  description.dimensions = {3, 3, 3};
  description.centering = Centering::cell;
  description.name = "hole";
  Scene scene;
  test::volume_of(scene).volume = std::make_shared<Volume>(description, DataArray<float>(values));
  test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 0.5, {1, 1, 1}}, {1, 0.6, {1, 1, 1}}});
  scene.size = {16, 16};
  scene.camera = default_camera(*test::volume_of(scene).volume, scene.size);
  Seen seen;
  compare(scene, seen);
}

TEST(PacketFrame, ColorsThatEndSteeplyBesideACorner) {
  if (no_packets()) GTEST_SKIP() << "this machine has no instruction set for packets";
  // Binary32 moves the control point at which the color ceases to rise across the value of the
  // data, or to it.
  constexpr double u = 0x1p-24;
  Seen seen;
  for (const double width : {257.0, 400.0, 2000.0}) {
    for (const double shift : {0.8, 0.3, -0.8}) {
      for (const double extinction : {1.0, 1.3}) {
        SCOPED_TRACE(testing::Message() << width << " u, " << shift << " u, " << extinction);
        const double end = 1 + shift * u;
        std::vector<float> values(512, 1.0f);
        values[0] = 1.0005f;
        Volume::Description description;
        description.dimensions = {8, 8, 8};
        description.name = "edge";
        Scene scene;
        test::volume_of(scene).volume =
            std::make_shared<Volume>(description, DataArray<float>(values));
        using Points = std::vector<TransferFunction::Point>;
        const Points rises{{0, 1, {0, 0, 0}},
                           {end - width * u, 1, {0, 0, 0}},
                           {end, extinction, {1, 1, 1}},
                           {1.001, 0.5, {1, 1, 1}}};
        const Points falls{{0, 0.5, {1, 1, 1}},
                           {end, extinction, {1, 1, 1}},
                           {end + width * u, 1, {0, 0, 0}},
                           {1.001, 1, {0, 0, 0}}};
        for (const Points& points : {rises, falls}) {
          test::volume_of(scene).transfer_function = std::make_shared<TransferFunction>(points);
          scene.size = {8, 8};
          scene.camera = default_camera(*test::volume_of(scene).volume, scene.size);
          compare(scene, seen);
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

}  // namespace
}  // namespace pellucid
