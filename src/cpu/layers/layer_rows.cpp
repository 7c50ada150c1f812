// SPDX-License-Identifier: Apache-2.0
#include "layer_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "grid/grid_light.h"
#include "layer_merge.h"

namespace pellucid {
namespace {

using Row = PellucidLayerRow;
constexpr float unit = rounding_unit<float>;

float largest_size(const CubicBernstein<double>& f) {
  return static_cast<float>(std::max(std::fabs(f.hull_min()), std::fabs(f.hull_max())));
}

/// The share of a whole that a range has.
Interval<double> share_of(Interval<double> whole, Interval<double> range) {
  const double length = whole.end - whole.begin;
  return {std::max((range.begin - whole.begin) / length, 0.0),
          std::min((range.end - whole.begin) / length, 1.0)};
}

void write_cell(const StructuredWalk<double>::Step& cell, Interval<double> range, float* to) {
  to[Row::part_kind] = Row::cell;
  to[Row::rounding] = 0;
  const auto [from, end] = share_of({cell.t_begin, cell.t_end}, range);
  for (int a = 0; a < 3; ++a) {
    const double way = cell.exit[a] - cell.entry[a];
    to[Row::place + a] = static_cast<float>(cell.cell[a]);
    to[Row::entry_in_cell + a] = static_cast<float>(cell.entry[a] + from * way);
    to[Row::exit_in_cell + a] =
        static_cast<float>(end < 1 ? cell.entry[a] + end * way : cell.exit[a]);
  }
}

/// Returns false if the gradient is not for lanes.
bool write_gradient(const LayerLook& look, const LayerStretch& stretch, Interval<double> range,
                    float* to) {
  if (stretch.gradient_error > 0) return false;
  const Interval<double> share = share_of({stretch.begin, stretch.end}, range);
  const bool whole = share.begin <= 0 && share.end >= 1;
  double largest = 0;
  const auto put = [&](const CubicBernstein<double>& f, float* at) {
    const CubicBernstein<double> there = whole ? f : restrict_to(f, share.begin, share.end);
    for (int b = 0; b < 4; ++b) {
      at[b] = static_cast<float>(there.b[b]);
      largest = std::max(largest, std::fabs(there.b[b]));
    }
  };
  if (look.reflection() != nullptr) {
    for (int c = 0; c < 3; ++c) put(stretch.gradient[c], to + Row::gradient + 4 * c);
  } else {
    std::fill_n(to + Row::gradient, 12, 0.0f);
  }
  if (look.extinction_factor() != nullptr) put(stretch.magnitude, to + Row::magnitude);
  return has_moderate_square(largest);
}

void write_primitives(PrimitiveSet set, float* to) {
  const std::uint32_t word[2] = {static_cast<std::uint32_t>(set.bits),
                                 static_cast<std::uint32_t>(set.bits >> 32)};
  std::memcpy(to, word, sizeof(word));
}

/// Writes the data of several variables (PellucidLayeredJob::curves). Returns false if they are not
/// for lanes.
bool write_curves(int variables, const LayerStretch& stretch, Interval<double> range, float* to) {
  for (int c = 0; c < variables; ++c) {
    const CubicBernstein<double> data = channel_on(stretch, c, range);
    const float size = largest_size(data);
    if (!(size < 1e30f)) return false;
    for (int b = 0; b < 4; ++b) to[4 * c + b] = static_cast<float>(data.b[b]);
    to[4 * variables + c] = 8 * unit * size + single_above(stretch.value_error[c]);
  }
  return true;
}

}  // namespace

float single_above(double x) {
  return static_cast<float>(x) * (1 + 2 * unit);
}

bool write_part(const SeenLayer& layer, int number, const LayerStretch& stretch,
                Interval<double> range, float* to, float* curves, bool& absorbs) {
  if (!layer.in_lanes) return false;
  to[Row::function] = static_cast<float>(layer.first_function + number);
  if (stretch.kind == LayerStretch::Kind::run) {
    to[Row::part_kind] = Row::run;
    to[Row::rounding] = 0;
    return true;
  }
  if (stretch.kind == LayerStretch::Kind::cell) {
    write_cell(stretch.cell, range, to);
    if (layer.mixture) write_primitives(stretch.primitives, to + Row::primitives_of_cell);
    return true;
  }
  const LayerLook& look = layer.source->look();
  if (layer.mixture) {
    to[Row::part_kind] = Row::curve;
    to[Row::rounding] = 0;
    write_primitives(stretch.primitives, to + Row::primitives_of_curve);
    return write_curves(layer.mixture->channels, stretch, range, curves) &&
           (!look.is_lit() || write_gradient(look, stretch, range, to));
  }
  const CubicBernstein<double> data = channel_on(stretch, layer.variable, range);
  const double least = data.hull_min(), most = data.hull_max();
  const double value_error = stretch.value_error[layer.variable];
  const bool is_constant = least == most && !(value_error > 0);
  to[Row::part_kind] = is_constant ? Row::constant : Row::curve;
  to[Row::rounding] = 0;
  if (is_constant) {
    const Material<double> material =
        layer.table[static_cast<std::size_t>(number)]->evaluate(least);
    absorbs = material.extinction > 0;
    to[Row::data] = static_cast<float>(material.extinction);
    to[Row::data + 1] = static_cast<float>(material.color.r);
    to[Row::data + 2] = static_cast<float>(material.color.g);
    to[Row::data + 3] = static_cast<float>(material.color.b);
  } else {
    const BinnedTransfer& function = *layer.function[static_cast<std::size_t>(number)];
    const float size = largest_size(data);
    const float rounding =
        8 * unit * size + 24 * unit * static_cast<float>(most - least) + single_above(value_error);
    if (!(size < 1e30f) || !(2 * rounding < function.narrowest)) return false;
    bool jumps = false;
    absorbs = may_absorb(function, true, static_cast<float>(least) - rounding,
                         static_cast<float>(most) + rounding, jumps);
    if (jumps) return false;
    for (int b = 0; b < 4; ++b) to[Row::data + b] = static_cast<float>(data.b[b]);
    to[Row::rounding] = rounding;
  }
  if (!absorbs || !look.is_lit()) return true;
  return write_gradient(look, stretch, range, to);
}

}  // namespace pellucid
