// SPDX-License-Identifier: Apache-2.0
#include "layer_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "grid/grid_light.h"
#include "layer_merge.h"
#include "packet_setup.h"

namespace pellucid {
namespace {

using Row = PellucidLayerRow;
constexpr float unit_of_float = rounding_unit<float>;

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
bool write_gradient(const LayerAppearance& look, const LayerStretch& stretch,
                    Interval<double> range, float* to) {
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
    to[4 * variables + c] = 8 * unit_of_float * size + single_above(stretch.value_error[c]);
  }
  return true;
}

/// Returns the largest magnitude of the values of a table's points.
double largest_of(const PiecewiseLinear<double>& table) {
  return std::max(std::fabs(table.value[0]), std::fabs(table.value[table.count - 1]));
}

/// Returns whether lanes are for a table: numbers whose squares binary32 has.
bool suits_lanes(const PiecewiseLinear<double>& table) {
  const double largest = largest_of(table);
  return largest == 0 || is_moderate(largest);
}

/// Returns whether binary32 knows the places of Gaussians, K (v - c).
bool suits_lanes(const GaussianMixture<double>& gaussians) {
  const auto suits = [](double x) { return has_moderate_square(std::fabs(x)); };
  for (int i = 0; i < gaussians.count; ++i) {
    const Gaussian<double>& g = gaussians.primitive[i];
    for (int c = 0; c < g.channels; ++c) {
      if (!suits(g.center[c])) return false;
      for (int row = 0; row < g.rows; ++row) {
        if (!suits(g.matrix[row][c])) return false;
      }
    }
  }
  return true;
}

/// The factor of a layer's extinction: the largest one, and the largest argument.
struct FactorRange {
  double largest = 0, steepest = 0;
};

/// None: nobody knows how large the argument is.
std::optional<FactorRange> factor_range(const LayerAppearance& look) {
  const Layer& layer = look.layer();
  const auto* const channels = std::get_if<ChannelsContent>(&layer.content);
  if (const ChannelTransferFunction* const factor = look.value_factor()) {
    if (channels == nullptr) return std::nullopt;
    const VolumeStatistics& data = (*channels->channels)[factor->channel].volume->statistics();
    return FactorRange{channels->transfer_function->largest_factor(),
                       std::max(std::fabs(look.factor_argument(data.minimum)),
                                std::fabs(look.factor_argument(data.maximum)))};
  }
  const Volume* volume = nullptr;
  if (const auto* const content = std::get_if<VolumeContent>(&layer.content)) {
    volume = content->volume.get();
  } else if (channels != nullptr) {
    volume = (*channels->channels)[layer.gradient_opacity->channel()].volume.get();
  }
  if (volume == nullptr) return std::nullopt;
  return FactorRange{layer.gradient_opacity->largest_factor(), steepest_gradient(look, *volume)};
}

/// Returns the variable whose gradient lights a layer.
int lit_variable(const LayerAppearance& look) {
  return look.layer().shading ? look.layer().shading->channel.index() : 0;
}

}  // namespace

bool prepare(SeenLayer& one, const PacketLight& lights,
             std::deque<BinnedTransferStorage>& functions) {
  const LayerSource& source = *one.source;
  const LayerAppearance& look = source.look();
  one.first_function = static_cast<int>(functions.size());
  const bool suits =
      one.mixture
          ? suits_lanes(source.functions()[0].gaussians)
          : std::ranges::all_of(one.table, [](const auto* table) { return suits_lanes(*table); });
  if (!suits || source.most_extinction() > 1e12) return false;
  const Volume* const lit_cells = source.cells(lit_variable(look));
  const Reflection<double>* const r = look.reflection();
  if (r != nullptr) {
    // Where a light turns its edge to the direction half-way to a point light is no place that
    // packets know.
    if (!has_moderate_square(std::sqrt(r->flat_square)) ||
        (lit_cells != nullptr && !has_moderate_square(steepest_gradient(look, *lit_cells))) ||
        !has_moderate_square(static_cast<double>(lights.farthest)) ||
        (lights.points > 0 && has_kink_in_highlight(in_single(*r)))) {
      return false;
    }
  }
  std::optional<FactorRange> factor;
  if (look.extinction_factor() != nullptr) {
    factor = factor_range(look);
    if (one.mixture || !factor ||
        !suits_single(*look.extinction_factor(), factor->largest, factor->steepest)) {
      return false;
    }
  }
  for (const PiecewiseLinear<double>* const table : one.table) {
    functions.emplace_back(*table, largest_of(*table));
    one.function.push_back(&functions.back().view());
  }
  if (source.cells() != nullptr) {
    const auto add_grid = [&](int variable) {
      if (variable == lit_variable(look)) one.lit_grid = static_cast<int>(one.grid.size());
      set_grid(*source.cells(variable), one.grid.emplace_back());
    };
    if (one.mixture) {
      for (int c = 0; c < one.mixture->channels; ++c) add_grid(c);
    } else {
      add_grid(one.variable);
      if (look.is_lit() && one.variable != lit_variable(look)) add_grid(lit_variable(look));
    }
  }
  if (!one.grid.empty() && !is_uniform(*source.cells())) {
    source.cells()->visit([&](const auto& grid) {
      for (int a = 0; a < 3; ++a) {
        for (int i = 0; i <= grid.axis[a].cells(); ++i) {
          one.plane[a].push_back(grid.axis[a].plane(i));
        }
      }
    });
  }
  if (!look.is_lit()) return true;
  PacketLight& light = one.light.emplace(r != nullptr ? lights : no_light());
  if (r != nullptr) light.reflection = in_single(*r);
  if (lit_cells != nullptr) {
    light.of_field = r != nullptr && look.layer().shading->gradient == GradientKind::field ? 1 : 0;
    set_world_gradient(*lit_cells, light);
  }
  if (factor) {
    set_factor(*look.extinction_factor(), factor->largest, factor->steepest, one.factor, light);
  }
  return true;
}

float single_above(double x) {
  return static_cast<float>(x) * (1 + 2 * unit_of_float);
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
  const LayerAppearance& look = layer.source->look();
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
    const float rounding = 8 * unit_of_float * size +
                           24 * unit_of_float * static_cast<float>(most - least) +
                           single_above(value_error);
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
