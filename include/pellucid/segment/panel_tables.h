// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/gaussian_panels.h"
#include "pellucid/segment/multivariate_span.h"
#include "pellucid/segment/rounding.h"
#include "pellucid/segment/table_mass.h"

namespace pellucid::detail {

/// The largest and the second largest of some numbers >= 0.
template <class T>
struct TopTwo {
  T first{}, second{};
  PELLUCID_HD void add(T x) noexcept {
    second = max(second, min(first, x));
    first = max(first, x);
  }
  PELLUCID_HD T sum() const noexcept { return first + second; }
};

/// The tables of a transfer function on a panel.
template <class T>
struct PanelTables {
  DepthWeightedColor<T> sum;
  T most{};           ///< upper bound on their depth
  T rounding{};       ///< error of the depth, plus that of the color as if it were one of the depth
  T colors{};         ///< largest change of the color of any one of them
  TopTwo<T> changes;  ///< largest changes of the logarithms of their extinctions
};

template <class S, class Data, int Capacity>
PELLUCID_HD PanelTables<S> measure_tables_of_one(const MultivariateTransfer<S>& transfer,
                                                 const MultivariateSpan<S, Data, Capacity>& span,
                                                 S largest_color) noexcept {
  PanelTables<S> result;
  for (int i = 0; i < transfer.tables; ++i) {
    const PiecewiseLinear<S>& table = transfer.table[i].table;
    const CubicBernstein<S> data = as_cubic(span.data[transfer.table[i].channel]);
    const S error = data_rounding(data);
    const int first = table.interval(data.hull_min() - error);
    const int last = table.interval(data.hull_max() + error);
    if (!table.has_extinction(first, last)) continue;
    const RoundingError<S> off =
        rounding_error(data, span.length, largest_color, table, first, last, error,
                       sensitivity(table, first, last, error));
    result.rounding += off.depth;
    const TableMass<S> mass = table_mass(data, table, span.length);
    if (!(mass.depth > S(0))) continue;
    // Its color, seen by no more than its own opacity; and the closed form's 32 u.
    result.rounding += min(mass.upper * span.length, S(1)) *
                       (off.color / largest_color + S(32 * rounding_unit<S>));
    result.most += mass.upper * span.length;
    result.sum.add(mass.depth, mass.color);
    result.sum.range.add(true, mass.range.lower);
    result.sum.range.add(true, mass.range.upper);
    result.colors = max(result.colors, mass.range.oscillation());
    result.changes.add(mass.lower > S(0) ? log(mass.upper / mass.lower) : S(1e6));
  }
  result.rounding = min(result.rounding, S(1));
  return result;
}

/// Computes the tables lane by lane if T is a batch: tables are looked up one number at a time.
template <class T, template <class> class Data, int Capacity>
PELLUCID_HD PanelTables<T> measure_tables(const MultivariateTransfer<scalar_t<T>>& transfer,
                                          const MultivariateSpan<T, Data<T>, Capacity>& span,
                                          scalar_t<T> largest_color) noexcept {
  if constexpr (lanes<T> == 1) {
    return measure_tables_of_one(transfer, span, largest_color);
  } else {
    using S = scalar_t<T>;
    constexpr int n = lanes<T>, fields = 15, numbers = sizeof(Data<S>) / sizeof(S);
    S in[numbers][Capacity][n], lengths[n], out[fields][n];
    for (int c = 0; c < transfer.channels; ++c) {
      for (int k = 0; k < numbers; ++k) span.data[c].b[k].store(in[k][c]);
    }
    span.length.store(lengths);
    for (int l = 0; l < n; ++l) {
      MultivariateSpan<S, Data<S>, Capacity> one;
      for (int c = 0; c < transfer.channels; ++c) {
        for (int k = 0; k < numbers; ++k) one.data[c].b[k] = in[k][c][l];
      }
      one.length = lengths[l];
      const PanelTables<S> t = measure_tables_of_one(transfer, one, largest_color);
      const S all[fields] = {t.sum.depth,
                             t.sum.color.r,
                             t.sum.color.g,
                             t.sum.color.b,
                             t.sum.range.lower.r,
                             t.sum.range.lower.g,
                             t.sum.range.lower.b,
                             t.sum.range.upper.r,
                             t.sum.range.upper.g,
                             t.sum.range.upper.b,
                             t.most,
                             t.rounding,
                             t.colors,
                             t.changes.first,
                             t.changes.second};
      for (int f = 0; f < fields; ++f) out[f][l] = all[f];
    }
    T field[fields];
    for (int f = 0; f < fields; ++f) field[f] = T::load(out[f]);
    PanelTables<T> tables;
    tables.sum.depth = field[0];
    tables.sum.color = {field[1], field[2], field[3]};
    tables.sum.range = {{field[4], field[5], field[6]}, {field[7], field[8], field[9]}};
    tables.most = field[10];
    tables.rounding = field[11];
    tables.colors = field[12];
    tables.changes = {field[13], field[14]};
    return tables;
  }
}

}  // namespace pellucid::detail
