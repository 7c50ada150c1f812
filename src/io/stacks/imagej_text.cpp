// SPDX-License-Identifier: Apache-2.0
//
// ImageJ's FileSaver writes lines of "key=value" behind "ImageJ=1.53t", its Opener reads them:
// https://imagej.net/ij/source/ij/io/FileSaver.java. Pages run along channels, slices and frames.
// SCIFIO adds "axes=X,Y,Channel,Z" and "lengths=4,5,2,6"; its pages run along what is not in them.

#include "imagej_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "pellucid/scene/error.h"
#include "text/latin_text.h"
#include "text/printable.h"
#include "text/text.h"

namespace pellucid {

namespace {

constexpr std::int64_t max_planes = std::numeric_limits<int>::max();

using Lines = std::map<std::string, std::string, std::less<>>;

Lines lines_of(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    const std::size_t equals = line.find('=');
    if (equals != std::string_view::npos) {
      lines.emplace(trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1)));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string word_of(const Lines& lines, std::string_view key) {
  const auto line = lines.find(key);
  return line == lines.end() || line->second == "null" ? std::string() : line->second;
}

std::optional<double> number_in(std::string_view word) {
  const std::optional<double> number = number_of_word<double>(word);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<double> number_of(const Lines& lines, std::string_view key) {
  return number_in(word_of(lines, key));
}

/// Returns the count that a key says, at least 1. Throws Error for what is none.
std::optional<std::int64_t> count_in(const std::string& word, std::string_view key,
                                     const std::string& name) {
  if (word.empty()) return std::nullopt;
  const std::optional<double> value = number_in(word);
  if (!value || *value < 1 || *value > static_cast<double>(max_planes) ||
      *value != std::floor(*value)) {
    throw Error(name + ": its description says " + std::string(key) + "=" + printable(word) +
                ", which is no number of pages; mend the description");
  }
  return static_cast<std::int64_t>(*value);
}

std::vector<std::string> list_of(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    words.emplace_back(trimmed(text.substr(0, comma)));
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return words;
}

char letter_of(std::string_view axis) {
  const std::string small = in_small_letters(axis);
  return small == "z"                         ? 'z'
         : small == "channel" || small == "c" ? 'c'
         : small == "time" || small == "t"    ? 't'
                                              : 'o';
}

void add_axis(PageDescription& said, char letter, std::int64_t count, const std::string& name) {
  if (count == 1) return;
  const auto same = std::ranges::find(said.axes, letter, &PageAxis::letter);
  if (same != said.axes.end()) {
    throw Error(name + ": its description (" + said.writer +
                ") has two axes that are neither z, channels nor times; save a part of it");
  }
  said.axes.push_back({letter, count});
}

/// Reads SCIFIO's lists, and returns whether there are some.
bool read_axes(const Lines& lines, const DescribedPage& page, PageDescription& said,
               const std::string& name) {
  const std::vector<std::string> axes = list_of(word_of(lines, "axes")),
                                 lengths = list_of(word_of(lines, "lengths")),
                                 scales = list_of(word_of(lines, "scales")),
                                 units = list_of(word_of(lines, "units"));
  if (axes.size() != lengths.size()) {
    said.notes.push_back("its description names " + std::to_string(axes.size()) + " axes and " +
                         std::to_string(lengths.size()) +
                         " lengths (SCIFIO), which are not taken into account");
  }
  if (axes.empty() || axes.size() != lengths.size()) return false;
  said.writer = "SCIFIO";
  bool is_along_samples = page.samples > 1;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string small = in_small_letters(axes[i]);
    const std::int64_t count = count_in(lengths[i], "lengths", name).value_or(1);
    const std::size_t place = small == "x" ? 0 : small == "y" ? 1 : small == "z" ? 2 : 3;
    if (place < 3 && i < scales.size()) {
      std::string unit = i < units.size() && units[i] != "null" ? units[i] : std::string();
      if (const auto scale = number_in(scales[i]); scale && !(unit.empty() && *scale == 1)) {
        said.spacing[place] = {*scale, readable_text(unit)};
      }
    }
    if (small == "time" && i < scales.size()) said.time_step = number_in(scales[i]);
    if (const std::int64_t side = place == 0 ? page.columns : page.rows;
        place < 2 && count != side) {
      said.notes.push_back("its description says " + std::to_string(count) + " pixels along " +
                           axes[i] + " (SCIFIO lengths), but its pages have " +
                           std::to_string(side) + "; it may be that of another file");
    }
    if (place < 2) continue;
    if (letter_of(axes[i]) == 'c' && is_along_samples && count == page.samples) {
      is_along_samples = false;
      continue;
    }
    add_axis(said, letter_of(axes[i]), count, name);
  }
  return true;
}

void read_counts(const Lines& lines, const DescribedPage& page, PageDescription& said,
                 const std::string& name) {
  said.may_share_one_page = true;
  std::int64_t in_page = 1;
  for (const auto& [key, letter] : {std::pair{"channels", 'c'}, {"slices", 'z'}, {"frames", 't'}}) {
    const std::int64_t count = count_in(word_of(lines, key), key, name).value_or(1);
    if (letter == 'c' && page.samples > 1 && count == page.samples) {
      in_page = count;  // colors of 16 bits each, which ImageJ counts as images
    } else {
      add_axis(said, letter, count, name);
    }
  }
  const auto images = count_in(word_of(lines, "images"), "images", name);
  if (!images || *images == in_page) return;
  if (said.axes.empty()) said.axes.push_back({'z', *images / in_page});
  if (plane_count(said.axes) == *images || plane_count(said.axes) * in_page == *images) return;
  throw Error(name + ": its description (ImageJ) says " + std::to_string(*images) +
              " images, but its channels, slices and frames make " +
              std::to_string(plane_count(said.axes)) + "; save it again with ImageJ");
}

void read_distances(const Lines& lines, const DescribedPage& page, PageDescription& said) {
  const std::string unit = readable_text(word_of(lines, "unit"));
  const auto unit_of = [&](const char* key) {
    const std::string own = readable_text(word_of(lines, key));
    return own.empty() ? unit : own;
  };
  if (!unit.empty()) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double distance = 1 / page.resolution[axis];
      if (page.resolution[axis] > 0 && std::isfinite(distance)) {
        said.spacing[axis] = {distance, axis == 0 ? unit : unit_of("yunit")};
      }
    }
  }
  // ImageJ takes the amount of a negative one, too.
  if (const auto z = number_of(lines, "spacing")) {
    said.spacing[2] = {std::abs(*z), unit_of("zunit")};
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string key = std::string(1, "xyz"[axis]) + "origin";
    said.first_index[axis] = number_of(lines, key).value_or(0);
  }
  if (const auto interval = number_of(lines, "finterval")) {
    said.time_step = interval;
  } else if (const auto rate = number_of(lines, "fps"); rate && *rate > 0) {
    said.time_step = 1 / *rate;
  }
  if (word_of(lines, "inverty") == "true") {
    said.notes.emplace_back("ImageJ counts its y upwards (inverty); the first row is y = 0 here");
  }
}

void read_calibration(const Lines& lines, const DescribedPage& page, PageDescription& said) {
  const auto function = number_of(lines, "cf");
  const std::string unit = readable_text(word_of(lines, "vunit"));
  constexpr double straight_line = 0, none = 20;
  const bool is_line = function == straight_line;
  if (function && !is_line && *function != none) {
    said.notes.push_back("ImageJ calibrates its values by a function that is no line (cf=" +
                         printable(word_of(lines, "cf")) + "); they are read as they are stored");
    return;
  }
  if (is_line) {
    const auto c0 = number_of(lines, "c0"), c1 = number_of(lines, "c1");
    if (!c0 || !c1 || *c1 == 0) {
      said.notes.emplace_back(
          "ImageJ calibrates its values by a line whose numbers (c0, c1) are not usable; they are "
          "read as they are stored");
      return;
    }
    // ImageJ adds 32768 to signed values, and calibrates what it then has.
    const double shift = page.type == "i16" ? 32768 : 0;
    said.calibration = {*c0 + *c1 * shift, *c1};
    if (said.calibration->offset == 0 && *c1 == 1) {
      said.calibration.reset();
    } else {
      said.notes.push_back("its values are calibrated by ImageJ's line, " +
                           printable(word_of(lines, "c0")) + " + " +
                           printable(word_of(lines, "c1")) + " times the stored one" +
                           (unit.empty() ? "" : ", in " + printable(unit)));
      return;
    }
  }
  if (!unit.empty() && unit != " ") {
    said.notes.push_back("its values are in " + printable(unit) + " (vunit)");
  }
}

/// Tells of words in the place of numbers, which are left out.
void tell_no_numbers(const Lines& lines, PageDescription& said) {
  for (const char* key : {"spacing", "xorigin", "yorigin", "zorigin", "finterval", "fps"}) {
    const std::string word = word_of(lines, key);
    if (word.empty() || number_in(word)) continue;
    said.notes.push_back("its description says " + std::string(key) + "=" + printable(word) +
                         ", which is no number; it is left out");
  }
  for (const std::string& scale : list_of(word_of(lines, "scales"))) {
    if (scale == "null" || number_in(scale)) continue;
    said.notes.push_back("its description has a scale " + printable(scale) +
                         " (SCIFIO scales), which is no number; it is left out");
  }
}

void tell_unknown(const Lines& lines, PageDescription& said) {
  static constexpr std::string_view known[] = {
      "ImageJ",       "SCIFIO",   "images",   "channels",  "slices",  "frames", "hyperstack",
      "mode",         "unit",     "yunit",    "zunit",     "spacing", "loop",   "min",
      "max",          "cf",       "vunit",    "finterval", "fps",     "tunit",  "xorigin",
      "yorigin",      "zorigin",  "inverty",  "axes",      "lengths", "scales", "units",
      "bitsPerPixel", "Software", "DateTime", "display"};
  std::string unknown;
  for (const auto& [key, value] : lines) {
    const bool is_coefficient = key.size() == 2 && key[0] == 'c' && key[1] >= '0' && key[1] <= '9';
    if (is_coefficient || std::ranges::find(known, key) != std::end(known)) continue;
    unknown += (unknown.empty() ? "" : ", ") + key;
  }
  if (!unknown.empty()) {
    said.notes.push_back("its description has lines that are not read: " + printable(unknown));
  }
}

}  // namespace

std::string readable_text(std::string_view text) {
  const bool utf8 = is_utf8(text);
  std::string readable;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    if (text.substr(i).starts_with("\\u") && i + 6 <= text.size() &&
        std::from_chars(&text[i + 2], text.data() + i + 6, code, 16).ptr == text.data() + i + 6 &&
        code >= ' ') {
      append_utf8(readable, code);
      i += 5;
    } else if (utf8) {
      readable += text[i];
    } else {
      append_utf8(readable, static_cast<unsigned char>(text[i]));
    }
  }
  return readable;
}

bool is_imagej_text(std::string_view text) {
  return text.starts_with("ImageJ=") || text.starts_with("SCIFIO=") ||
         text.find("\nSCIFIO=") != std::string_view::npos;
}

PageDescription read_imagej_text(std::string_view text, const DescribedPage& page,
                                 const std::string& name) {
  const Lines lines = lines_of(text);
  PageDescription said;
  said.writer = "ImageJ";
  read_distances(lines, page, said);
  if (!read_axes(lines, page, said, name)) read_counts(lines, page, said, name);
  read_calibration(lines, page, said);
  tell_no_numbers(lines, said);
  tell_unknown(lines, said);
  return said;
}

}  // namespace pellucid
