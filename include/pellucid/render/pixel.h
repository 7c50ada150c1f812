// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/render/ray_result.h"
#include "pellucid/simd/scalar.h"
#include "pellucid/traverse/block_code.h"

namespace pellucid {

/// The mean of a pixel's rays. Its depth is that of the nearest whose opacity is more than its
/// error.
class PixelMean {
 public:
  PELLUCID_HD void add(const RayResult& ray) noexcept {
    if (count_++ == 0) {
      mean_ = ray;
      if (!reaches_half(ray)) mean_.half_opacity_depth = infinity;
      first_depth_ = ray.half_opacity_depth;
      return;
    }
    mean_.radiance = mean_.radiance + ray.radiance;
    mean_.opacity += ray.opacity;
    mean_.optical_depth += ray.optical_depth;
    if (reaches_half(ray)) {
      mean_.half_opacity_depth = min(mean_.half_opacity_depth, ray.half_opacity_depth);
    }
    mean_.cells += ray.cells;
    mean_.neighbor_deviation = max(mean_.neighbor_deviation, ray.neighbor_deviation);
    mean_.longest_step = min(mean_.longest_step, ray.longest_step);
    mean_.error += ray.error;
    mean_.proved = mean_.proved && ray.proved;
    mean_.evaluations += ray.evaluations;
    mean_.spans += ray.spans;
  }
  /// Returns the mean of the rays so far, of which there is one at least.
  PELLUCID_HD RayResult mean() const noexcept {
    RayResult mean = mean_;
    if (count_ == 1) {
      mean.half_opacity_depth = first_depth_;
      return mean;
    }
    const double share = 1.0 / count_;
    mean.radiance = mean.radiance * share;
    mean.opacity *= share;
    mean.optical_depth *= share;
    mean.error *= share;
    return mean;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  PELLUCID_HD static bool reaches_half(const RayResult& ray) noexcept {
    return ray.opacity > ray.error || !(ray.error < infinity);
  }

  RayResult mean_;
  double first_depth_ = infinity;
  int count_ = 0;
};

/// Limits that all pixels of a frame share when they are stored.
struct PixelLimits {
  double reserved = 0;       ///< of the tolerance: what the transfer function is off by
  double largest_color = 1;  ///< that a pixel can have
  double tolerance = 0;      ///< of the scene
};

/// A pixel as images hold it.
struct StoredPixel {
  float color[4] = {};  ///< premultiplied linear RGBA
  float depth = 0;      ///< depth of half of the opacity
  double error = 0;     ///< error of any channel, with the rounding to binary32
  bool proved = false;

  /// Returns the error as images hold it: not below what it is.
  PELLUCID_HD float stored_error() const noexcept { return float_above(error); }
};

/// Rounds a result to what images hold.
PELLUCID_HD inline StoredPixel stored_pixel(const RayResult& result,
                                            const PixelLimits& limits) noexcept {
  const double exact[4] = {result.radiance.r, result.radiance.g, result.radiance.b, result.opacity};
  StoredPixel pixel;
  double brightest = 0;
  for (int c = 0; c < 4; ++c) {
    pixel.color[c] = static_cast<float>(exact[c]);
    brightest = max(brightest, exact[c]);
  }
  pixel.depth = static_cast<float>(result.half_opacity_depth);
  // A clear pixel is clear whatever the transfer function is off by where it is not zero.
  const double approximation = result.opacity > 0 ? limits.reserved : 0;
  // Both the pixel and the exact one lie between zero and the largest color.
  const double most = max(limits.largest_color, 1.0);
  pixel.error = min(result.error + approximation, most) + brightest * 0x1p-24;
  pixel.proved = result.proved;
  return pixel;
}

}  // namespace pellucid
