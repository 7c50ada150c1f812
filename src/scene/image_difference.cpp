// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/image_difference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// Returns |a - b|; NaN where the two are not the same and one is not finite.
double absolute_difference(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double difference = std::abs(static_cast<double>(a) - static_cast<double>(b));
  return std::isfinite(difference) ? difference : std::numeric_limits<double>::quiet_NaN();
}

/// Reorders the differences.
DifferenceStatistics statistics_of(std::vector<double>& differences) {
  DifferenceStatistics s;
  s.values = differences.size();
  const auto end = std::remove_if(differences.begin(), differences.end(),
                                  [](double d) { return std::isnan(d); });
  s.not_finite = static_cast<std::size_t>(differences.end() - end);
  differences.erase(end, differences.end());
  if (!differences.empty()) {
    double sum = 0;
    for (const double d : differences) {
      s.largest = std::max(s.largest, d);
      sum += d * d;
    }
    s.root_mean_square = std::sqrt(sum / static_cast<double>(differences.size()));
    // Nearest rank: N − ⌊N/1000⌋, counted from 1; in integers, so that no rounding decides.
    const std::size_t rank = differences.size() - differences.size() / 1000;
    const auto nth = differences.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(differences.begin(), nth, differences.end());
    s.percentile_999 = *nth;
  }
  s.psnr = s.root_mean_square > 0 ? -20 * std::log10(s.root_mean_square)
                                  : std::numeric_limits<double>::infinity();
  return s;
}

std::string size_text(const Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

void check_sizes(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw Error("the images differ in size, " + size_text(a) + " and " + size_text(b) +
                "; compare pictures of one size");
  }
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b) {
  check_sizes(a, b);
  ImageDifference result;
  std::vector<double> all, channel;
  all.reserve(4 * a.pixels.size());
  for (std::size_t c = 0; c < 4; ++c) {
    channel.clear();
    for (std::size_t p = 0; p < a.pixels.size(); ++p) {
      channel.push_back(absolute_difference(a.pixels[p][c], b.pixels[p][c]));
    }
    all.insert(all.end(), channel.begin(), channel.end());
    result.channel[c] = statistics_of(channel);
  }
  // A difference that is not finite is the largest of all.
  std::size_t largest_pixel = 0;
  double largest = -1;
  for (std::size_t p = 0; p < a.pixels.size(); ++p) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double d = all[c * a.pixels.size() + p];
      const double rank = std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
      if (rank > largest) {
        largest = rank;
        largest_pixel = p;
      }
    }
  }
  if (a.width > 0) {
    const auto width = static_cast<std::size_t>(a.width);
    result.column = static_cast<int>(largest_pixel % width);
    result.row = static_cast<int>(largest_pixel / width);
  }
  result.all = statistics_of(all);
  return result;
}

std::optional<ErrorCheck> check_errors(const Image& a, const Image& b) {
  check_sizes(a, b);
  if (a.error.empty()) return std::nullopt;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ErrorCheck check;
  check.pixels = a.pixels.size();
  std::vector<double> tightness;
  double worst = -infinity;
  for (std::size_t p = 0; p < a.pixels.size(); ++p) {
    double largest = 0;
    double error = static_cast<double>(a.error[p]);
    if (!b.error.empty()) error += static_cast<double>(b.error[p]);
    double excess = -infinity;
    for (std::size_t c = 0; c < 4; ++c) {
      const double difference = absolute_difference(a.pixels[p][c], b.pixels[p][c]);
      if (std::isnan(difference)) {
        largest = excess = infinity;
        break;
      }
      const double rounding =
          b.error.empty() ? std::abs(static_cast<double>(b.pixels[p][c])) * 0x1p-24 : 0;
      largest = std::max(largest, difference);
      excess = std::max(excess, difference - rounding - error);
    }
    check.proved += a.proved[p] != 0 && (b.proved.empty() || b.proved[p] != 0) ? 1U : 0U;
    if (!std::isfinite(error)) {
      ++check.unknown;
      continue;
    }
    if (!(excess <= 0)) ++check.over;
    if (largest > 0) tightness.push_back(error / largest);
    if (!(excess <= worst)) {
      worst = excess;
      const auto width = static_cast<std::size_t>(a.width);
      check.column = static_cast<int>(p % width);
      check.row = static_cast<int>(p / width);
      check.difference = largest;
      check.error = error;
    }
  }
  check.tightness_median = check.tightness_smallest = infinity;
  if (!tightness.empty()) {
    const auto middle = tightness.begin() + static_cast<std::ptrdiff_t>(tightness.size() / 2);
    std::nth_element(tightness.begin(), middle, tightness.end());
    check.tightness_median = *middle;
    check.tightness_smallest = *std::min_element(tightness.begin(), middle + 1);
  }
  return check;
}

std::size_t pixels_over(const Image& a, const Image& b, double tolerance) {
  check_sizes(a, b);
  std::size_t over = 0;
  for (std::size_t p = 0; p < a.pixels.size(); ++p) {
    bool within = true;
    for (std::size_t c = 0; c < 4; ++c) {
      within = within && absolute_difference(a.pixels[p][c], b.pixels[p][c]) <= tolerance;
    }
    over += within ? 0 : 1;
  }
  return over;
}

Image difference_image(const Image& a, const Image& b) {
  check_sizes(a, b);
  Image image;
  image.width = a.width;
  image.height = a.height;
  image.pixels.resize(a.pixels.size());
  for (std::size_t p = 0; p < a.pixels.size(); ++p) {
    for (std::size_t c = 0; c < 4; ++c) {
      image.pixels[p][c] = static_cast<float>(absolute_difference(a.pixels[p][c], b.pixels[p][c]));
    }
  }
  return image;
}

Image difference_picture(const Image& a, const Image& b, double scale) {
  Image picture = difference_image(a, b);
  for (auto& pixel : picture.pixels) {
    double largest = 0;
    for (const float d : pixel) {
      const double scaled = static_cast<double>(d) * scale;
      largest = std::max(largest, std::isnan(scaled) ? 1.0 : std::min(scaled, 1.0));
    }
    const float grey = static_cast<float>(largest);
    pixel = {grey, grey, grey, 1};
  }
  return picture;
}

}  // namespace pellucid
