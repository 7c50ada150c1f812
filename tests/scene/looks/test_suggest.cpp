// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/suggest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/derived_channels.h"
#include "tests/scene/expect_error.h"

namespace pellucid::test_suggest {
namespace {

constexpr int side = 48;
constexpr std::size_t places = std::size_t{side} * side * side;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class Value>
std::shared_ptr<const Volume> volume(std::vector<Value> values, double spacing = 1) {
  Volume::Description description;
  description.dimensions = {side, side, side};
  description.placement.spacing = {spacing, spacing, spacing};
  return std::make_shared<const Volume>(description, VolumeData(std::move(values)));
}

template <class Value>
Channels one(std::vector<Value> values, double spacing = 1) {
  return Channels({{"a", "", volume(std::move(values), spacing)}});
}

Channels with_gradient(std::shared_ptr<const Volume> value) {
  auto gradient = std::make_shared<const Volume>(gradient_magnitude(*value));
  return Channels({{"value", "", std::move(value)}, {"gradient_magnitude", "", gradient}});
}

/// Independent numbers of mean 0 and standard deviation 1, nearly normal, the same each time.
class Noise {
 public:
  double next() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) {
      state_ = state_ * 6364136223846793005U + 1442695040888963407U;
      sum += static_cast<double>(state_ >> 11) / 9007199254740992.0;
    }
    return sum;
  }

 private:
  std::uint64_t state_ = 1;
};

double radius(std::size_t place) {
  const auto at = [](std::size_t i) { return static_cast<double>(i) - (side - 1) / 2.0; };
  return std::hypot(at(place % side), at(place / side % side), at(place / side / side));
}

/// A ball of 100 around one of 200, in nothing, their edges blurred.
constexpr double outer = 18, inner = 9, blur = 1.5;
std::vector<float> balls(double noise = 0.3) {
  std::vector<float> values;
  Noise random;
  for (std::size_t i = 0; i < places; ++i) {
    const auto within = [&](double edge) {
      return std::erfc((radius(i) - edge) / (blur * std::numbers::sqrt2)) / 2;
    };
    values.push_back(
        static_cast<float>(100 * (within(outer) + within(inner)) + noise * random.next()));
  }
  return values;
}

double extinction_at(const std::vector<GaussianPrimitive>& primitives, int channels,
                     const std::vector<double>& v) {
  return MultivariateTransferFunction(channels, primitives).view().evaluate(v.data()).extinction;
}

const GaussianPrimitive& nearest(const std::vector<GaussianPrimitive>& primitives,
                                 const std::vector<double>& center) {
  const auto distance = [&](const GaussianPrimitive& p) {
    double square = 0;
    for (std::size_t i = 0; i < center.size(); ++i) {
      square += (p.center[i] - center[i]) * (p.center[i] - center[i]);
    }
    return square;
  };
  return *std::min_element(primitives.begin(), primitives.end(),
                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
}

void expect_equal(const std::vector<GaussianPrimitive>& a,
                  const std::vector<GaussianPrimitive>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].center, b[i].center);
    EXPECT_EQ(a[i].matrix, b[i].matrix);
    EXPECT_EQ(a[i].extinction, b[i].extinction);
    EXPECT_EQ(a[i].color, b[i].color);
  }
}

void in_threads(int count, const std::function<void(int, int)>& body) {
  std::thread first([&] { body(0, count / 3); });
  body(count / 3, count);
  first.join();
}

TEST(SuggestBoundaries, FindsMaterialsAndTheArchesBetweenThem) {
  const Channels channels = with_gradient(volume(balls()));
  const auto primitives = suggest_boundaries(channels, 0, 1);
  ASSERT_EQ(primitives.size(), 4U);
  // The derivative of an edge blurred by σ is at most Δ/(σ √(2π)); central differences over two
  // values see a little less.
  const double steepest = 100 / (blur * std::sqrt(2 * std::numbers::pi));
  const std::vector<double> expected[] = {{50, steepest}, {100, 0}, {150, steepest}, {200, 0}};
  for (const auto& center : expected) {
    const GaussianPrimitive& p = nearest(primitives, center);
    EXPECT_NEAR(p.center[0], center[0], 3);
    EXPECT_NEAR(p.center[1], center[1], 0.15 * steepest);
    EXPECT_EQ(p.channels, (std::vector<ChannelRef>{0, 1}));
  }
}

TEST(SuggestBoundaries, BackgroundIsTransparentAndTheRestIsSeenThroughAndThrough) {
  const Channels channels = with_gradient(volume(balls()));
  const auto primitives = suggest_boundaries(channels, 0, 1);
  EXPECT_LT(side * extinction_at(primitives, 2, {0, 0.2}), 0.02);
  // Along a line through the middle.
  double depth = 0;
  const auto& value = std::get<DataArray<float>>(channels[0].volume->data());
  const auto& gradient = std::get<DataArray<float>>(channels[1].volume->data());
  for (std::size_t x = 0; x < side; ++x) {
    const std::size_t place = x + side * (side / 2 + side * std::size_t{side / 2});
    depth += extinction_at(
        primitives, 2, {static_cast<double>(value[place]), static_cast<double>(gradient[place])});
  }
  EXPECT_GT(depth, 0.7);
  EXPECT_LT(depth, 12);
}

TEST(SuggestBoundaries, WhatIsRarerIsDenser) {
  const auto primitives = suggest_boundaries(with_gradient(volume(balls())), 0, 1);
  EXPECT_GT(nearest(primitives, {200, 0}).extinction, 2 * nearest(primitives, {100, 0}).extinction);
  EXPECT_GT(nearest(primitives, {150, 26}).extinction, nearest(primitives, {50, 26}).extinction);
}

TEST(SuggestBoundaries, LooksTheSameAtEverySize) {
  const auto small = suggest_boundaries(with_gradient(volume(balls(), 0.5)), 0, 1);
  const auto large = suggest_boundaries(with_gradient(volume(balls(), 50)), 0, 1);
  ASSERT_EQ(small.size(), large.size());
  for (std::size_t i = 0; i < small.size(); ++i) {
    EXPECT_NEAR(small[i].center[0], large[i].center[0], 1e-9);
    EXPECT_NEAR(small[i].center[1], 100 * large[i].center[1], 1e-2);
    // Two digits each.
    EXPECT_NEAR(small[i].extinction / large[i].extinction, 100, 6);
  }
}

TEST(SuggestBoundaries, WithoutTwoMaterialsIsTheMixture) {
  std::vector<float> values;
  for (std::size_t i = 0; i < places; ++i) {
    values.push_back(static_cast<float>(std::exp(-radius(i) * radius(i) / 100)));
  }
  const Channels channels = with_gradient(volume(values));
  expect_equal(suggest_boundaries(channels, 0, 1), suggest_mixture(channels, {0, 1}));
}

TEST(SuggestMixture, RecoversTissuesOfOneToThreeChannels) {
  // Means of the background and of two tissues in each channel; the deviation is 4.
  const double means[3][3] = {{10, 60, 100}, {10, 100, 50}, {20, 80, 120}};
  for (int n = 1; n <= 3; ++n) {
    SCOPED_TRACE(n);
    Noise random;
    std::vector<Channel> list;
    std::vector<int> which;
    for (int c = 0; c < n; ++c) {
      std::vector<float> values;
      for (std::size_t i = 0; i < places; ++i) {
        const int tissue = radius(i) < inner ? 2 : radius(i) < outer ? 1 : 0;
        values.push_back(static_cast<float>(means[c][tissue] + 4 * random.next()));
      }
      list.push_back({std::string(1, static_cast<char>('a' + c)), "", volume(values)});
      which.push_back(c);
    }
    const Channels channels(list);
    const auto primitives = suggest_mixture(channels, which, 2);
    ASSERT_EQ(primitives.size(), 2U);
    std::vector<double> background;
    for (int c = 0; c < n; ++c) background.push_back(means[c][0]);
    EXPECT_LT(side * extinction_at(primitives, n, background), 0.02);
    for (const int tissue : {1, 2}) {
      std::vector<double> center;
      for (int c = 0; c < n; ++c) center.push_back(means[c][tissue]);
      const GaussianPrimitive& p = nearest(primitives, center);
      // The outermost values of the background are left in, and draw a little.
      for (std::size_t c = 0; c < center.size(); ++c) EXPECT_NEAR(p.center[c], center[c], 6);
      EXPECT_GT(extinction_at(primitives, n, center), 0.5 * p.extinction);
    }
  }
}

TEST(SuggestMixture, MakesAsManyAsAsked) {
  const Channels channels = with_gradient(volume(balls(4)));
  for (const int n : {1, 3, 8}) {
    EXPECT_EQ(suggest_mixture(channels, {0, 1}, n).size(), static_cast<std::size_t>(n));
  }
  EXPECT_LE(suggest_mixture(channels, {0, 1}).size(), 5U);
}

TEST(SuggestMixture, ShowsAConstantAsHaze) {
  const auto primitives = suggest_mixture(one(std::vector<float>(places, 3.5F)), {0});
  ASSERT_EQ(primitives.size(), 1U);
  // A line along an axis, 48 values long, has the optical depth 1.
  EXPECT_NEAR(side * extinction_at(primitives, 1, {3.5}), 1, 0.06);
}

TEST(SuggestMixture, ShowsAMaskAndNotWhatIsAroundIt) {
  std::vector<std::uint8_t> values;
  for (std::size_t i = 0; i < places; ++i) values.push_back(radius(i) < inner ? 1 : 0);
  for (const Channels& channels : {one(values), with_gradient(volume(values))}) {
    const int n = channels.count();
    const auto primitives =
        n == 1 ? suggest_mixture(channels, {0}) : suggest_boundaries(channels, 0, 1);
    ASSERT_GE(primitives.size(), 1U);
    EXPECT_LT(side * extinction_at(primitives, n, {0, 0}), 0.02);
    EXPECT_GT(2 * inner * extinction_at(primitives, n, {1, 0}), 0.2);
  }
}

TEST(SuggestMixture, TakesNoise) {
  std::vector<float> values;
  Noise random;
  for (std::size_t i = 0; i < places; ++i) values.push_back(static_cast<float>(random.next()));
  const Channels channels = with_gradient(volume(values));
  for (const auto& primitives :
       {suggest_boundaries(channels, 0, 1), suggest_mixture(channels, {0})}) {
    EXPECT_GE(primitives.size(), 1U);
    EXPECT_NO_THROW(MultivariateTransferFunction(2, primitives));
  }
}

TEST(SuggestMixture, TakesEveryVolumeThatHasANumber) {
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{{-2e37, 2e37},
                                                                        {0, 2e37},
                                                                        {0, 5e-324},
                                                                        {1e-310, 1e-300},
                                                                        {1e9, 1e9 + 1e-6},
                                                                        {1, std::nextafter(1, 2)},
                                                                        {nan, 3},
                                                                        {-3, -1}}) {
    for (const std::size_t period : {1U, 2U, 5000U}) {
      for (const double spacing : {1e-30, 1.0, 1e30}) {
        SCOPED_TRACE(std::to_string(low) + " " + std::to_string(high) + " " +
                     std::to_string(period) + " " + std::to_string(spacing));
        std::vector<double> values;
        for (std::size_t i = 0; i < places; ++i) values.push_back(i % period == 0 ? high : low);
        const auto primitives = suggest_mixture(one(values, spacing), {0});
        EXPECT_GE(primitives.size(), 1U);
        EXPECT_NO_THROW(MultivariateTransferFunction(1, primitives));
      }
    }
  }
}

TEST(SuggestMixture, IsUsableForEveryBuiltinField) {
  for (const std::string_view name : builtin_field_names()) {
    SCOPED_TRACE(name);
    const Channels channels =
        with_gradient(std::make_shared<const Volume>(make_builtin_field(name, 33)));
    const auto primitives = suggest_boundaries(channels, 0, 1);
    ASSERT_GE(primitives.size(), 1U);
    const MultivariateTransferFunction function(2, primitives);
    EXPECT_GT(function.largest_extinction(), 0);
  }
}

TEST(SuggestMixture, IsTheSameEachTimeAndForAnyNumberOfThreads) {
  const Channels channels = with_gradient(volume(balls(4)));
  expect_equal(suggest_boundaries(channels, 0, 1), suggest_boundaries(channels, 0, 1, in_threads));
  expect_equal(suggest_mixture(channels, {0, 1}), suggest_mixture(channels, {0, 1}, 0, in_threads));
}

/// Channels of more points than a quick suggestion looks at: tissues in nested boxes, with noise.
Channels many_points(double deviation) {
  constexpr int wide = 144, points = wide * wide * wide;
  Noise random;
  std::vector<Channel> list;
  const double means[2][3] = {{0, 100, 60}, {0, 40, 110}};
  for (int c = 0; c < 2; ++c) {
    std::vector<float> values;
    for (int i = 0; i < points; ++i) {
      const int x = i % wide, y = i / wide % wide, z = i / wide / wide;
      const int edge = std::min({x, y, z, wide - 1 - x, wide - 1 - y, wide - 1 - z});
      const int tissue = edge < wide / 6 ? 0 : edge < wide / 3 ? 1 : 2;
      values.push_back(static_cast<float>(means[c][tissue] + deviation * random.next()));
    }
    Volume::Description description;
    description.dimensions = {wide, wide, wide};
    list.push_back({std::string(1, static_cast<char>('a' + c)), "",
                    std::make_shared<const Volume>(description, VolumeData(std::move(values)))});
  }
  return Channels(std::move(list));
}

TEST(SuggestMixture, LooksAtASampleIfItIsToBeQuick) {
  const Channels channels = many_points(4);
  const auto primitives = suggest_mixture(channels, {0, 1}, 2);
  expect_equal(primitives, suggest_mixture(channels, {0, 1}, 2, in_threads));
  const auto quick = suggest_mixture(channels, {0, 1}, 2, {}, {true, {}});
  expect_equal(quick, suggest_mixture(channels, {0, 1}, 2, in_threads, {true, {}}));
  for (const auto& found : {primitives, quick}) {
    ASSERT_EQ(found.size(), 2U);
    for (const auto& center : {std::vector<double>{100, 40}, std::vector<double>{60, 110}}) {
      const GaussianPrimitive& p = nearest(found, center);
      for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(p.center[c], center[c], 2);
    }
    // Lines along an axis meet 96 points of the outer tissue or, in the middle, 48 of each.
    const double outer_depth = nearest(found, {100, 40}).extinction * 96;
    EXPECT_GT(outer_depth, 0.5);
    EXPECT_LT(outer_depth, 2);
  }
}

TEST(SuggestMixture, LeavesOutTheRimOfTheBackground) {
  // Wider than a background may be: points remain on all sides of it.
  const auto primitives = suggest_mixture(many_points(16), {0, 1});
  EXPECT_EQ(suggest_mixture(many_points(16), {0, 1}, 5).size(), 5U);
  ASSERT_GE(primitives.size(), 2U);
  for (const GaussianPrimitive& p : primitives) {
    EXPECT_GT(std::hypot(p.center[0], p.center[1]), 80) << p.center[0] << " " << p.center[1];
  }
}

TEST(Suggest, TellsItsProgressAndEndsWhenItIsToldTo) {
  const Channels channels = with_gradient(volume(balls(4)));
  std::vector<double> told;
  const SuggestControl tells{false, [&](double fraction) { told.push_back(fraction); }};
  suggest_mixture(channels, {0, 1}, 0, in_threads, tells);
  suggest_boundaries(channels, 0, 1, in_threads, tells);
  ASSERT_GE(told.size(), 6U);
  EXPECT_EQ(std::count(told.begin(), told.end(), 0.0), 2);
  EXPECT_EQ(std::count(told.begin(), told.end(), 1.0), 2);
  EXPECT_TRUE(std::is_sorted(told.begin(), std::find(told.begin(), told.end(), 1.0)));
  struct Enough {};
  const SuggestControl ends{false, [](double fraction) {
                              if (fraction > 0) throw Enough{};
                            }};
  EXPECT_THROW(suggest_mixture(channels, {0, 1}, 0, {}, ends), Enough);
  EXPECT_THROW(suggest_boundaries(channels, 0, 1, {}, ends), Enough);
}

TEST(Suggest, RefusesWhatIsNotThere) {
  const Channels empty = one(std::vector<double>(places, nan));
  expect_error([&] { suggest_mixture(empty, {0}); }, {"no data point", "every channel"});
  std::vector<double> half(places, nan), other(places, nan);
  for (std::size_t i = 0; i < places; ++i) (i % 2 == 0 ? half : other)[i] = 1;
  const Channels apart({{"a", "", volume(half)}, {"b", "", volume(other)}});
  expect_error([&] { suggest_mixture(apart, {0, 1}); }, {"no data point"});
  expect_error([&] { suggest_boundaries(apart, 0, 1); }, {"no data point"});
  expect_error([&] { suggest_boundaries(apart, 0, 2); }, {"channel 2", "there are 2"});
  expect_error([&] { suggest_mixture(apart, {}); }, {"0 channels", "1 to 3"});
  expect_error([&] { suggest_mixture(apart, {0, 0}); }, {"channel 0 twice"});
  expect_error([&] { suggest_mixture(apart, {-1}); }, {"channel -1"});
  expect_error([&] { suggest_mixture(apart, {0}, 9); }, {"primitives is 9", "from 1 to 8"});
}

}  // namespace
}  // namespace pellucid::test_suggest
