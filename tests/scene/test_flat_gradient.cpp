// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/value_noise.h"
#include "pellucid/scene/layer.h"

namespace pellucid::test_flat_gradient {
namespace {

using Points = std::vector<TransferFunction::Point>;

template <class Value>
Layer layer_of(const std::vector<Value>& values, int side, Points points, double spacing = 1) {
  Volume::Description description;
  description.dimensions = {side, side, side};
  description.placement.spacing = {spacing, spacing, spacing};
  Layer layer;
  layer.content =
      VolumeContent{std::make_shared<const Volume>(description, VolumeData(values)),
                    std::make_shared<const TransferFunction>(std::move(points)), nullptr};
  layer.shading = Shading{};
  return layer;
}

const Points everything{{0, 1, {1, 1, 1}}};

/// docs/reference/scene.md, in other words: all values, sorted.
template <class Value>
double expected(const std::vector<Value>& values, int side, double spacing,
                const std::function<double(double)>& extinction) {
  struct Weighted {
    double number, weight;
  };
  std::vector<Weighted> mixed, slopes;
  double lower = values[0], upper = values[0];
  const auto at = [&](int i, int j, int k) {
    return static_cast<double>(values[static_cast<std::size_t>((k * side + j) * side + i)]);
  };
  for (const Value v : values) {
    lower = std::min(lower, static_cast<double>(v));
    upper = std::max(upper, static_cast<double>(v));
  }
  for (int k = 1; k + 1 < side; ++k) {
    for (int j = 1; j + 1 < side; ++j) {
      for (int i = 1; i + 1 < side; ++i) {
        const double weight = extinction(at(i, j, k));
        const double w[3] = {1, -2, 1};
        double n[3] = {0, 0, 0};
        for (int a = -1; a <= 1; ++a) {
          for (int b = -1; b <= 1; ++b) {
            n[0] += w[a + 1] * w[b + 1] * at(i + a, j + b, k);
            n[1] += w[a + 1] * w[b + 1] * at(i, j + a, k + b);
            n[2] += w[a + 1] * w[b + 1] * at(i + a, j, k + b);
          }
        }
        for (const double each : n) mixed.push_back({std::abs(each), weight});
        const double x = at(i + 1, j, k) - at(i - 1, j, k), y = at(i, j + 1, k) - at(i, j - 1, k),
                     z = at(i, j, k + 1) - at(i, j, k - 1);
        slopes.push_back({std::sqrt(x * x + y * y + z * z) / 2, weight});
      }
    }
  }
  const auto quantile = [](std::vector<Weighted>& list, double share) {
    std::ranges::sort(list, {}, &Weighted::number);
    double sum = 0;
    for (const Weighted& each : list) sum += each.weight;
    double left = share * sum;
    for (const Weighted& each : list) {
      left -= each.weight;
      if (left <= 0) return each.number;
    }
    return list.back().number;
  };
  double least = 1e300;
  for (const Weighted& each : mixed) {
    if (each.weight > 0 && each.number > 1e-12 * (upper - lower))
      least = std::min(least, each.number);
  }
  const double sigma = std::max(quantile(mixed, 0.5) / 4, least < 1e300 ? 0.29 * least : 0);
  return std::max(std::min(2.5 * sigma, quantile(slopes, 0.98) / 4) / spacing,
                  (upper - lower) / (50 * spacing * (side - 1)));
}

TEST(FlatGradient, IsAsDocumented) {
  constexpr int side = 30;
  std::mt19937 random(7);
  for (const double sigma : {0.0, 0.3, 3.0, 20.0}) {
    std::normal_distribution<double> noise(0, 1);
    std::vector<float> values;
    std::vector<std::uint8_t> bytes;
    for (int k = 0; k < side; ++k) {
      for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
          const double x = i - 14.3, y = j - 15.2, z = k - 14.9;
          const double v = 100 + 90 * std::tanh((9 - std::sqrt(x * x + y * y + z * z)) / 2) +
                           sigma * noise(random);
          values.push_back(static_cast<float>(v));
          bytes.push_back(static_cast<std::uint8_t>(std::clamp(std::round(v), 0.0, 255.0)));
        }
      }
    }
    for (const double spacing : {1.0, 0.02}) {
      SCOPED_TRACE(testing::Message() << sigma << ", " << spacing);
      const auto all = [](double) { return 1.0; };
      const auto inner = [](double v) { return v > 120 ? 2.0 : 0.0; };
      const Points of_inner{{120, 0, {1, 1, 1}}, {120, 2, {1, 1, 1}}};
      // Quantiles of whole numbers are known to a quarter of a factor of 2.
      const auto near = [&](double found, double truth, double share = 0.06) {
        EXPECT_NEAR(found, truth, share * truth);
      };
      near(flat_gradient(layer_of(values, side, everything, spacing)),
           expected(values, side, spacing, all));
      near(flat_gradient(layer_of(values, side, of_inner, spacing)),
           expected(values, side, spacing, inner));
      near(flat_gradient(layer_of(bytes, side, of_inner, spacing)),
           expected(bytes, side, spacing, inner), 0.19);
    }
  }
}

TEST(FlatGradient, OfSmoothDataDoesNotDependOnTheVoxel) {
  for (const char* const name : {"sphere", "hydrogen"}) {
    std::vector<double> found;
    for (const int points : {32, 64, 128, 256}) {
      Layer layer;
      layer.content = VolumeContent{
          std::make_shared<const Volume>(make_builtin_field(name, points)),
          std::make_shared<const TransferFunction>(Points{{0.05, 0, {}}, {0.2, 1, {}}}), nullptr};
      layer.shading = Shading{};
      found.push_back(flat_gradient(layer));
    }
    EXPECT_NEAR(found[2], found[3], 0.05 * found[3]) << name;
    // What it takes from light is less where the data are coarse, too.
    EXPECT_LT(found[0], 4 * found[3]) << name;
  }
}

TEST(FlatGradient, OfSurfacesIsZeroUnlessAFlatnessIsGiven) {
  Layer layer = layer_of(std::vector<float>{0, 1, 2, 3, 4, 5, 6, 8}, 2, everything, 0.5);
  EXPECT_EQ(flat_gradient_of_surfaces(layer), 0);
  EXPECT_GT(flat_gradient(layer), 0);
  layer.shading->flatness = 0.25;
  EXPECT_EQ(flat_gradient_of_surfaces(layer), 0.25 * 8 / 0.5);
  EXPECT_EQ(flat_gradient(layer), 0.25 * 8 / 0.5);
  layer.shading->flatness.reset();
  layer.shading->flat_gradient = 7;
  EXPECT_EQ(flat_gradient_of_surfaces(layer), 0);
  EXPECT_EQ(flat_gradient(layer), 7);
  layer.shading->flatness = 0.1;
  EXPECT_THROW(check_layer(layer, "layer"), Error);
}

TEST(FlatGradient, OfPartsThatAreAddedIsThatOfTheWhole) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 1);
  std::vector<float> values(40 * 40 * 40);
  for (float& v : values) v = noise(random);
  Layer layer = layer_of(values, 40, everything);
  const auto whole = std::get<VolumeContent>(layer.content).volume;
  ValueNoise sum = whole->noise();
  std::ranges::fill(sum.counts(), 0);
  for (const int half : {0, 1}) {
    Volume::Description description = whole->description();
    description.dimensions[2] = 20;
    const Volume part =
        Volume(description, VolumeData(std::vector<float>(values.begin() + half * 32000,
                                                          values.begin() + (half + 1) * 32000)))
            .as_part_of(whole->statistics().minimum, whole->statistics().maximum);
    ValueNoise own = part.noise();
    for (std::size_t i = 0; i < own.counts().size(); ++i) sum.counts()[i] += own.counts()[i];
  }
  const double expected_gradient = flat_gradient(layer);
  EXPECT_NEAR(flat_gradient(layer, sum, 39), expected_gradient, 0.03 * expected_gradient);
}

TEST(FlatGradient, OfDataWithoutNeighborsIsNotNegativeNorNaN) {
  for (const float value : {0.0F, 5.0F, std::nanf("")}) {
    const double g = flat_gradient(layer_of(std::vector<float>(8, value), 2, everything));
    EXPECT_EQ(g, 0);
  }
}

}  // namespace
}  // namespace pellucid::test_flat_gradient
