// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace pellucid::scenes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct PixelError {
  double largest = 0;
  int channel = 0;
  double rounding = 0;  ///< largest distance of a channel of the truth from the next float
  double brightest = 0;
};

PixelError pixel_error(const std::array<float, 4>& pixel, const std::array<double, 4>& reference) {
  PixelError result;
  for (std::size_t c = 0; c < 4; ++c) {
    const double truth = reference[c];
    const double off = std::fabs(static_cast<double>(pixel[c]) - truth);
    const double doubt = reference_accuracy * std::max(1.0, std::fabs(truth));
    const double error = std::isfinite(off) ? std::max(0.0, off - doubt) : infinity;
    if (error > result.largest) {
      result.largest = error;
      result.channel = static_cast<int>(c);
    }
    const double rounded = static_cast<double>(static_cast<float>(truth));
    result.rounding = std::max(result.rounding, std::fabs(rounded - truth));
    result.brightest = std::max(result.brightest, truth);
  }
  return result;
}

}  // namespace

std::string Verdict::text() const {
  char line[320];
  std::snprintf(line, sizeof line,
                "largest error %.3e (column %d, row %d, %c), largest reported %.3e; %d pixels over "
                "the tolerance, %d too bright for it, %d say that they are over",
                found, worst.column, worst.row, "RGBA"[worst.channel], reported, over, too_bright,
                said_over);
  std::string text = line;
  if (over_reported > 0) {
    std::snprintf(
        line, sizeof line, "; %d over what they report, by up to %.1e (column %d, row %d, %c)",
        over_reported, beyond, beyond_at.column, beyond_at.row, "RGBA"[beyond_at.channel]);
    text += line;
  }
  return text;
}

Verdict judge(const Image& image, const ReferenceFrame& reference, double tolerance) {
  const std::size_t count = reference.pixels.size();
  if (image.width != reference.width || image.height != reference.height || count == 0 ||
      image.pixels.size() != count) {
    throw std::invalid_argument("an image and its reference must have one size and some pixels");
  }
  if (image.error.size() != count || image.proved.size() != count) {
    throw std::invalid_argument("the image does not report an error for every pixel");
  }
  Verdict verdict;
  verdict.min_share = infinity;
  for (std::size_t p = 0; p < count; ++p) {
    const PixelError error = pixel_error(image.pixels[p], reference.pixels[p]);
    const Verdict::Place place{static_cast<int>(p) % image.width, static_cast<int>(p) / image.width,
                               error.channel};
    const double reported =
        std::isnan(image.error[p]) ? -infinity : static_cast<double>(image.error[p]);
    const bool said_over = !(reported >= 0 && reported <= tolerance);
    if (said_over) ++verdict.said_over;
    if (image.proved[p] != 0) ++verdict.proved;
    verdict.reported = std::max(verdict.reported, reported < 0 ? infinity : reported);
    if (std::isnan(reference.pixels[p][3])) {
      if (!said_over) ++verdict.over;
      continue;
    }
    if (error.largest > tolerance) {
      ++(said_over && error.rounding > 0.5 * tolerance ? verdict.too_bright : verdict.over);
    }
    if (error.largest > reported) {
      ++verdict.over_reported;
      if (error.largest - reported > verdict.beyond) {
        verdict.beyond = error.largest - reported;
        verdict.beyond_at = place;
      }
    }
    if (error.largest > 0) {
      verdict.min_share = std::min(verdict.min_share, reported / error.largest);
    }
    if (error.largest > verdict.found) {
      verdict.found = error.largest;
      verdict.worst = place;
    }
    verdict.brightest = std::max(verdict.brightest, error.brightest);
  }
  return verdict;
}

}  // namespace pellucid::scenes
