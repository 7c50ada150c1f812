// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "expect_error.h"
#include "pellucid/scene/builtin_fields.h"

namespace pellucid::test_builtin_fields {
namespace {

/// The value at index (i, j, k) of a built-in field.
float at(const Volume& volume, int i, int j, int k) {
  const auto n = static_cast<std::size_t>(volume.description().dimensions[0]);
  const auto index = static_cast<std::size_t>(i) +
                     n * (static_cast<std::size_t>(j) + n * static_cast<std::size_t>(k));
  return std::get<DataArray<float>>(volume.data())[index];
}

TEST(BuiltinField, FillsTheBoxFromMinusOneToOne) {
  for (const std::string_view name : builtin_field_names()) {
    SCOPED_TRACE(name);
    const Volume volume = make_builtin_field(name, 17);
    EXPECT_EQ(volume.description().dimensions, (std::array<int, 3>{17, 17, 17}));
    EXPECT_EQ(volume.description().centering, Centering::point);
    EXPECT_EQ(volume.description().name, name);
    EXPECT_EQ(volume.statistics().nan, 0U);
    const auto corners = volume.world_corners();
    for (int a = 0; a < 3; ++a) {
      const auto [low, high] = std::minmax_element(
          corners.begin(), corners.end(),
          [a](const Vec3<double>& p, const Vec3<double>& q) { return p[a] < q[a]; });
      EXPECT_DOUBLE_EQ((*low)[a], -1);
      EXPECT_DOUBLE_EQ((*high)[a], 1);
    }
  }
}

// Values of 30 digits from mpmath, by the formula of Marschner and Lobb and by the general one of
// the hydrogen atom (Laguerre and Legendre polynomials).
TEST(BuiltinField, MarschnerLobbAndHydrogenHaveTheirValues) {
  struct Row {
    int i, j, k;  // of 5 points: position -1 + index / 2
    double marschner_lobb, hydrogen;
  };
  const Row rows[] = {{0, 0, 0, 0.833492229337, 0},
                      {2, 2, 2, 0.6, 0},
                      {3, 2, 2, 0.504622345049, 0.0462097068181},
                      {3, 3, 1, 0.731449976862, 0},
                      {1, 4, 3, 0.295754465872, 4.50718750187e-6},
                      {4, 4, 4, 0.0334922293368, 0}};
  const Volume lobb = make_builtin_field("marschner_lobb", 5);
  const Volume hydrogen = make_builtin_field("hydrogen", 5);
  for (const Row& row : rows) {
    // Half a unit in the last place of a float below 1.
    EXPECT_NEAR(static_cast<double>(at(lobb, row.i, row.j, row.k)), row.marschner_lobb, 3e-8);
    EXPECT_NEAR(static_cast<double>(at(hydrogen, row.i, row.j, row.k)), row.hydrogen, 3e-9);
  }
}

TEST(BuiltinField, MarschnerLobbLiesBetween0And1) {
  const VolumeStatistics s = make_builtin_field("marschner_lobb", 65).statistics();
  EXPECT_GE(s.minimum, 0);
  EXPECT_LE(s.maximum, 1);
}

TEST(BuiltinField, HydrogenFillsItsRangeAndFadesOnTheFaces) {
  constexpr int n = 129;
  const Volume volume = make_builtin_field("hydrogen", n);
  EXPECT_GE(volume.statistics().minimum, 0);
  EXPECT_LE(volume.statistics().maximum, 1);
  EXPECT_GT(volume.statistics().maximum, 0.99);
  float on_faces = 0;
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      on_faces =
          std::max({on_faces, at(volume, 0, a, b), at(volume, a, 0, b), at(volume, a, b, 0)});
    }
  }
  EXPECT_LT(on_faces, 0.002F);
  EXPECT_GT(on_faces, 0.0005F);
}

TEST(BuiltinField, ShellsAreNestedAndOpen) {
  constexpr int n = 161, middle = 80;
  const Volume volume = make_builtin_field("shells", n);
  EXPECT_FLOAT_EQ(static_cast<float>(volume.statistics().minimum), 0.0F);
  EXPECT_LE(volume.statistics().maximum, 1);
  // To +y no shell is open: each has its value at its radius, and nothing lies between them.
  const float values[] = {1.0F, 0.75F, 0.5F, 0.25F};
  for (int shell = 0; shell < 4; ++shell) {
    const int radius = 24 + 16 * shell;
    EXPECT_NEAR(at(volume, middle, middle + radius, middle), values[shell], 1e-4F);
    EXPECT_LT(at(volume, middle, middle + radius + 8, middle), 1e-4F);
  }
  // Each is open where it says: the outermost at (0.48, -0.80, 0.36) · 0.9.
  EXPECT_LT(at(volume, middle + 35, middle - 58, middle + 26), 1e-6F);
  EXPECT_LT(at(volume, middle + 45, middle - 20, middle + 27), 1e-6F);
  EXPECT_LT(at(volume, middle + 14, middle - 32, middle + 19), 1e-6F);
  EXPECT_LT(at(volume, middle - 12, middle - 19, middle + 9), 1e-6F);
}

TEST(BuiltinField, SphereRampAndConstantAreExact) {
  const Volume sphere = make_builtin_field("sphere", 5), ramp = make_builtin_field("ramp", 5),
               constant = make_builtin_field("constant", 5);
  for (int i = 0; i < 5; ++i) {
    const float x = -1 + 0.5F * static_cast<float>(i);
    EXPECT_EQ(at(sphere, i, 2, 2), 1 - std::abs(x));
    EXPECT_EQ(at(sphere, 2, i, 2), 1 - std::abs(x));
    EXPECT_EQ(at(sphere, 2, 2, i), 1 - std::abs(x));
    EXPECT_EQ(at(ramp, i, 1, 3), x);
    EXPECT_EQ(at(constant, i, 0, 4), 1);
  }
}

TEST(BuiltinField, RefusesUnknownNamesAndSizes) {
  expect_error([] { make_builtin_field("marschner", 8); },
               {"\"marschner\" is not known", "shells"});
  expect_error([] { make_builtin_field("", 8); }, {"is not known"});
  for (const int points : {-1, 0, 1, 2049}) {
    expect_error([&] { make_builtin_field("ramp", points); },
                 {"ramp", std::to_string(points).c_str(), "2 to 2048"});
  }
  EXPECT_NO_THROW(make_builtin_field("ramp", 2));
}

}  // namespace
}  // namespace pellucid::test_builtin_fields
