// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "pellucid/cpu/render.h"

namespace pellucid::cli {

/// Returns the largest channel of premultiplied RGBA of any pixel: the picture's own range is from
/// 0 to it.
double largest_channel(const Image& image);

/// Returns about the largest channel that the scene's picture will have, from renderings of at most
/// 96 x 96 pixels at tolerances that decrease until the range shows. May miss what is narrower
/// than their pixels. Throws what render() throws.
double estimate_range(const Scene& scene, const Machine& machine, const FrameMonitor& monitor);

/// A picture whose tolerance is a share of its own range.
struct RelativePicture {
  Image image;
  RenderReport report;   ///< `seconds` is the time of all renderings
  double tolerance = 0;  ///< the one wanted for `image`
  double largest = 0;    ///< largest_channel(image)
  /// Why the picture may be off by more than the share of `largest`; nothing: it is not.
  std::optional<std::string> over;
};

/// Renders at the tolerance share · range: first with the estimated range, and again as long as the
/// picture's own range turns out to be smaller. `render_at` renders the whole picture at a
/// tolerance, or at the nearest one within the limits.
RelativePicture render_relative(double share, double estimated_range,
                                const std::function<RenderResult(double tolerance)>& render_at);

/// Returns "1 %".
std::string percent_text(double share);

/// Returns the note on a picture that looks black: nothing in it is above the tolerance, or with
/// `png` its largest channel is 0 in 8 bits. `error` is the largest of any pixel.
std::optional<std::string> black_picture_text(double largest, double tolerance, double error,
                                              bool png);

}  // namespace pellucid::cli
