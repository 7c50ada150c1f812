// SPDX-License-Identifier: Apache-2.0
//
// https://cfconventions.org/Data/cf-conventions/cf-conventions-1.11/cf-conventions.html, chapter 4.
#include "axis_role.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "text/text.h"

namespace pellucid {

namespace {

template <std::size_t count>
bool begins_with_one(const std::array<std::string_view, count>& list, std::string_view text) {
  return std::ranges::any_of(list, [&](std::string_view begin) { return text.starts_with(begin); });
}

std::string small_text(const AxisText& axis, std::string_view attribute) {
  return in_small_letters(trimmed(text_of(axis.coordinate, attribute), std::string_view(" \0", 2)));
}

AxisRole by_letter(std::string_view letter) {
  if (letter == "x") return AxisRole::x;
  if (letter == "y") return AxisRole::y;
  if (letter == "z") return AxisRole::z;
  if (letter == "t") return AxisRole::time;
  return letter == "e" ? AxisRole::member : AxisRole::unknown;
}

/// Returns the meaning by the names that Unidata's libraries write (_CoordinateAxisType).
AxisRole by_coordinate_type(const std::string& type) {
  constexpr std::array<std::string_view, 2> x{"lon", "geox"}, y{"lat", "geoy"};
  constexpr std::array<std::string_view, 3> z{"height", "pressure", "geoz"};
  constexpr std::array<std::string_view, 3> time{"time", "runtime", "timeoffset"};
  if (is_among(x, type)) return AxisRole::x;
  if (is_among(y, type)) return AxisRole::y;
  if (is_among(z, type)) return AxisRole::z;
  if (is_among(time, type)) return AxisRole::time;
  return type == "ensemble" ? AxisRole::member : AxisRole::unknown;
}

AxisRole by_standard_name(const std::string& name) {
  constexpr std::array<std::string_view, 4> x{
      "longitude", "grid_longitude", "projection_x_coordinate", "projection_x_angular_coordinate"};
  constexpr std::array<std::string_view, 4> y{
      "latitude", "grid_latitude", "projection_y_coordinate", "projection_y_angular_coordinate"};
  constexpr std::array<std::string_view, 3> time{"time", "forecast_period",
                                                 "forecast_reference_time"};
  constexpr std::array<std::string_view, 8> z{"altitude",
                                              "height",
                                              "depth",
                                              "air_pressure",
                                              "sea_water_pressure",
                                              "geopotential_height",
                                              "air_potential_temperature",
                                              "model_level_number"};
  constexpr std::array<std::string_view, 2> channel{"radiation_wavelength", "radiation_frequency"};
  if (is_among(x, name)) return AxisRole::x;
  if (is_among(y, name)) return AxisRole::y;
  if (is_among(time, name)) return AxisRole::time;
  constexpr std::array<std::string_view, 3> beginnings{"height_", "depth_", "altitude_"};
  if (is_among(z, name) || begins_with_one(beginnings, name)) return AxisRole::z;
  const bool is_model = name.starts_with("atmosphere_") || name.starts_with("ocean_");
  if (is_model && name.ends_with("_coordinate")) return AxisRole::z;
  if (name == "realization") return AxisRole::member;
  return is_among(channel, name) ? AxisRole::channel : AxisRole::unknown;
}

constexpr std::array<std::string_view, 15> pressures{
    "pa",   "hpa",  "kpa",     "mb",       "mbar",   "millibar", "millibars",  "bar",
    "bars", "dbar", "decibar", "decibars", "pascal", "pascals",  "hectopascal"};

AxisRole by_units(const std::string& units) {
  if (units.find(" since ") != std::string::npos) return AxisRole::time;
  constexpr std::array<std::string_view, 6> east{"degrees_east", "degree_east", "degree_e",
                                                 "degrees_e",    "degreee",     "degreese"};
  constexpr std::array<std::string_view, 6> north{"degrees_north", "degree_north", "degree_n",
                                                  "degrees_n",     "degreen",      "degreesn"};
  constexpr std::array<std::string_view, 3> levels{"level", "layer", "sigma_level"};
  if (is_among(east, units)) return AxisRole::x;
  if (is_among(north, units)) return AxisRole::y;
  return is_among(pressures, units) || is_among(levels, units) ? AxisRole::z : AxisRole::unknown;
}

/// Words that name an axis, alone or as a part of its name ("ocean_time", "lon_0").
constexpr std::array<std::string_view, 25> words_of_time{
    "time",  "times",   "timestep",  "tstep", "datetime", "date",  "dates",  "day",  "days",
    "month", "months",  "year",      "years", "hour",     "hours", "season", "week", "leadtime",
    "lead",  "reftime", "dayofyear", "doy",   "ntime",    "frame", "frames"};
constexpr std::array<std::string_view, 15> words_of_members{
    "member",       "members",      "ensemble",    "ensembles",    "ens",
    "realization",  "realizations", "realisation", "realisations", "mem",
    "perturbation", "percentile",   "quantile",    "nens",         "nmember"};
constexpr std::array<std::string_view, 9> words_of_x{
    "lon", "lons", "longitude", "longitudes", "rlon", "nlon", "easting", "eastings", "xi"};
constexpr std::array<std::string_view, 8> words_of_y{"lat",  "lats", "latitude", "latitudes",
                                                     "rlat", "nlat", "northing", "northings"};
constexpr std::array<std::string_view, 22> words_of_z{
    "lev",   "levs",   "level",    "levels",  "plev",     "plevs",     "ilev", "nlev",
    "depth", "depths", "height",   "heights", "altitude", "altitudes", "alt",  "elevation",
    "pfull", "phalf",  "pressure", "layer",   "layers",   "lv"};
constexpr std::array<std::string_view, 17> words_of_channels{
    "channel",    "channels",    "chan",      "band",    "bands", "component",
    "components", "comp",        "rgb",       "rgba",    "color", "colour",
    "wavelength", "wavelengths", "frequency", "species", "tracer"};
constexpr std::array<std::string_view, 14> words_of_corners{
    "bnds",     "bounds", "bnd",    "nbnd",    "nbnds",   "nv",        "nv2",
    "vertices", "vertex", "corner", "corners", "nvertex", "nvertices", "ncorners"};
/// Whole names.
constexpr std::array<std::string_view, 6> names_of_time{"t",  "step",   "steps",
                                                        "nt", "record", "records"};
constexpr std::array<std::string_view, 4> names_of_members{"number", "model", "scenario",
                                                           "experiment"};
constexpr std::array<std::string_view, 8> names_of_x{"x",  "xc", "xt", "xu",
                                                     "xh", "xq", "nx", "west_east"};
constexpr std::array<std::string_view, 8> names_of_y{"y",  "yc", "yt", "yv",
                                                     "yh", "yq", "ny", "south_north"};
constexpr std::array<std::string_view, 14> names_of_z{"z",     "zc",  "zt",    "zw",        "zi",
                                                      "zl",    "nz",  "zlev",  "zlevel",    "zu",
                                                      "s_rho", "s_w", "sigma", "bottom_top"};
constexpr std::array<std::string_view, 6> beginnings_of_z{"isobaric", "depth",  "height",
                                                          "altitude", "hybrid", "pressure"};

std::string without_digits(std::string word) {
  while (word.size() > 1 && word.back() >= '0' && word.back() <= '9') word.pop_back();
  return word;
}

std::vector<std::string> words_of_name(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    if (c == '_' || c == '-' || c == '.' || c == ' ' || c == '/') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  for (std::string& word : words) word = without_digits(word);
  return words;
}

/// Returns a word without what says that it is an axis: "xdim", "yspace".
std::string without_ending(const std::string& word) {
  constexpr std::array<std::string_view, 5> endings{"space", "dim", "axis", "coord", "pos"};
  for (const std::string_view ending : endings) {
    if (word.size() > ending.size() && word.ends_with(ending)) {
      return word.substr(0, word.size() - ending.size());
    }
  }
  return {};
}

/// Returns whether a name is one of these, as "x", "x_2", "grid_xt", "dim_x", "tomo_xdim",
/// "west_east_stag", but no "x1", of which there are three.
template <std::size_t count>
bool is_name_of(const std::array<std::string_view, count>& names, const std::string& name,
                const std::vector<std::string>& words) {
  if (is_among(names, name)) return true;
  if (name.ends_with("_stag") && is_among(names, name.substr(0, name.size() - 5))) return true;
  if (words.size() > 1 && is_among(names, name.substr(0, name.find('_')))) return true;
  constexpr std::array<std::string_view, 4> beginnings{"grid", "dim", "n", "axis"};
  if (words.size() == 2 && is_among(beginnings, words[0]) && is_among(names, words[1])) return true;
  return std::ranges::any_of(words, [&](const std::string& word) {
    const std::string bare = without_ending(word);
    return !bare.empty() && is_among(names, bare);
  });
}

template <std::size_t count>
bool has_word_of(const std::array<std::string_view, count>& list,
                 const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [&](const std::string& word) { return is_among(list, word); });
}

AxisRole by_name(const std::string& given) {
  if (given.empty()) return AxisRole::unknown;
  const std::string name = in_small_letters(given);
  const std::vector<std::string> words = words_of_name(name);
  if (has_word_of(words_of_time, words) || is_among(names_of_time, name)) return AxisRole::time;
  if (has_word_of(words_of_members, words) || is_among(names_of_members, name)) {
    return AxisRole::member;
  }
  if (has_word_of(words_of_corners, words)) return AxisRole::corner;
  if (has_word_of(words_of_x, words)) return AxisRole::x;
  if (has_word_of(words_of_y, words) || (words.size() > 1 && words[0] == "eta")) return AxisRole::y;
  if (has_word_of(words_of_z, words) || begins_with_one(beginnings_of_z, name)) return AxisRole::z;
  if (has_word_of(words_of_channels, words) || name == "c") return AxisRole::channel;
  if (is_name_of(names_of_x, name, words)) return AxisRole::x;
  if (is_name_of(names_of_y, name, words)) return AxisRole::y;
  return is_name_of(names_of_z, name, words) ? AxisRole::z : AxisRole::unknown;
}

/// Returns the direction that an attribute states, of CF or of Unidata's libraries.
std::string direction(const AxisText& axis) {
  const std::string positive = small_text(axis, "positive");
  return positive.empty() ? small_text(axis, "_CoordinateZisPositive") : positive;
}

bool is_name_of_depth(const std::string& name) {
  const std::vector<std::string> words = words_of_name(in_small_letters(name));
  return std::ranges::any_of(words,
                             [](const std::string& word) { return word.starts_with("depth"); });
}

}  // namespace

AxisEvidence axis_evidence(const AxisText& axis) {
  if (axis.type == "channel") return {AxisRole::channel, 9};
  if (axis.type == "time") return {AxisRole::time, 9};
  const std::string said = small_text(axis, "axis"), model = small_text(axis, "cartesian_axis");
  const std::string positive = direction(axis);
  const std::string type = small_text(axis, "_CoordinateAxisType");
  const std::array<AxisEvidence, 9> all{
      // "hours since" is no place, whatever an attribute that was copied says.
      AxisEvidence{by_units(small_text(axis, "units")) == AxisRole::time ? AxisRole::time
                                                                         : AxisRole::unknown,
                   9},
      AxisEvidence{by_letter(said), 8},
      AxisEvidence{by_letter(model), 8},
      AxisEvidence{by_coordinate_type(type), 7},
      AxisEvidence{by_standard_name(small_text(axis, "standard_name")), 6},
      AxisEvidence{by_units(small_text(axis, "units")), 5},
      AxisEvidence{positive == "up" || positive == "down" ? AxisRole::z : AxisRole::unknown, 4},
      AxisEvidence{by_name(axis.name), 2},
      AxisEvidence{by_name(axis.coordinate_name), 1}};
  const auto known = std::ranges::find_if(
      all, [](const AxisEvidence& evidence) { return evidence.role != AxisRole::unknown; });
  return known == all.end() ? AxisEvidence{} : *known;
}

int time_rank(const AxisText& axis) {
  const std::string name = small_text(axis, "standard_name");
  if (name == "time") return 3;
  if (name == "forecast_reference_time" || name == "forecast_period") return 0;
  return in_small_letters(axis.name) == "time" ? 2 : 1;
}

bool is_image_width(const std::string& name) {
  const std::string small = in_small_letters(name);
  return small == "width" || small == "column" || small == "columns" || small == "cols";
}

bool is_image_height(const std::string& name) {
  const std::string small = in_small_letters(name);
  return small == "height" || small == "row" || small == "rows";
}

bool is_bare_letter(const std::string& name) {
  const std::string small = in_small_letters(name);
  return small == "c" || small == "t";
}

bool grows_down(const AxisText& axis) {
  return direction(axis) == "down";
}

bool may_grow_down(const AxisText& axis) {
  if (!direction(axis).empty()) return false;
  const std::string name = small_text(axis, "standard_name");
  const bool is_sigma = name.starts_with("atmosphere_") && name.find("sigma") != std::string::npos;
  return name == "depth" || name.ends_with("_pressure") || is_sigma ||
         is_among(pressures, small_text(axis, "units")) || is_name_of_depth(axis.name) ||
         is_name_of_depth(axis.coordinate_name);
}

}  // namespace pellucid
