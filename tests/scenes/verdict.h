// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/scene/image.h"
#include "tests/scenes/reference_frame.h"

namespace pellucid::scenes {

/// How an image stands to a tolerance and to the errors that it reports. A pixel's error is the
/// largest difference of its four floats, as they are in the image, from the reference's doubles:
/// the rounding of the image counts. The reference's own accuracy is taken off; a value that is not
/// finite is infinitely far. Where the reference is NaN nothing is right, and the image must say
/// so.
struct Verdict {
  struct Place {
    int column = 0, row = 0, channel = 0;
  };

  double found = 0;  ///< largest error of any pixel
  Place worst;       ///< where it is
  /// Pixels whose error is above the tolerance, but for those of the next number.
  int over = 0;
  /// Pixels above the tolerance that say so, and whose float next to the truth is as far from it as
  /// half of the tolerance: no image of binary32 can promise more.
  int too_bright = 0;
  int over_reported = 0;  ///< pixels whose error is above what they report
  double beyond = 0;      ///< by how much at most
  Place beyond_at;        ///< and where
  int said_over = 0;      ///< pixels that report an error above the tolerance
  double reported = 0;    ///< largest error that any pixel reports
  /// Least (reported error / error) of a pixel with an error: below 1 where a report is too small.
  double min_share = 0;
  int proved = 0;        ///< pixels whose reported error is a proved bound
  double brightest = 0;  ///< largest channel of the reference

  bool kept() const { return over == 0 && over_reported == 0; }
  /// All of it in one line.
  std::string text() const;
};

/// Throws std::invalid_argument where sizes do not agree or the image reports no errors.
Verdict judge(const Image& image, const ReferenceFrame& reference, double tolerance);

}  // namespace pellucid::scenes
