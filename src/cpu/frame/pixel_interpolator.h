// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "cubic_errors.h"
#include "frame.h"
#include "pellucid/render/ray_result.h"
#include "pixel.h"
#include "screen_mask.h"

namespace pellucid {

/// Pixels that are interpolated between others instead of traced (Levoy 1990, adaptive refinement),
/// where what they may be off by is known well enough: of a frame whose rays go through smooth
/// blocks, with other rays so near that no wave of the data fits in between.
///
/// Pixels come in levels: every stride()-th along each axis, all of them traced; then those in the
/// middle between them; and so on. One in the middle is taken from the cubic through the four
/// pixels of the level before along the axis, or from that of both axes. It is off by
///
///   what these four may be off by, in the mean weighted as by the cubic, but not less than what
///     any one of them makes of it: errors that are alike, or waves from pixel to pixel, or random,
///     are no larger between pixels;
///   what the cubic errs, for which stand fourth differences of the pixels nearby, so many times
///     that it holds for a kink between any two of them;
///   what trilinear data do from cell to cell and rays beside each other do not have in common
///     (RayResult::neighbor_deviation), four standard deviations of it.
///
/// An estimate, not a bound. What a pixel becomes depends on nothing but the pixels of the levels
/// before.
class PixelInterpolator {
 public:
  /// Makes the interpolator of a frame; null where all pixels are to be traced.
  static std::unique_ptr<PixelInterpolator> make(const Frame& frame, const ImageView& image);

  int stride() const noexcept { return stride_; }
  /// Finds out on a few pixels whether the next level is worth it. To be called when the pixels of
  /// a level are done, not the last. Where it is not, all that is left is to be traced.
  void finish_level(int stride, int threads);
  bool goes_on() const noexcept { return goes_on_; }
  /// Returns the fraction of the tolerance that rays of this level may use, so that some remains
  /// for the pixels between them.
  double traced_tolerance_fraction(int stride) const noexcept;

  /// Returns whether the pixel is one of the levels that are finished.
  bool is_done(int column, int row) const noexcept {
    return finished_ > 0 && column % finished_ == 0 && row % finished_ == 0;
  }

  /// Notes what became of a pixel of a level other than the last.
  void keep(int column, int row, const RayResult& result) noexcept;
  /// Makes what is between the pixels of the levels that are finished of a new result, where it
  /// goes on; false: to be traced.
  bool find(int column, int row, int stride, RayResult& result) const noexcept;

 private:
  PixelInterpolator(const Frame& frame, const ImageView& image, int stride, double voxels,
                    ScreenMask mask);

  /// Facts of each second pixel of each second row.
  struct Known {
    float error, neighbor_deviation;
    float waves;  ///< 1 / the longest step
  };
  /// Error of a pixel.
  struct Cost {
    bool known = false;
    double inherited = 0, cubic = 0, uneven = 0;
  };
  /// Makes the pixel of a new result, but for its error; not where the cubic alone errs by more
  /// than `most`.
  Cost look(int column, int row, int stride, double most, RayResult& result) const noexcept;

  std::size_t index(int column, int row) const noexcept {
    return static_cast<std::size_t>(row / 2) * columns_ + static_cast<std::size_t>(column / 2);
  }

  const Frame& frame_;
  ImageView image_;
  int stride_;
  int finished_ = 0;  ///< the last level that is; 0: none
  bool goes_on_ = true;
  double voxels_;    ///< from pixel to pixel, at most
  double rounding_;  ///< of the cubic
  ScreenMask mask_;  ///< whose squares are as wide as pixels of the level before are apart
  std::size_t columns_;
  std::vector<Known> known_;
  std::optional<CubicErrors> cubic_errors_;  ///< of the level that is finished
};

}  // namespace pellucid
