// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/defaults.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace pellucid {
namespace {

using Point = TransferFunction::Point;

/// Up to 2^18 finite values, ascending: a quarter of a million puts a quantile within 0.1 %, and
/// sorts in milliseconds. Taken at the fractional parts of n/golden ratio, which are even at every
/// scale: a fixed stride would see single columns of the grid.
std::vector<double> sorted_sample(const Volume& volume) {
  constexpr std::size_t largest = std::size_t{1} << 18;
  std::vector<double> sample;
  std::visit(
      [&](const auto& data) {
        const auto take = [&](std::size_t index) {
          const auto value = static_cast<double>(data[index]);
          if (std::isfinite(value)) sample.push_back(value);
        };
        if (data.size() <= largest) {
          for (std::size_t i = 0; i < data.size(); ++i) take(i);
          return;
        }
        const auto size = static_cast<double>(data.size());
        for (std::size_t n = 0; n < largest; ++n) {
          const double s = static_cast<double>(n) / std::numbers::phi;
          take(std::min(static_cast<std::size_t>((s - std::floor(s)) * size), data.size() - 1));
        }
      },
      volume.data());
  std::sort(sample.begin(), sample.end());
  return sample;
}

/// Otsu 1979 on the sorted values [first, last) themselves, without bins: the index at which the
/// second of two classes begins, so that the variance between their means is largest. A class
/// begins at a new value; last where all values are equal.
std::size_t otsu_split(const std::vector<double>& v, std::size_t first, std::size_t last) {
  double total = 0;
  for (std::size_t i = first; i < last; ++i) total += v[i] - v[first];
  double below = 0, best = 0;
  std::size_t split = last;
  for (std::size_t i = first + 1; i < last; ++i) {
    below += v[i - 1] - v[first];
    if (v[i] == v[i - 1]) continue;
    const auto n = static_cast<double>(i - first), m = static_cast<double>(last - i);
    const double difference = (total - below) / m - below / n;
    const double between = n * m * difference * difference;
    if (between > best) {
      best = between;
      split = i;
    }
  }
  return split;
}

double mean(const std::vector<double>& v, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) sum += v[i] - v[first];
  return v[first] + sum / static_cast<double>(last - first);
}

/// The decimal with this many digits behind the point of scientific notation that is nearest.
double rounded(double value, int digits) {
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits).ptr;
  std::from_chars(text, end, value);
  return value;
}

/// The nearest multiple of a power of ten that divides the range into 100 to 1000 parts.
double readable(double value, double range) {
  if (value == 0) return 0;
  const double digits = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(range)) + 2;
  return digits < 0 ? 0 : rounded(value, static_cast<int>(std::min(digits, 16.0)));
}

double two_digits(double value) {
  return rounded(value, 1);
}

/// Mean length of the chords of the volume's box: 4 · volume / surface (Cauchy).
double mean_chord(const Volume& volume) {
  const Vec3<double> size = volume.grid_upper() - volume.grid_lower();
  const Mat3<double>& axes = volume.world_from_grid().matrix;
  const Vec3<double> a = axes.column[0] * size.x, b = axes.column[1] * size.y,
                     c = axes.column[2] * size.z;
  const double surface = 2 * (length(cross(a, b)) + length(cross(b, c)) + length(cross(c, a)));
  return 4 * std::abs(dot(a, cross(b, c))) / surface;
}

}  // namespace

TransferFunction default_transfer_function(const Volume& volume) {
  const double chord = mean_chord(volume);
  const std::vector<double> v = sorted_sample(volume);
  if (v.empty() || v.front() == v.back()) {
    // Nothing to tell apart: a haze in which the box itself is seen.
    return TransferFunction({{v.empty() ? 0 : v.front(), two_digits(1 / chord), {0.8, 0.5, 0.25}}});
  }
  const std::size_t n = v.size();
  const std::size_t foreground = otsu_split(v, 0, n);
  const std::size_t bright = otsu_split(v, foreground, n);
  const auto share = [&](std::size_t first) {
    return static_cast<double>(n - first) / static_cast<double>(n);
  };
  const auto extinction = [&](double depth, std::size_t first) {
    return two_digits(depth / (std::cbrt(share(first)) * chord));
  };
  const double top = v[n - 1 - n / 1000];
  const double range = std::max(top - v[n / 1000], 1e-30);
  std::vector<Point> points;
  const auto add = [&](double value, double e, Rgb<double> color) {
    const double rounded = readable(value, range);
    if (!points.empty() && rounded <= points.back().value) return;
    points.push_back({rounded, e, color});
  };
  const double background_mean = mean(v, 0, foreground);
  const double threshold = (v[foreground - 1] + v[foreground]) / 2;
  add((background_mean + threshold) / 2, 0, {0.25, 0.04, 0.01});
  add(threshold, extinction(0.8, foreground), {0.35, 0.08, 0.02});
  if (bright < n) {
    add(mean(v, foreground, bright), extinction(1.6, foreground), {0.85, 0.36, 0.12});
    add(v[bright], extinction(4, bright), {1.0, 0.7, 0.35});
    add(top, extinction(10, bright), {1.0, 0.96, 0.88});
  } else {
    add(v[foreground], extinction(6, foreground), {1.0, 0.7, 0.35});
  }
  return TransferFunction(std::move(points));
}

Camera default_camera(const Volume& volume, ImageSize size) {
  constexpr double degree = std::numbers::pi / 180;
  constexpr double azimuth = 30 * degree, elevation = 20 * degree, margin = 1.05;
  const Vec3<double> backward{std::sin(azimuth) * std::cos(elevation),
                              -std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
  const Vec3<double> right{std::cos(azimuth), std::sin(azimuth), 0};
  const Vec3<double> up = cross(backward, right);

  Camera camera;
  camera.vertical_angle = 30;
  camera.up = {0, 0, 1};
  const double half_height = std::tan(camera.vertical_angle / 2 * degree) / margin;
  const double half_width = half_height * size.width / size.height;

  const std::array<Vec3<double>, 8> corners = volume.world_corners();
  Vec3<double> center{};
  for (const Vec3<double>& corner : corners) center = center + corner * 0.125;
  // A corner is in the picture from where |x| <= half_width · depth and |y| <= half_height · depth.
  double distance = 0;
  for (const Vec3<double>& corner : corners) {
    const Vec3<double> offset = corner - center;
    const double x = std::abs(dot(offset, right)), y = std::abs(dot(offset, up));
    distance =
        std::max(distance, std::max(x / half_width, y / half_height) + dot(offset, backward));
  }
  camera.focal_point = center;
  camera.position = center + backward * distance;
  return camera;
}

}  // namespace pellucid
