// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "pellucid/scene/derived_channels.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/real.h"

namespace pellucid::scenes {
namespace {

using Primitives = std::vector<GaussianPrimitive>;
using Tables = std::vector<ChannelTransferFunction>;

Exhibit exhibit(std::vector<VolumePointer> volumes, Primitives primitives, Tables tables = {}) {
  Exhibit result;
  result.cameras = three_cameras(*volumes.front());
  std::vector<Channel> channels;
  for (VolumePointer& volume : volumes) {
    channels.push_back({"channel " + std::to_string(channels.size()), "", std::move(volume)});
  }
  const int count = static_cast<int>(channels.size());
  result.channels = std::make_shared<const Channels>(std::move(channels));
  result.multivariate = std::make_shared<const MultivariateTransferFunction>(
      count, std::move(primitives), std::move(tables));
  return result;
}

/// Over some of the channels, with a K of its own.
GaussianPrimitive over(std::vector<ChannelRef> channels, std::vector<double> center,
                       std::vector<std::vector<double>> matrix, double extinction,
                       Rgb<double> color) {
  return {std::move(channels), std::move(center), std::move(matrix), extinction, color};
}

/// Over the first channels, with 1/e widths along their axes.
GaussianPrimitive gaussian(std::vector<double> center, const std::vector<double>& widths,
                           double extinction, Rgb<double> color) {
  std::vector<ChannelRef> channels;
  for (std::size_t i = 0; i < center.size(); ++i) channels.push_back(static_cast<int>(i));
  return over(std::move(channels), std::move(center), matrix_from_widths(widths), extinction,
              color);
}

/// A smooth field in [0, 1], another one for each number.
VolumePointer waves(std::array<int, 3> dimensions, int number) {
  const double n = number;
  return sampled(
      dimensions,
      [=](double x, double y, double z) {
        return 0.5 +
               0.28 * std::sin((2 + 0.3 * n) * x + 1.7 * y + n) * std::cos(2.1 * z - 0.4 * n) +
               0.2 * std::sin(1.3 * y - (1 + 0.2 * n) * z + 2 * n);
      },
      "waves");
}

VolumePointer noise(std::array<int, 3> dimensions, unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double, double, double) {
    return static_cast<double>(random()) / 4294967296.0;
  };
  return sampled(dimensions, draw, "noise");
}

/// Bright and dark, of many hues.
Rgb<double> hue(int i) {
  return {0.5 + 0.5 * std::cos(2.1 * i), 0.5 + 0.5 * std::cos(1.3 * i + 2), (i % 4) / 3.0};
}

/// Widths of 1/2 … 1/10 of the range: all of it is seen through all of them.
Exhibit wide(int) {
  return exhibit({builtin("marschner_lobb", 21)}, {gaussian({0.2}, {0.5}, 0.4, {0.1, 0.3, 1}),
                                                   gaussian({0.5}, {0.2}, 0.8, {0.2, 1, 0.3}),
                                                   gaussian({0.6}, {0.1}, 1.5, {1, 0.6, 0.1})});
}

/// Sheets of 1/500 of the range and less within a haze.
Exhibit narrow(int) {
  return exhibit(
      {builtin("marschner_lobb", 21)},
      {gaussian({0.4}, {0.3}, 0.2, {0.1, 0.3, 1}), gaussian({0.5}, {0.002}, 60, {1, 0.6, 0.1}),
       gaussian({0.505}, {0.002}, 60, {0.1, 1, 0.6}), gaussian({0.6}, {2e-4}, 900, {1, 0, 1})});
}

/// Boundaries as in Kniss's widgets: a value in the middle of two materials, and a large gradient.
Exhibit boundaries(const VolumePointer& value, const std::vector<double>& values, double width,
                   double slope, double extinction) {
  Primitives primitives;
  for (const double center : values) {
    const int i = static_cast<int>(primitives.size());
    primitives.push_back(
        gaussian({center, slope}, {width, 0.4 * slope}, extinction / (1 + 0.5 * i), hue(i + 1)));
  }
  return exhibit({value, std::make_shared<const Volume>(gradient_magnitude(*value))},
                 std::move(primitives));
}

VolumePointer read_scan(const std::string& name) {
  for (const RealData& data : real_data()) {
    if (data.name == name) return read(data);
  }
  return nullptr;
}

std::filesystem::path scan_file(const std::string& name) {
  for (const RealData& data : real_data()) {
    if (data.name == name) return data.file;
  }
  return {};
}

Exhibit value_and_gradient_of_brain(int) {
  return boundaries(read_scan("brain"), {35, 80, 125}, 12, 20, 0.6);
}

Exhibit value_and_gradient_of_engine(int) {
  return boundaries(read_scan("engine"), {65, 180}, 8, 60, 0.8);
}

Exhibit value_and_gradient_of_waves(int) {
  return boundaries(waves({15, 15, 15}, 0), {0.3, 0.5, 0.65}, 0.02, 0.9, 9);
}

/// x, y and z as three channels of a sheared grid: blobs, one of them turned, and a sheet that
/// looks at one direction of the three.
Exhibit turned_and_rank_deficient(int) {
  Volume::Description d = grid_description({9, 9, 9}, {1, 2, 3}, {0.5, 1, 0.7});
  d.placement.direction = {{{-1, 0, 0}, {0.8, 1, 0}, {0.3, 0.5, 1}}};
  const auto axis = [&](int a) {
    return make_volume<double>(d, [=](int i, int j, int k) {
      return (a == 0 ? i : a == 1 ? j : k) / 8.0 + 0.02 * ((i * j + k) % 3);
    });
  };
  const std::vector<std::vector<double>> axes{
      {0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
  return exhibit(
      {axis(0), axis(1), axis(2)},
      {over({2, 0, 1}, {0.5, 0.4, 0.6}, matrix_from_widths({0.3, 0.02, 0.1}, axes), 4, {1, 0.5, 0}),
       over({0, 1, 2}, {0.3, 0.5, 0.4}, {{40, -30, 20}}, 3, {0, 0.5, 1}),
       over({0, 2}, {0.7, 0.6}, {{12, 9}, {4, 3}, {-8, -6}}, 1, {0.4, 1, 0.4}),
       over({1}, {0.2}, {{500}}, 20, {1, 1, 1})});
}

/// Differences of channels that are nearly alike, seen through a K that sees little else.
Exhibit differences_of_channels(int) {
  const auto field = [](double share) {
    return sampled(
        {13, 13, 13},
        [=](double x, double y, double z) {
          return 100 + 3 * x + share * 1e-2 * std::sin(3 * x + 2 * y) * std::cos(2 * z);
        },
        "nearly alike");
  };
  return exhibit({field(0), field(1)},
                 {over({0, 1}, {100, 100}, {{300, -300}}, 1.5, {1, 0.4, 0.1}),
                  over({0, 1}, {100.005, 100}, {{2000, -2000}, {0.5, 0.5}}, 6, {0.2, 0.6, 1})});
}

/// Each primitive over some of eight channels, of several types.
Exhibit eight_channels(int) {
  std::vector<VolumePointer> volumes;
  for (int c = 0; c < 8; ++c) {
    const VolumePointer smooth = waves({7, 7, 7}, c);
    const auto at = [&](int i, int j, int k) {
      return static_cast<double>(std::get<DataArray<float>>(
          smooth->data())[static_cast<std::size_t>(i + 7 * (j + 7 * k))]);
    };
    const Volume::Description d = smooth->description();
    if (c % 3 == 0) {
      volumes.push_back(smooth);
    } else if (c % 3 == 1) {
      volumes.push_back(
          make_volume<std::uint8_t>(d, [&](int i, int j, int k) { return 255 * at(i, j, k); }));
    } else {
      volumes.push_back(make_volume<std::int16_t>(
          d, [&](int i, int j, int k) { return 4000 * at(i, j, k) - 1000; }));
    }
  }
  const auto center = [](int c) { return c % 3 == 0 ? 0.5 : c % 3 == 1 ? 127.0 : 1000.0; };
  const auto width = [](int c, double w) {
    return c % 3 == 0 ? w : c % 3 == 1 ? 255 * w : 4000 * w;
  };
  Primitives primitives;
  for (int i = 0; i < 8; ++i) {
    GaussianPrimitive g;
    std::vector<double> widths;
    for (int c = 0; c < 8; ++c) {
      if ((c * (i + 3) + i) % 4 == 3) continue;
      g.channels.push_back(c);
      g.center.push_back(center(c) + width(c, 0.03 * (i - 3)));
      widths.push_back(width(c, c == i ? 0.05 : 0.4));
    }
    g.matrix = matrix_from_widths(widths);
    g.extinction = 4;
    g.color = hue(i);
    primitives.push_back(std::move(g));
  }
  return exhibit(std::move(volumes), std::move(primitives));
}

/// A grid of n × n primitives over two channels, `width` of the distance between them wide.
Exhibit many(int n, double width, double extinction) {
  Primitives primitives;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      primitives.push_back(gaussian({(i + 0.5) / n, (j + 0.5) / n}, {width / n, width / n},
                                    extinction, hue(n * i + j)));
    }
  }
  return exhibit({waves({7, 7, 7}, 1), waves({7, 7, 7}, 4)}, std::move(primitives));
}

Exhibit hundred_apart(int) {
  return many(10, 0.2, 5);
}

Exhibit sixty_four_overlapping(int) {
  return many(8, 1.5, 0.08);
}

Exhibit twenty_in_noise(int) {
  Primitives primitives;
  for (int i = 0; i < 20; ++i) {
    primitives.push_back(gaussian({(i + 0.5) / 20, (7 * i % 20) / 20.0},
                                  {i % 2 == 0 ? 0.03 : 0.3, i % 2 == 0 ? 0.2 : 0.02}, 6, hue(i)));
  }
  return exhibit({noise({5, 5, 5}, 3), noise({5, 5, 5}, 5)}, std::move(primitives));
}

/// Gaussians beside and under the ramps, peaks and jumps of tables.
Exhibit with_tables(int) {
  const TransferFunction ramps({{0.3, 0, {0.1, 0.2, 0.8}},
                                {0.5, 1, {0.2, 0.6, 0.9}},
                                {0.5, 0.2, {1, 0.2, 0.9}},
                                {0.7, 3, {1, 0.9, 0.9}}});
  const TransferFunction peak({{0.55, 0, {0, 1, 0}}, {0.56, 20, {0, 1, 1}}, {0.57, 0, {0, 1, 0}}});
  return exhibit({waves({13, 13, 13}, 2), waves({13, 13, 13}, 3)},
                 {gaussian({0.5, 0.5}, {0.01, 0.2}, 10, {1, 0.5, 0}),
                  gaussian({0.4, 0.6}, {0.2, 0.02}, 3, {0.5, 0, 1})},
                 {{0, ramps}, {1, peak}});
}

/// Peaks of a thousand to a million depths, colors on colors, and a veil in front.
Exhibit opaque(int) {
  return exhibit({builtin("marschner_lobb", 17), waves({17, 17, 17}, 5)},
                 {gaussian({0.5, 0.5}, {0.05, 0.3}, 1e6, {1, 0.3, 0.1}),
                  gaussian({0.52, 0.5}, {0.05, 0.4}, 1e6, {0.1, 0.3, 1}),
                  gaussian({0.7, 0.6}, {0.02, 0.1}, 1e3, {0.2, 1, 0.2}),
                  gaussian({0.3, 0.4}, {0.2, 0.5}, 0.3, {1, 1, 1})});
}

/// A primitive in the middle of which all of a plateau lies, and thin mist around it.
Exhibit plateau_and_mist(int) {
  const VolumePointer plateau = sampled(
      {11, 11, 11},
      [](double x, double y, double z) {
        return std::clamp(3 * (0.7 - std::sqrt(x * x + y * y + z * z)), 0.0, 0.75);
      },
      "plateau");
  return exhibit(
      {plateau, waves({11, 11, 11}, 6)},
      {gaussian({0.75}, {1e-3}, 0.5, {1, 0.8, 0.2}), gaussian({0}, {1e-3}, 0.01, {0.3, 0.3, 1}),
       gaussian({0.75, 0.5}, {0.1, 0.004}, 30, {0.1, 1, 0.4})});
}

/// Vacuum in one channel, where the other has data, on cells of a rectilinear axis.
Exhibit vacuum_and_cells(int) {
  Volume::Description d = grid_description({9, 8, 7}, {-1, -1, -1}, {1, 0.3, 0.3});
  d.centering = Centering::cell;
  for (int i = 0; i <= 9; ++i) d.coordinates[0].push_back(0.02 * i * i + 0.05 * i);
  const auto value = [](int i, int j, int k) {
    return 0.5 + 0.4 * std::sin(0.7 * i + 0.3 * j) * std::cos(0.6 * k);
  };
  const auto holes = [](int i, int j, int k) {
    return (i + 2 * j + 3 * k) % 17 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                         : 0.5 + 0.3 * std::cos(0.5 * i - 0.4 * j + 0.3 * k);
  };
  return exhibit(
      {make_volume<float>(d, value), make_volume<double>(d, holes)},
      {gaussian({0.6}, {0.05}, 4, {1, 0.4, 0.2}), over({1}, {0.6}, {{100}}, 20, {0.2, 0.6, 1}),
       over({0, 1}, {0.4, 0.6}, {{8, 8}}, 1, {0.4, 1, 0.4})});
}

}  // namespace

Gallery gaussian_gallery() {
  return {
      {"Gaussians of a half to a tenth of the range", wide},
      {"Gaussians of 1/500 and 1/5000 of the range", narrow},
      {"value and gradient of the brain", value_and_gradient_of_brain, scan_file("brain")},
      {"value and gradient of the engine", value_and_gradient_of_engine, scan_file("engine")},
      {"value and gradient of waves", value_and_gradient_of_waves},
      {"turned and rank-deficient Gaussians, sheared grid", turned_and_rank_deficient},
      {"differences of channels", differences_of_channels},
      {"eight channels", eight_channels},
      {"a hundred Gaussians apart", hundred_apart},
      {"64 Gaussians, overlapping", sixty_four_overlapping},
      {"twenty Gaussians in noise", twenty_in_noise},
      {"Gaussians and tables", with_tables},
      {"Gaussians of a million depths", opaque},
      {"a plateau in the middle of a Gaussian", plateau_and_mist},
      {"Gaussians, vacuum in one channel", vacuum_and_cells},
  };
}

}  // namespace pellucid::scenes
