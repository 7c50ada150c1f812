// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include "pellucid/render/integrate_multivariate_ray.h"
#include "pellucid/scene/internal/multivariate_blocks_storage.h"

namespace pellucid::test_multivariate_blocks {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class Maker {
 public:
  explicit Maker(unsigned seed) : random_(seed) {}
  double uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }
  double powers(double lower, double upper) {
    return std::exp(uniform(std::log(lower), std::log(upper)));
  }
  double normal() { return std::normal_distribution<double>()(random_); }
  int pick(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

 private:
  std::mt19937_64 random_;
};

constexpr std::array<int, 3> size{29, 18, 12};

using Field = std::function<double(double, double, double)>;

Channel smooth_channel(const std::array<int, 3>& dimensions, const Field& f) {
  Volume::Description d;
  d.dimensions = dimensions;
  std::vector<float> data;
  for (int k = 0; k < dimensions[2]; ++k) {
    for (int j = 0; j < dimensions[1]; ++j) {
      for (int i = 0; i < dimensions[0]; ++i) data.push_back(static_cast<float>(f(i, j, k)));
    }
  }
  return {"", "", std::make_shared<const Volume>(d, VolumeData(data))};
}

/// The longest steps of blocks, the least one and the longest, of fields behind one
/// Gaussian of a width over the first of them; and which kinds there are among the blocks.
struct StepsBetween {
  double least = 0, most = 0;
  std::set<BlockKind> kinds;
};

StepsBetween steps_between(const std::vector<Field>& fields, double width,
                           const std::array<int, 3>& dimensions = {65, 65, 65}) {
  std::vector<Channel> all;
  for (const Field& f : fields) {
    all.push_back(smooth_channel(dimensions, f));
    all.back().name = std::to_string(all.size());
  }
  const int count = static_cast<int>(all.size());
  const Channels channels(std::move(all));
  GaussianPrimitive p;
  p.channels = {0};
  p.center = {0.5};
  p.matrix = matrix_from_widths({width});
  p.extinction = 1;
  const MultivariateTransferFunction function(count, {p});
  MultivariateBlocksStorage storage(channels, function, 1e-5);
  EXPECT_EQ(storage.smooth().longest_step, 0) << "nothing is known yet";
  storage.find_smooth(channels, function);
  const MultivariateBlocks blocks = storage.view();
  StepsBetween steps{0, storage.smooth().longest_step, {}};
  float waves = 0;
  for (int b = 0; b < blocks.records.count(); ++b) {
    steps.kinds.insert(blocks.classes[b].kind);
    if (steps.most > 0) waves = std::max(waves, storage.smooth().waves[b]);
  }
  if (steps.most > 0) steps.least = 1 / static_cast<double>(waves);
  return steps;
}

Field wave(double length, double noise = 0) {
  return [=](double x, double y, double z) {
    const double wild = std::sin(12.9898 * x + 78.233 * y + 37.719 * z) * 43758.5453;
    return 0.5 + 0.5 * std::sin(2 * std::numbers::pi / length * (x + 0.3 * y - 0.2 * z)) +
           noise * (wild - std::floor(wild));
  };
}
Field ramp(double slope, const std::array<double, 3>& along) {
  return [=](double x, double y, double z) {
    return 0.5 + slope * (along[0] * (x - 32) + along[1] * (y - 32) + along[2] * (z - 32));
  };
}

TEST(SmoothChannelsOfBlocks, AreThoseOfLongWaves) {
  const StepsBetween steps = steps_between({wave(60)}, 3);
  EXPECT_GT(steps.least, 3.5);
  EXPECT_EQ(steps.kinds, std::set{BlockKind::smooth});
  EXPECT_EQ(steps_between({wave(6)}, 3).most, 0);
  EXPECT_EQ(steps_between({wave(60, 0.1)}, 3).most, 0) << "noise";
}

TEST(SmoothChannelsOfBlocks, HaveStepsNoLongerThanAGaussianIsWide) {
  for (const double width : {0.01, 0.04, 0.1}) {
    SCOPED_TRACE(width);
    // Along an axis what bounds the slope is the slope; blocks at its end may be thin.
    for (const int points : {65, 66, 70}) {
      const StepsBetween along =
          steps_between({ramp(1.0 / 20, {0, 1, 0})}, width, {points, points, points});
      EXPECT_NEAR(along.least, std::min(1.6 * width * 20, 4.0), 1e-2);
      EXPECT_NEAR(along.most, std::min(1.6 * width * 20, 4.0), 1e-2);
    }
    // Along a diagonal it is up to √3 of it.
    const double slope = std::sqrt(3.0) / 40;
    const StepsBetween aside = steps_between({ramp(1.0 / 40, {1, -1, 1})}, width);
    EXPECT_LE(aside.most, 1.6 * width / slope * (1 + 1e-2));
    EXPECT_GE(aside.least, std::min(1.6 * width / slope / std::sqrt(3.0), 4.0) * (1 - 1e-2));
  }
  // Where data turn back in the tail of one that reaches far.
  const Field valley = [](double x, double, double) { return 0.9 + 1e-3 * (x - 32) * (x - 32); };
  const StepsBetween turned = steps_between({valley}, 0.15);
  EXPECT_GT(turned.most, 0);
  EXPECT_LT(turned.most, 1.6 / std::sqrt(3.39 * 2e-3 / 0.15) * (1 + 1e-2));
}

TEST(SmoothChannelsOfBlocks, AreLookedAtWhereAPrimitiveDoes) {
  EXPECT_GT(steps_between({wave(60), wave(5, 0.3)}, 3).least, 3.5);
  const Field hole = [](double x, double y, double z) {
    return length(Vec3<double>{x, y, z} - Vec3<double>{50, 50, 50}) < 3 ? nan : wave(60)(x, y, z);
  };
  EXPECT_EQ(steps_between({hole}, 3).kinds, (std::set{BlockKind::cells, BlockKind::smooth}));
  // Blocks in which it is not near are skipped, whatever they are like.
  const Field half = [](double x, double y, double z) {
    return x < 32 ? wave(60)(x, y, z) : 1e3 + wave(5, 0.3)(x, y, z);
  };
  EXPECT_TRUE(steps_between({half}, 3).kinds.count(BlockKind::skip));
}

template <class Value, class F>
Channel channel(const std::string& name, const F& f) {
  Volume::Description d;
  d.dimensions = size;
  std::vector<Value> data;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) data.push_back(static_cast<Value>(f(i, j, k)));
    }
  }
  return {name, "", std::make_shared<const Volume>(d, VolumeData(data))};
}

/// Waves and ramps in three types, the second one with holes.
Channels some_channels(Maker& maker) {
  const double a = maker.uniform(0.1, 0.5), b = maker.uniform(0.1, 0.5),
               hole = maker.uniform(0, 20);
  return Channels(
      {channel<std::uint8_t>(
           "byte", [&](int i, int j, int k) { return 100 + 90 * std::sin(a * i + b * j + k); }),
       channel<float>("float",
                      [&](int i, int j, int k) {
                        return i - hole > 0 && i - hole < 9 && j < 10
                                   ? nan
                                   : 0.05 * i + 0.02 * j * b + 0.01 * k;
                      }),
       channel<double>("double", [&](int i, int j, int k) {
         return std::cos(a * j) + 0.1 * std::sin(b * i * k);
       })});
}

/// Primitives over one to three of the channels, in places where the data are or are not.
std::vector<GaussianPrimitive> some_primitives(Maker& maker, int count) {
  const double scale[3] = {90, 0.7, 1}, middle[3] = {100, 0.7, 0};
  std::vector<GaussianPrimitive> primitives;
  for (int i = 0; i < count; ++i) {
    GaussianPrimitive p;
    const int all[3] = {0, 1, 2};
    const int first = maker.pick(3), many = 1 + maker.pick(3);
    for (int n = 0; n < many; ++n) p.channels.push_back(all[(first + n) % 3]);
    for (int n = 0; n < many; ++n) {
      const int c = p.channels[static_cast<std::size_t>(n)];
      p.center.push_back(middle[c] + scale[c] * maker.uniform(-1.5, 1.5));
      std::vector<double> row;
      for (int m = 0; m < many; ++m) {
        const double width = scale[p.channels[static_cast<std::size_t>(m)]];
        row.push_back((m == n ? maker.powers(2, 30) : 0.5 * maker.normal()) / width);
      }
      p.matrix.push_back(row);
    }
    p.extinction = maker.pick(10) == 0 ? 0 : maker.powers(1e-4, 10);
    p.color = {maker.uniform(0, 1), maker.uniform(0, 1), maker.uniform(0, 1)};
    primitives.push_back(p);
  }
  return primitives;
}

std::vector<ChannelTransferFunction> a_table() {
  return {{1, TransferFunction({{1.2, 0, {1, 1, 1}}, {1.3, 2, {1, 0, 0}}, {1.35, 0, {0, 0, 1}}})}};
}

/// Calls see(values) at so many places in each cell of a block that is no vacuum, corners included.
template <class See>
void look_around(const MultichannelGrid& grid, int i, int j, int k, Maker& maker, const See& see) {
  for (int z = 8 * k; z < std::min(8 * k + 8, size[2] - 1); ++z) {
    for (int y = 8 * j; y < std::min(8 * j + 8, size[1] - 1); ++y) {
      for (int x = 8 * i; x < std::min(8 * i + 8, size[0] - 1); ++x) {
        for (int n = 0; n < 6; ++n) {
          const auto part = [&] { return n < 3 ? 0.999999 * maker.pick(2) : maker.uniform(0, 1); };
          double v[max_channels];
          if (grid.sample<double>({x + part(), y + part(), z + part()}, v)) see(v);
        }
      }
    }
  }
}

void expect_complete(int count, bool with_table, double negligible, unsigned seed) {
  Maker maker(seed);
  long skipped = 0, cells = 0, kept = 0, left_out = 0;
  for (int round = 0; round < 6; ++round) {
    const Channels channels = some_channels(maker);
    const MultivariateTransferFunction transfer_function(
        3, some_primitives(maker, count),
        with_table ? a_table() : std::vector<ChannelTransferFunction>{});
    const MultivariateBlocksStorage storage(channels, transfer_function, negligible);
    const MultivariateBlocks blocks = storage.view();
    const MultivariateTransfer<double> transfer = transfer_function.view();
    const MultichannelGrid grid = multichannel_grid(channels);
    EXPECT_EQ(blocks.left_out, negligible);
    ASSERT_EQ(blocks.records.count(), 4 * 3 * 2);
    for (int k = 0; k < 2; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 4; ++i) {
          const int block = blocks.records.index(i, j, k);
          const bool skip = blocks.classes[block].kind == BlockKind::skip;
          const PrimitiveSet set = blocks.primitives[block];
          ++(skip ? skipped : cells);
          if (!skip) {
            for (int n = 0; n < count; ++n) ++(set.contains(n) ? kept : left_out);
          }
          look_around(grid, i, j, k, maker, [&](const double* v) {
            double missing = 0;
            for (int n = 0; n < count; ++n) {
              const Gaussian<double>& g = transfer.gaussians.primitive[n];
              if (skip || !set.contains(n)) missing += g.peak * g.density(v);
            }
            ASSERT_LE(missing, negligible * (1 + 1e-9)) << block;
            if (skip) {
              ASSERT_LE(transfer.evaluate(v).extinction, negligible * (1 + 1e-9)) << block;
            }
          });
        }
      }
    }
  }
  std::printf("[ blocks   ] %d primitives, %g: skipped %ld of %ld, kept %ld of %ld\n", count,
              negligible, skipped, skipped + cells, kept, kept + left_out);
  EXPECT_GT(cells, 0);
  if (count < 64 && !with_table) {
    EXPECT_GT(skipped, 0);
  }
  // One alone is what there is to see, where anything is.
  EXPECT_GE(left_out, count > 64 ? 1 : count > 1 ? kept / 4 : 0);
}

TEST(MultivariateBlocks, HoldEverythingThatMatters) {
  expect_complete(1, false, 1e-3, 120);
  expect_complete(4, false, 1e-2, 121);
  expect_complete(4, false, 1e-8, 122);
  expect_complete(6, true, 1e-4, 123);
  expect_complete(64, false, 1e-4, 124);
}

/// Beyond 64 a bit stands for several.
TEST(MultivariateBlocks, HoldEverythingOfMoreThan64) {
  expect_complete(65, false, 1e-3, 125);
  expect_complete(150, true, 1e-2, 126);
  expect_complete(256, false, 1e-5, 127);
}

TEST(MultivariateBlocks, ABlockThatIsVacuumInOneChannelIsSkipped) {
  const Channels channels(
      {channel<float>("a", [](int, int, int) { return 0.5; }),
       channel<float>("b", [](int i, int, int) { return i <= 16 ? nan : 0.5; })});
  GaussianPrimitive p;
  p.channels = {0};
  p.center = {0.5};
  p.matrix = {{1}};
  p.extinction = 1;
  const MultivariateTransferFunction transfer_function(2, {p});
  const MultivariateBlocksStorage storage(channels, transfer_function, 1e-3);
  const MultivariateBlocks blocks = storage.view();
  for (int i = 0; i < 4; ++i) {
    const int block = blocks.records.index(i, 1, 1);
    EXPECT_EQ(blocks.classes[block].kind, i < 2 ? BlockKind::skip : BlockKind::cells) << i;
    EXPECT_EQ(blocks.primitives[block].bits, i < 2 ? 0u : 1u) << i;
  }
}

TEST(MultivariateBlocks, WhereTheFactorIsZeroNothingMatters) {
  const Channels channels({channel<float>("a", [](int, int, int) { return 0.5; }),
                           channel<float>("b", [](int i, int, int) { return 0.1 * i; })});
  GaussianPrimitive p;
  p.channels = {0};
  p.center = {0.5};
  p.matrix = {{1}};
  p.extinction = 1;
  for (const bool of_table : {false, true}) {
    const auto kinds = [&](double largest, double extinction, double negligible) {
      p.extinction = extinction;
      std::vector<GaussianPrimitive> primitives;
      std::vector<ChannelTransferFunction> tables;
      if (of_table) {
        tables.push_back({0, TransferFunction({{0, extinction, {1, 1, 1}}})});
      } else {
        primitives.push_back(p);
      }
      // 0 up to the value at i = 17, so in the first two blocks.
      const MultivariateTransferFunction function(
          2, std::move(primitives), std::move(tables),
          ChannelTransferFunction{1, TransferFunction({{1.65, 0, {}}, {1.75, largest, {}}})});
      const MultivariateBlocksStorage storage(channels, function, negligible);
      std::vector<BlockKind> found;
      for (int i = 0; i < 4; ++i) {
        found.push_back(storage.view().classes[storage.view().records.index(i, 1, 1)].kind);
      }
      return found;
    };
    using enum BlockKind;
    EXPECT_EQ(kinds(1, 1, 1e-3), (std::vector{skip, skip, cells, cells})) << of_table;
    if (of_table) continue;
    // What is negligible is so with the factor.
    EXPECT_EQ(kinds(1, 1e-4, 1e-3), (std::vector{skip, skip, skip, skip}));
    EXPECT_EQ(kinds(100, 1e-4, 1e-3), (std::vector{skip, skip, cells, cells}));
  }
}

TEST(MultivariateBlocks, WhatIsFaintEverywhereIsSkippedEverywhere) {
  Maker maker(128);
  const Channels channels = some_channels(maker);
  std::vector<GaussianPrimitive> primitives = some_primitives(maker, 8);
  for (GaussianPrimitive& p : primitives) p.extinction = 1e-3 / 8;
  const auto skips = [&](double negligible) {
    const MultivariateTransferFunction transfer_function(3, primitives);
    const MultivariateBlocksStorage storage(channels, transfer_function, negligible);
    int count = 0;
    for (int b = 0; b < storage.view().records.count(); ++b) {
      count += storage.view().classes[b].kind == BlockKind::skip;
    }
    return count;
  };
  EXPECT_EQ(skips(1e-3), 24);
  EXPECT_LT(skips(1e-7), 24);
  primitives[0].extinction = 1e-3;
  for (double& x : primitives[0].matrix[0]) x = 0;
  primitives[0].matrix.resize(1);
  EXPECT_LT(skips(1e-3), 12) << "nowhere faint, but where all is vacuum";
}

ParallelFor four_threads() {
  return [](int count, const std::function<void(int, int)>& body) {
    std::vector<std::thread> threads;
    for (int n = 0; n < 4; ++n) threads.emplace_back(body, count * n / 4, count * (n + 1) / 4);
    for (std::thread& t : threads) t.join();
  };
}

TEST(MultivariateBlocks, ThreadsGiveTheSame) {
  for (unsigned seed = 130; seed < 134; ++seed) {
    // Twice, because volumes keep their blocks.
    Maker one(seed), other(seed);
    const Channels a = some_channels(one), b = some_channels(other);
    const MultivariateTransferFunction transfer_function(3, some_primitives(one, 40), a_table());
    const MultivariateBlocksStorage alone(a, transfer_function, 1e-4);
    const MultivariateBlocksStorage together(b, transfer_function, 1e-4, four_threads());
    for (int i = 0; i < alone.view().records.count(); ++i) {
      EXPECT_EQ(
          std::memcmp(&alone.view().classes[i], &together.view().classes[i], sizeof(BlockClass)),
          0);
      EXPECT_EQ(alone.view().primitives[i].bits, together.view().primitives[i].bits);
    }
  }
}

TEST(MultichannelGridOfAScene, IsThatOfItsVolumes) {
  Maker maker(135);
  const Channels channels = some_channels(maker);
  const MultichannelGrid grid = multichannel_grid(channels);
  EXPECT_EQ(grid.channels, 3);
  EXPECT_EQ(grid.type[0], ValueType::u8);
  EXPECT_EQ(grid.type[1], ValueType::f32);
  EXPECT_EQ(grid.type[2], ValueType::f64);
  for (int c = 0; c < 3; ++c) {
    channels[c].volume->visit([&](const auto& field) {
      EXPECT_EQ(grid.data[c], field.data);
      for (int a = 0; a < 3; ++a) {
        EXPECT_EQ(grid.axis[a].values, field.axis[a].values);
        EXPECT_EQ(grid.axis[a].padding, field.axis[a].padding);
      }
    });
  }
}

/// Rays with blocks and without agree within what both say, and do what is asked.
TEST(MultivariateBlocks, RaysThroughThemAreWithinTheTolerance) {
  Maker maker(136);
  long fewer = 0, seen = 0;
  for (int round = 0; round < 12; ++round) {
    const Channels channels = some_channels(maker);
    const int count = round == 0 ? 100 : 1 + maker.pick(8);
    const MultivariateTransferFunction transfer_function(
        3, some_primitives(maker, count),
        round % 2 == 0 ? a_table() : std::vector<ChannelTransferFunction>{});
    const double tolerance = maker.powers(1e-5, 1e-1);
    const double diagonal = std::hypot(size[0] - 1, size[1] - 1, size[2] - 1);
    const MultivariateBlocksStorage storage(channels, transfer_function, tolerance / 32 / diagonal);
    const MultivariateBlocks blocks = storage.view();
    const MultichannelGrid grid = multichannel_grid(channels);
    for (int i = 0; i < 25; ++i) {
      Vec3<double> p, d;
      for (int a = 0; a < 3; ++a) {
        p[a] = maker.uniform(0, size[static_cast<std::size_t>(a)] - 1);
        d[a] = maker.normal();
      }
      d = normalized(d);
      const Ray<double> ray{i % 3 == 0 ? p : p - d * 60.0, d};
      const auto integrated = [&](const MultivariateBlocks* these, double within) {
        return integrate_multivariate_ray(grid, these, ray, transfer_function.view(),
                                          transfer_function.largest_extinction(),
                                          {within, Grade::proved, Precision::automatic, 1}, true);
      };
      const RayResult with = integrated(&blocks, tolerance),
                      without = integrated(nullptr, 0.1 * tolerance);
      const double error = with.error + without.error + 1e-13;
      // What blocks leave out is a caller's to set aside.
      EXPECT_LE(with.error, tolerance * (1 + 1.0 / 32));
      EXPECT_LE(without.error, 0.1 * tolerance);
      EXPECT_LE(std::abs(with.opacity - without.opacity), error);
      EXPECT_LE(std::abs(with.radiance.r - without.radiance.r), error);
      EXPECT_LE(std::abs(with.radiance.g - without.radiance.g), error);
      EXPECT_LE(std::abs(with.radiance.b - without.radiance.b), error);
      fewer += with.cells < without.cells;
      seen += with.opacity > 0.1;
    }
  }
  EXPECT_GT(fewer, 100);
  EXPECT_GT(seen, 100);
}

}  // namespace
}  // namespace pellucid::test_multivariate_blocks
