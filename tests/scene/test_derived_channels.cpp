// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/derived_channels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "derived_fields.h"
#include "expect_error.h"

namespace pellucid::test_derived_channels {
namespace {

using derived_fields::each;
using derived_fields::in_threads;
using derived_fields::nan;
using derived_fields::of_indices;

Volume::Description description(int nx, int ny, int nz) {
  Volume::Description d;
  d.dimensions = {nx, ny, nz};
  d.name = "knee.nrrd";
  return d;
}

/// Spacings that differ, and axes that are neither orthogonal nor of length 1.
GridPlacement sheared() {
  GridPlacement p;
  p.origin = {10, -20, 5};
  p.spacing = {0.5, 2, 0.25};
  p.direction = {{{0.8, 0.6, 0}, {-0.5, 1, 0.3}, {0.2, -0.1, 1.5}}};
  return p;
}

/// A polynomial of degree 2 of world positions, and what the variables made of it are.
struct Quadratic {
  double value(const Vec3<double>& p) const {
    return 3 + 2 * p.x - p.y + 0.5 * p.z + p.x * p.x - 0.75 * p.y * p.y + 0.3 * p.z * p.z +
           0.4 * p.x * p.y - 0.6 * p.x * p.z + 0.2 * p.y * p.z;
  }
  Vec3<double> gradient(const Vec3<double>& p) const {
    return {2 + 2 * p.x + 0.4 * p.y - 0.6 * p.z, -1 - 1.5 * p.y + 0.4 * p.x + 0.2 * p.z,
            0.5 + 0.6 * p.z - 0.6 * p.x + 0.2 * p.y};
  }
  double magnitude(const Vec3<double>& p) const {
    const Vec3<double> g = gradient(p);
    return std::hypot(g.x, g.y, g.z);
  }
  double second(const Vec3<double>& p) const {
    const Vec3<double> g = gradient(p);
    const double along = 2 * g.x * g.x - 1.5 * g.y * g.y + 0.6 * g.z * g.z +
                         2 * (0.4 * g.x * g.y - 0.6 * g.x * g.z + 0.2 * g.y * g.z);
    return along / (g.x * g.x + g.y * g.y + g.z * g.z);
  }
};

/// On the grid of the description, whose data values are at position[a][i] along its axes.
void expect_quadratic(const Volume::Description& d,
                      const std::array<std::vector<double>, 3>& position) {
  const Quadratic f;
  const auto world = [&](int i, int j, int k) {
    const int index[3] = {i, j, k};
    Vec3<double> p = d.placement.origin;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const double along = d.coordinates[axis].empty() ? d.placement.spacing[a] : 1.0;
      p = p + d.placement.direction.column[a] *
                  (along * position[axis][static_cast<std::size_t>(index[a])]);
    }
    return p;
  };
  const Volume volume =
      of_indices<double>(d, [&](int i, int j, int k) { return f.value(world(i, j, k)); });
  each(gradient_magnitude(volume), [&](int i, int j, int k, double v) {
    const double truth = f.magnitude(world(i, j, k));
    EXPECT_NEAR(v, truth, 1e-6 * truth) << i << " " << j << " " << k;
  });
  each(second_derivative(volume), [&](int i, int j, int k, double v) {
    EXPECT_NEAR(v, f.second(world(i, j, k)), 1e-6) << i << " " << j << " " << k;
  });
}

const std::vector<double> indices{0, 1, 2, 3, 4, 5, 6, 7};

TEST(DerivedChannels, QuadraticsAreExactOnShearedGrids) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    Volume::Description d = description(6, 5, 4);
    d.centering = centering;
    d.placement = sheared();
    expect_quadratic(d, {indices, indices, indices});
  }
}

TEST(DerivedChannels, QuadraticsAreExactOnRectilinearAxes) {
  Volume::Description d = description(5, 4, 3);
  d.placement = sheared();
  d.coordinates[0] = {-1, -0.5, 0.25, 3, 3.5};
  d.coordinates[2] = {2, 2.125, 4};
  expect_quadratic(d, {d.coordinates[0], indices, d.coordinates[2]});
  // The values of cells are in the middles of their faces.
  d.centering = Centering::cell;
  d.coordinates[0] = {-1, -0.5, 0.25, 3, 3.5, 8};
  d.coordinates[2] = {2, 2.125, 4, 4.5};
  expect_quadratic(d, {std::vector<double>{-0.75, -0.125, 1.625, 3.25, 5.75}, indices,
                       std::vector<double>{2.0625, 3.0625, 4.25}});
}

TEST(DerivedChannels, CubicsByHand) {
  const Volume v =
      of_indices<float>(description(5, 2, 2), [](int i, int, int) { return i * i * i; });
  // (f(i+1) - f(i-1)) / 2 = 3i² + 1; at the ends of the parabolas through 0, 1, 8 and 8, 27, 64.
  const double first[] = {-2, 4, 13, 28, 46};
  const double second[] = {6, 6, 12, 18, 18};
  each(gradient_magnitude(v),
       [&](int i, int, int, double g) { EXPECT_EQ(g, std::abs(first[i])) << i; });
  each(second_derivative(v), [&](int i, int, int, double h) { EXPECT_EQ(h, second[i]) << i; });
}

TEST(DerivedChannels, TwoValuesAreALineAndOneIsConstant) {
  Volume::Description d = description(2, 1, 3);
  d.centering = Centering::cell;
  d.placement.spacing = {0.5, 3, 2};
  const Volume v = of_indices<float>(d, [](int i, int, int k) { return 4 * i + k * k; });
  const double along_z[] = {0, 1, 2};
  each(gradient_magnitude(v), [&](int, int, int k, double g) {
    EXPECT_FLOAT_EQ(static_cast<float>(g), static_cast<float>(std::hypot(8, along_z[k])));
  });
  each(second_derivative(v), [&](int, int, int k, double h) {
    EXPECT_NEAR(h, 0.5 * along_z[k] * along_z[k] / (64 + along_z[k] * along_z[k]), 1e-7);
  });
  d.dimensions = {1, 1, 1};
  const Volume single = of_indices<float>(d, [](int, int, int) { return 7; });
  each(gradient_magnitude(single), [](int, int, int, double g) { EXPECT_EQ(g, 0); });
  each(second_derivative(single), [](int, int, int, double h) { EXPECT_EQ(h, 0); });
}

template <class Value>
void expect_of_type() {
  Volume::Description d = description(6, 5, 4);
  d.placement.spacing = {1, 2, 0.5};
  const Volume v =
      of_indices<Value>(d, [](int i, int j, int k) { return 20 + i * i - 4 * j + 6 * k; });
  each(gradient_magnitude(v), [](int i, int, int, double g) {
    EXPECT_EQ(g, static_cast<float>(std::sqrt(4.0 * i * i + 4 + 144)));
  });
  each(second_derivative(v), [](int i, int, int, double h) {
    EXPECT_FLOAT_EQ(static_cast<float>(h), static_cast<float>(8.0 * i * i / (4.0 * i * i + 148)));
  });
}

TEST(DerivedChannels, OfEveryType) {
  expect_of_type<std::uint8_t>();
  expect_of_type<std::int8_t>();
  expect_of_type<std::uint16_t>();
  expect_of_type<std::int16_t>();
  expect_of_type<std::uint32_t>();
  expect_of_type<std::int32_t>();
  expect_of_type<float>();
  expect_of_type<double>();
}

TEST(DerivedChannels, DifferencesOfLargeNumbersKeepTheirDigits) {
  const Volume v = of_indices<std::uint32_t>(description(4, 2, 2), [](int i, int, int) {
    return 4294967290u + static_cast<std::uint32_t>(i);
  });
  each(gradient_magnitude(v), [](int, int, int, double g) { EXPECT_EQ(g, 1); });
}

TEST(DerivedChannels, ConstantsHaveNoGradient) {
  Volume::Description d = description(5, 4, 3);
  d.placement = sheared();
  d.coordinates[1] = {0, 0.1, 0.3, 0.7};
  const Volume v = of_indices<double>(d, [](int, int, int) { return 1e30 / 3; });
  each(gradient_magnitude(v), [](int, int, int, double g) { EXPECT_EQ(g, 0); });
  each(second_derivative(v), [](int, int, int, double h) { EXPECT_EQ(h, 0); });
}

TEST(DerivedChannels, NanWhereItIsNeeded) {
  const Volume v = of_indices<float>(description(7, 7, 7), [](int i, int j, int k) {
    return i == 3 && j == 3 && k == 3 ? nan : i + 2 * j + 3 * k;
  });
  const Volume gradient = gradient_magnitude(v), second = second_derivative(v);
  EXPECT_EQ(gradient.statistics().nan, 7u);
  EXPECT_EQ(second.statistics().nan, 19u);
  each(gradient, [](int i, int j, int k, double g) {
    const int steps = std::abs(i - 3) + std::abs(j - 3) + std::abs(k - 3);
    EXPECT_EQ(std::isnan(g), steps <= 1) << i << " " << j << " " << k;
    if (steps > 1) {
      EXPECT_FLOAT_EQ(static_cast<float>(g), std::sqrt(14.0f));
    }
  });
  each(second, [](int i, int j, int k, double h) {
    const int x = std::abs(i - 3), y = std::abs(j - 3), z = std::abs(k - 3);
    EXPECT_EQ(std::isnan(h), x + y + z <= 2 && x < 2 && y < 2 && z < 2)
        << i << " " << j << " " << k;
  });
  // At the border two more values count.
  const Volume edge = of_indices<float>(description(5, 2, 2),
                                        [](int i, int, int) { return i == 2 ? nan : 1.0 * i; });
  each(gradient_magnitude(edge), [](int, int, int, double g) { EXPECT_TRUE(std::isnan(g)); });
}

TEST(DerivedChannels, NamesAndGridAreKept) {
  Volume::Description d = description(4, 3, 2);
  d.placement = sheared();
  d.centering = Centering::cell;
  d.coordinates[1] = {0, 1, 3, 4};
  const Volume v = of_indices<float>(d, [](int i, int, int) { return i; });
  const Volume gradient = gradient_magnitude(v);
  EXPECT_EQ(gradient.description().name, "gradient magnitude of knee.nrrd");
  EXPECT_EQ(second_derivative(v).description().name, "second derivative of knee.nrrd");
  EXPECT_EQ(gradient.description().coordinates, d.coordinates);
  EXPECT_EQ(gradient.description().centering, Centering::cell);
  EXPECT_EQ(gradient.world_corners(), v.world_corners());
}

TEST(DerivedChannels, WhatNoVolumeMayHoldIsRefused) {
  Volume::Description d = description(3, 2, 2);
  d.placement.spacing = {0.01, 1, 1};
  const auto step = [](int i, int j, int) { return j == 1 ? i * 1e36 : 0; };
  const Volume v = of_indices<float>(d, step);
  expect_error([&] { gradient_magnitude(v); },
               {"gradient magnitude of knee.nrrd: ", "index (0, 1, 0)", "2.1", "e+37", "unit"});
  expect_error([&] { gradient_magnitude(v, in_threads(3)); }, {"index (0, 1, 0)"});
  // Where doubles overflow too, and must not become the NaN of empty space.
  for (const double tiny : {1e-140, 1e-290}) {
    d.placement.spacing = {tiny, 2 * tiny, tiny};
    const Volume small =
        of_indices<double>(d, [](int i, int j, int k) { return (i * i - 3 * j + 2 * k) * 1e36; });
    expect_error([&] { gradient_magnitude(small); }, {"gradient magnitude of", "beyond"});
    expect_error([&] { second_derivative(small); }, {"second derivative of", "beyond"});
    each(gradient_magnitude(of_indices<float>(d, [](int, int, int) { return 5; })),
         [](int, int, int, double g) { EXPECT_EQ(g, 0); });
  }
  d = description(3, 2, 2);
  d.coordinates[0] = {0, 1e-300, 2};
  const Volume uneven = of_indices<double>(d, [](int i, int, int) { return i * i * 1e36; });
  expect_error([&] { second_derivative(uneven); }, {"second derivative of", "beyond"});
}

bool same(const Volume& p, const Volume& q) {
  const auto &a = std::get<DataArray<float>>(p.data()), &b = std::get<DataArray<float>>(q.data());
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(DerivedChannels, TheSameWhateverTheThreads) {
  Volume::Description d = description(13, 11, 7);
  d.placement = sheared();
  const Volume v = of_indices<std::int16_t>(
      d, [](int i, int j, int k) { return (i * 37 + j * 101 + k * 53) % 61; });
  const Volume gradient = gradient_magnitude(v), second = second_derivative(v);
  for (const int parts : {1, 2, 5, 32}) {
    EXPECT_TRUE(same(gradient_magnitude(v, in_threads(parts)), gradient)) << parts;
    EXPECT_TRUE(same(second_derivative(v, in_threads(parts)), second)) << parts;
  }
}

}  // namespace
}  // namespace pellucid::test_derived_channels
