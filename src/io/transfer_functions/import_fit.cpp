// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "chord_fit.h"
#include "import_paths.h"
#include "pellucid/scene/error.h"

namespace pellucid::imported {
namespace {

/// Relative rounding of the intervals' ends.
constexpr double rounding = 1e-14;
/// Moves all nodes such that they span the range.
void move_to(Function& function, const std::array<double, 2>& range) {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  const auto look = [&](double x) {
    first = std::min(first, x);
    last = std::max(last, x);
  };
  for (const ColorNode& node : function.colors) look(node.x);
  for (const OpacityNode& node : function.opacities) look(node.x);
  if (!function.gaussians.empty()) {
    look(function.lower);
    look(function.upper);
  }
  if (!(first < last)) {
    throw Error(function.format + ": it has one value only, which cannot be moved to a range");
  }
  const double span = last - first, length = range[1] - range[0];
  const auto moved = [&](double x) {
    return x == last ? range[1] : range[0] + (x - first) / span * length;
  };
  for (ColorNode& node : function.colors) node.x = moved(node.x);
  for (OpacityNode& node : function.opacities) node.x = moved(node.x);
  for (GaussianNode& node : function.gaussians) {
    node.x = moved(node.x);
    node.width = node.width / span * length;
    node.x_bias = node.x_bias / span * length;
  }
  for (OpacityNode& node : function.gradient_opacity) node.x = node.x / span * length;
  function.lower = moved(function.lower);
  function.upper = moved(function.upper);
}

void add_notes(const Function& function, ImportedTransferFunction& imported) {
  const OpacityTable& table = imported.table;
  const std::string points = std::to_string(table.points.size()) + " points";
  imported.notes.push_back(table.color_deviation > 0
                               ? "colors: fitted by lines in linear light, within " +
                                     text_of(table.color_deviation) + " of each channel"
                               : "colors: exact");
  imported.notes.push_back(table.extinction_deviation > 0
                               ? "opacities: fitted, extinctions within a factor of 1 + " +
                                     text_of(table.extinction_deviation)
                               : "opacities: exact, per unit distance of " +
                                     text_of(table.unit_distance));
  imported.notes.push_back(points);
  fit_light(function, imported);
  imported.notes.insert(imported.notes.end(), function.notes.begin(), function.notes.end());
}

}  // namespace

ImportedTransferFunction fit(const Function& given, const ImportOptions& options) {
  Function function = given;
  if (options.range) move_to(function, *options.range);
  if (options.encoding) function.numbers = *options.encoding;
  if (options.unit_distance) function.unit_distance = *options.unit_distance;
  ImportedTransferFunction imported;
  imported.format = function.format;
  imported.name = function.name;
  const Curves curves(function);
  ChordFit<Curves> chords(curves, options.deviation, options.deviation, function.format);
  OpacityTable& table = imported.table;
  table.points = chords.points();
  table.unit_distance = function.unit_distance;
  if (chords.color_deviation() > 0) {
    const bool lab = function.space == ColorSpace::lab || function.space == ColorSpace::diverging;
    table.color_deviation = chords.color_deviation() + rounding + (lab ? lab_step : 0);
  }
  if (chords.depth_deviation() > 0) {
    table.extinction_deviation = chords.depth_deviation() + rounding;
  }
  add_notes(function, imported);
  return imported;
}

}  // namespace pellucid::imported
