// SPDX-License-Identifier: Apache-2.0
//
// Names as in NGFF (UDUNITS-2) and symbols as in OME-XML's UnitsLength.

#include "length_units.h"

#include <string_view>
#include <utility>

#include "text/text.h"

namespace pellucid {

namespace {

struct Prefix {
  std::string_view name, symbol;
  double factor;
};
constexpr Prefix prefixes[] = {
    {"yotta", "Y", 1e24}, {"zetta", "Z", 1e21},  {"exa", "E", 1e18},
    {"peta", "P", 1e15},  {"tera", "T", 1e12},   {"giga", "G", 1e9},
    {"mega", "M", 1e6},   {"kilo", "k", 1e3},    {"hecto", "h", 1e2},
    {"deca", "da", 1e1},  {"", "", 1},           {"deci", "d", 1e-1},
    {"centi", "c", 1e-2}, {"milli", "m", 1e-3},  {"micro", "\u00b5", 1e-6},
    {"nano", "n", 1e-9},  {"pico", "p", 1e-12},  {"femto", "f", 1e-15},
    {"atto", "a", 1e-18}, {"zepto", "z", 1e-21}, {"yocto", "y", 1e-24}};

// Of the units of sky and print, as OME defines them.
constexpr double inch = 0.0254, astronomical_unit = 149597870700., parsec = 3.0856775814913673e16,
                 light_year = 9460730472580800.;

// Both letters that stand for micro (U+00B5, U+03BC) and both that stand for Ångström are in use.
constexpr std::pair<std::string_view, double> symbols[] = {{"um", 1e-6},
                                                           {"\u03bcm", 1e-6},
                                                           {"\u00c5", 1e-10},
                                                           {"\u212b", 1e-10},
                                                           {"thou", inch / 1e3},
                                                           {"mil", inch / 1e3},
                                                           {"li", inch / 12},
                                                           {"in", inch},
                                                           {"\"", inch},
                                                           {"ft", 12 * inch},
                                                           {"yd", 36 * inch},
                                                           {"mi", 63360 * inch},
                                                           {"ua", astronomical_unit},
                                                           {"au", astronomical_unit},
                                                           {"ly", light_year},
                                                           {"pc", parsec},
                                                           {"pt", inch / 72}};

constexpr std::pair<std::string_view, double> names[] = {{"micron", 1e-6},
                                                         {"angstrom", 1e-10},
                                                         {"\u00e5ngstr\u00f6m", 1e-10},
                                                         {"inch", inch},
                                                         {"foot", 12 * inch},
                                                         {"feet", 12 * inch},
                                                         {"yard", 36 * inch},
                                                         {"mile", 63360 * inch},
                                                         {"line", inch / 12},
                                                         {"point", inch / 72},
                                                         {"lightyear", light_year},
                                                         {"light year", light_year},
                                                         {"parsec", parsec},
                                                         {"astronomical unit", astronomical_unit}};

std::optional<double> by_symbol(std::string_view unit) {
  for (const Prefix& prefix : prefixes) {
    if (unit == std::string(prefix.symbol) + "m") return prefix.factor;
  }
  for (const auto& [symbol, metres] : symbols) {
    if (unit == symbol) return metres;
  }
  return std::nullopt;
}

std::optional<double> by_name(std::string_view unit) {
  for (const Prefix& prefix : prefixes) {
    for (const std::string_view metre : {"meter", "metre"}) {
      if (unit == std::string(prefix.name) + std::string(metre)) return prefix.factor;
    }
  }
  for (const auto& [name, metres] : names) {
    if (unit == name) return metres;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> metres_of(const std::string& unit) {
  if (const auto metres = by_symbol(unit)) return metres;
  const std::string small = in_small_letters(unit);
  std::string_view name = small;
  if (const auto metres = by_name(name)) return metres;
  if (name == "inches") return inch;
  if (name.size() < 4 || !name.ends_with('s')) return std::nullopt;
  name.remove_suffix(1);
  return by_name(name);
}

CommonLengths in_one_unit(const std::array<std::optional<SaidLength>, 3>& lengths) {
  CommonLengths common;
  bool differ = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!lengths[axis]) continue;
    const SaidLength& said = *lengths[axis];
    common.value[axis] = said.value;
    if (said.unit.empty()) continue;
    if (common.unit.empty()) common.unit = said.unit;
    differ = differ || said.unit != common.unit;
  }
  if (!differ) return common;
  const std::optional<double> base = metres_of(common.unit);
  CommonLengths turned = common;
  bool same = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!lengths[axis] || lengths[axis]->unit.empty()) continue;
    const std::string& unit = lengths[axis]->unit;
    const std::optional<double> metres = metres_of(unit);
    if (unit == common.unit) continue;
    if (!base || !metres) {
      common.note = "its lengths have the units " + common.unit + " and " + unit +
                    ", which cannot be turned into one; they are taken as they are";
      return common;
    }
    same = same && *metres == *base;
    *turned.value[axis] *= *metres / *base;
  }
  if (!same) turned.note = "its axes have several units; lengths are turned into " + turned.unit;
  return turned;
}

}  // namespace pellucid
