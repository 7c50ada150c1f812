// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "evaluate.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/segment/gaussian_panels.h"
#include "pellucid/segment/gaussian_step.h"

namespace pellucid::cli {

namespace {

/// One to eight numbers at each end, front first.
template <class T>
struct Ends {
  T v1[max_channels]{}, v2[max_channels]{};
  std::size_t channels = 0;
};

template <class T>
Ends<T> ends_of(const CsvTable& table, std::size_t row, std::size_t front, std::size_t back) {
  const std::vector<T> v1 = table.list<T>(row, front);
  const std::vector<T> v2 = list_of<T>(table, row, back, v1.size());
  if (v1.empty() || v1.size() > max_channels) {
    throw Error(fmt::format("{}, column '{}': {} numbers; expected 1 to {}, one for each channel",
                            table.where(row), table.columns()[front], v1.size(), max_channels));
  }
  Ends<T> ends;
  ends.channels = v1.size();
  std::copy(v1.begin(), v1.end(), ends.v1);
  std::copy(v2.begin(), v2.end(), ends.v2);
  return ends;
}

/// Returns a primitive of all channels, checked; K by rows. `what` is for messages.
template <class T>
Gaussian<T> primitive_of(const std::string& what, const Ends<T>& ends, const std::vector<T>& matrix,
                         const std::vector<T>& center, T peak, Rgb<T> color) {
  const std::size_t n = ends.channels;
  if (center.size() != n) {
    throw Error(fmt::format("{}: c has {} numbers where v1 has {}", what, center.size(), n));
  }
  if (matrix.empty() || matrix.size() % n != 0 || matrix.size() > n * max_channels) {
    throw Error(fmt::format("{}: K has {} numbers; expected 1 to {} rows of {}", what,
                            matrix.size(), max_channels, n));
  }
  GaussianPrimitive checked;
  Gaussian<T> g;
  g.channels = static_cast<int>(n);
  g.rows = static_cast<int>(matrix.size() / n);
  g.peak = peak;
  g.color = color;
  for (std::size_t c = 0; c < n; ++c) {
    checked.channels.push_back(static_cast<int>(c));
    checked.center.push_back(wide(center[c]));
    g.center[c] = center[c];
  }
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    g.matrix[i / n][i % n] = matrix[i];
    if (i % n == 0) checked.matrix.emplace_back();
    checked.matrix.back().push_back(wide(matrix[i]));
  }
  checked.extinction = wide(peak);
  checked.color = {wide(color.r), wide(color.g), wide(color.b)};
  try {
    const MultivariateTransferFunction function(g.channels, {std::move(checked)});
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", what, error.what()));
  }
  T p[2][max_channels];
  g.transform(ends.v1, p[0]);
  g.transform(ends.v2, p[1]);
  for (int i = 0; i < g.rows; ++i) {
    if (!std::isfinite(p[0][i]) || !std::isfinite(p[1][i])) {
      throw Error(fmt::format("{}: K (v - c) is out of the range of {}", what,
                              is_single<T> ? "float; use double" : "double"));
    }
  }
  return g;
}

template <class T>
void check_depth(const std::string& what, T peak, T length) {
  if (std::isfinite(peak * length)) return;
  throw Error(fmt::format("{}: tau times length is out of the range of {}", what,
                          is_single<T> ? "float; use double" : "double"));
}

/// Returns the function of a sum; one of one primitive is computed by the same kernels as one of
/// many.
template <class T>
MultivariateTransfer<T> transfer_of(const std::vector<Gaussian<T>>& primitives,
                                    std::size_t channels) {
  MultivariateTransfer<T> transfer;
  transfer.gaussians = {primitives.data(), static_cast<int>(primitives.size())};
  transfer.channels = static_cast<int>(channels);
  return transfer;
}

template <class T, GaussianRule rule>
void segment_row(const CsvTable& table, const std::vector<std::size_t>& columns, std::size_t row,
                 double /*tolerance*/, std::vector<double>& outputs) {
  const Ends<T> ends = ends_of<T>(table, row, columns[2], columns[3]);
  const T peak = non_negative<T>(table, row, columns[4]);
  const T length = non_negative<T>(table, row, columns[5]);
  const std::string what = table.where(row);
  check_depth(what, peak, length);
  const Gaussian<T> g = primitive_of<T>(what, ends, table.list<T>(row, columns[0]),
                                        table.list<T>(row, columns[1]), peak, {});
  const SegmentResult<T> s =
      mean_color_segment(rule, transfer_of<T>({g}, ends.channels), ends.v1, ends.v2, length);
  outputs = {wide(mean_density(rule, g, ends.v1, ends.v2)), wide(s.optical_depth), wide(s.opacity)};
}

/// Returns the sum's primitives.
template <class T>
std::vector<Gaussian<T>> mixture_of(const CsvTable& table, const std::vector<std::size_t>& columns,
                                    std::size_t row, const Ends<T>& ends, T length) {
  const auto matrix = table.lists<T>(row, columns[0]), center = table.lists<T>(row, columns[1]),
             color = table.lists<T>(row, columns[3]);
  const std::vector<T> peak = list_of<T>(table, row, columns[2], matrix.size());
  if (matrix.empty() || center.size() != matrix.size() || color.size() != matrix.size()) {
    throw Error(
        fmt::format("{}: {} lists in K, {} in c and {} in colour; expected one for each "
                    "primitive, separated by '|'",
                    table.where(row), matrix.size(), center.size(), color.size()));
  }
  std::vector<Gaussian<T>> primitives;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    const std::string what = fmt::format("{}, primitive {}", table.where(row), i);
    if (color[i].size() != 3) {
      throw Error(
          fmt::format("{}: colour has {} numbers where 3 are expected", what, color[i].size()));
    }
    check_depth(what, peak[i], length);
    primitives.push_back(primitive_of<T>(what, ends, matrix[i], center[i], peak[i],
                                         {color[i][0], color[i][1], color[i][2]}));
  }
  return primitives;
}

template <class T>
void write_segment(const SegmentResult<T>& s, std::vector<double>& outputs) {
  outputs = {wide(s.optical_depth), wide(s.opacity), wide(s.radiance.r), wide(s.radiance.g),
             wide(s.radiance.b)};
}

template <class T>
void mixture_row(const CsvTable& table, const std::vector<std::size_t>& columns, std::size_t row,
                 double tolerance, std::vector<double>& outputs) {
  const Ends<T> ends = ends_of<T>(table, row, columns[4], columns[5]);
  const T length = non_negative<T>(table, row, columns[6]);
  const auto primitives = mixture_of<T>(table, columns, row, ends, length);
  const auto transfer = transfer_of(primitives, ends.channels);
  write_segment(integrate_gaussians(transfer.gaussians, ends.v1, ends.v2, length,
                                    static_cast<T>(tolerance), Grade::estimated)
                    .segment,
                outputs);
}

template <class T>
void mixture_kniss_row(const CsvTable& table, const std::vector<std::size_t>& columns,
                       std::size_t row, double /*tolerance*/, std::vector<double>& outputs) {
  const Ends<T> ends = ends_of<T>(table, row, columns[4], columns[5]);
  const T length = non_negative<T>(table, row, columns[6]);
  const auto primitives = mixture_of<T>(table, columns, row, ends, length);
  write_segment(mean_color_segment(GaussianRule::kniss, transfer_of(primitives, ends.channels),
                                   ends.v1, ends.v2, length),
                outputs);
}

template <GaussianRule rule>
EvaluateKind segment_kind(std::string_view name) {
  return {name,
          {"K", "c", "v1", "v2", "tau", "length"},
          {"mean_density", "optical_depth", "opacity"},
          segment_row<float, rule>,
          segment_row<double, rule>};
}

const std::vector<std::string_view> mixture_inputs{"K", "c", "tau", "colour", "v1", "v2", "length"};
const std::vector<std::string_view> mixture_outputs{"optical_depth", "opacity", "radiance_r",
                                                    "radiance_g", "radiance_b"};

}  // namespace

EvaluateKind gaussian_segment_kind() {
  return segment_kind<GaussianRule::closed_form>("gaussian_segment");
}
EvaluateKind gaussian_segment_kniss_kind() {
  return segment_kind<GaussianRule::kniss>("gaussian_segment_kniss");
}
EvaluateKind gaussian_mixture_segment_kind() {
  return {"gaussian_mixture_segment", mixture_inputs,      mixture_outputs,
          mixture_row<float>,         mixture_row<double>, true};
}
EvaluateKind gaussian_mixture_segment_kniss_kind() {
  return {"gaussian_mixture_segment_kniss", mixture_inputs, mixture_outputs,
          mixture_kniss_row<float>, mixture_kniss_row<double>};
}

}  // namespace pellucid::cli
