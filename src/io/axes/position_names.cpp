// SPDX-License-Identifier: Apache-2.0
#include "position_names.h"

#include "text/text.h"

namespace pellucid {

namespace {

constexpr auto spacings = std::to_array<std::string_view>(
    {"spacing", "spacings", "voxelsize", "voxelsizes", "voxelspacing", "pixelsize", "pixelspacing",
     "pixdim", "zooms", "elementsize", "elementspacing", "gridspacing", "voxeldims",
     "voxeldimensions", "sampling"});
constexpr auto origins = std::to_array<std::string_view>(
    {"origin", "gridorigin", "imageorigin", "volumeorigin", "translation"});
constexpr auto matrices = std::to_array<std::string_view>(
    {"affine", "affinematrix", "vox2ras", "ijktoras", "voxeltoras", "ijktolps"});
/// Words of names that speak of a place or of the values' scale.
constexpr auto words_of_places = std::to_array<std::string_view>(
    {"spacing",     "spacings",  "origin",     "affine",         "voxel",      "pixel",
     "voxelsize",   "pixelsize", "resolution", "direction",      "directions", "orientation",
     "translation", "translate", "transform",  "transformation", "pixdim",     "zooms",
     "offset",      "scale",     "scales",     "slope",          "intercept",  "rotation",
     "calibration", "extent",    "extents",    "bbox",           "edge",       "elementsize",
     "scalefactor", "nodata",    "fillvalue",  "sampling",       "vox2ras",    "delta"});

}  // namespace

NameParts parts_of(const std::string& name) {
  NameParts parts;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) parts.words.push_back(in_small_letters(word));
    word.clear();
  };
  char before = '\0';
  for (const char c : name) {
    const bool is_upper = c >= 'A' && c <= 'Z';
    // "voxelSize" is two words, "RAS" is one.
    if (is_upper && before >= 'a' && before <= 'z') end_word();
    if (c == '_' || c == '-' || c == ' ' || c == '.' || c == '/') {
      end_word();
    } else {
      word += c;
    }
    before = c;
  }
  end_word();
  constexpr auto units =
      std::to_array<std::string_view>({"m", "cm", "mm", "um", "nm", "micron", "microns"});
  for (const std::string& each : parts.words) {
    if (each == "xyz" || each == "zyx") {
      parts.order = each;
    } else if (parts.words.size() > 1 && is_among(units, each)) {
      parts.units = each;
    } else if (parts.words.size() > 1 && each.size() == 1 &&
               axis_letters.find(each) != std::string_view::npos) {
      parts.axis = axis_letters.find(each);
    } else {
      parts.bare += each;
    }
  }
  return parts;
}

AlongOne along_one(const NameParts& parts, std::size_t& axis) {
  if (parts.axis) {
    axis = *parts.axis;
    if (says_spacing(parts) || parts.bare == "step") return AlongOne::spacing;
    return says_origin(parts) ? AlongOne::origin : AlongOne::none;
  }
  const std::string& bare = parts.bare;
  const auto letter_at = [&](std::size_t place) {
    axis = axis_letters.find(bare[place]);
    return axis != std::string_view::npos;
  };
  if (bare.size() == 2 && bare[0] == 'd' && letter_at(1)) return AlongOne::spacing;
  if (bare.size() == 6 && bare.starts_with("delta") && letter_at(5)) return AlongOne::spacing;
  if (bare.size() == 2 && bare[1] == '0' && letter_at(0)) return AlongOne::origin;
  return AlongOne::none;
}

AxisRole coordinate_role(const std::string& name) {
  AxisText text;
  text.name = name;
  const AxisRole role = axis_evidence(text).role;
  const bool is_place = role == AxisRole::x || role == AxisRole::y || role == AxisRole::z;
  return is_place || role == AxisRole::time ? role : AxisRole::unknown;
}

bool says_spacing(const NameParts& parts) {
  return is_among(spacings, parts.bare);
}

bool says_origin(const NameParts& parts) {
  return is_among(origins, parts.bare);
}

bool says_matrix(const NameParts& parts) {
  return is_among(matrices, parts.bare);
}

bool speaks_of_places(const NameParts& parts) {
  std::size_t axis = 0;
  if (along_one(parts, axis) != AlongOne::none || says_spacing(parts) || says_origin(parts) ||
      says_matrix(parts)) {
    return true;
  }
  return std::ranges::any_of(
      parts.words, [](const std::string& word) { return is_among(words_of_places, word); });
}

}  // namespace pellucid
