// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "axes/length_units.h"

namespace pellucid {

/// An axis that the pages of a file go along.
struct PageAxis {
  char letter = 'z';       ///< 'z', 'c' (channels), 't' (times), 'o' (others)
  std::int64_t count = 1;  ///< 0, of the slowest: as many as the pages make
};

/// Consecutive pages and the plane that the first of them is. The others follow in the order of the
/// axes.
struct PageRun {
  std::string file;                   ///< in the same folder; empty: the file itself
  std::int64_t directory = 0;         ///< number of the first page among the file's directories
  std::optional<std::int64_t> count;  ///< none: all pages from there on
  std::int64_t z = 0, c = 0, t = 0;
};

/// A linear calibration: offset + slope · stored value.
struct ValueCalibration {
  double offset = 0, slope = 1;
  bool operator==(const ValueCalibration&) const = default;
};

/// Description of an image file besides the values of its pages.
struct PageDescription {
  std::string writer;  ///< who describes the pages, for messages: "ImageJ"; empty: nobody does

  std::vector<PageAxis> axes;  ///< of the pages, the fastest first; empty: pages are slices
  std::vector<PageRun> runs;   ///< empty: all pages, from the first plane on
  /// True if the planes may lie behind the first page, without pages of their own.
  bool may_share_one_page = false;
  std::vector<std::string> channels;  ///< names; empty: none
  std::optional<double> time_step;

  std::array<std::optional<SaidLength>, 3> spacing;
  std::array<double, 3> first_index{};  ///< place of the world's origin, in pixels and slices
  std::optional<ValueCalibration> calibration;

  bool is_one_of_several = false;  ///< whether the file has images beside the described one
  bool obeys_series = false;       ///< whether the series of the options chose it among several
  bool obeys_axes = false;         ///< whether the axes of the options say what its axes are

  std::vector<std::string> notes;  ///< on what is said and not done
};

/// A page, as far as the meaning of a description depends on it.
struct DescribedPage {
  std::int64_t columns = 0, rows = 0;
  int samples = 1;
  std::string type;  ///< of the values: "u8" … "f64"
  /// Pixels per unit along x and y (XResolution, YResolution); 0: not stated.
  std::array<double, 2> resolution{};
};

/// Returns a note of pixels that are not square, by numbers without a unit that `source` has:
/// pixels per unit along x and y.
std::string aspect_note(const std::string& source, double x, double y);
/// Returns the product of the counts; the largest number where it is beyond that.
std::int64_t plane_count(const std::vector<PageAxis>& axes);

}  // namespace pellucid
