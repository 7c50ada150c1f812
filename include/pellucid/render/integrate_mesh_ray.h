// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/budget.h"
#include "pellucid/math/solve_monotone.h"
#include "pellucid/render/integrate_linear_span.h"
#include "pellucid/render/multivariate_integrator.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/traverse/mesh_spans.h"

namespace pellucid {

/// A ray through a mesh and its hits of the boundary.
struct MeshRay {
  RayFrame<double> view;
  MeshHit* hits = nullptr;  ///< in ascending order; consumed by the traversal
  int count = 0;

  /// Returns the interval of the ray, in world arc length, outside of which it cannot touch the
  /// mesh; empty without hits.
  PELLUCID_HD Interval<double> extent() const noexcept {
    if (count == 0) return {1, 0};
    return {max(hits[0].t, 0.0), hits[count - 1].t};
  }
};

/// Integrates one ray through one variable of a mesh and accounts for its error. The integral of
/// each span is exact, so the budget is spent on rounding and on early termination only.
class MeshRayIntegrator {
 public:
  /// Keeps references to its arguments. `inside` is the interval in which the ray may be in the
  /// mesh.
  PELLUCID_HD MeshRayIntegrator(const TransferTables& transfer, const RayTolerance& wanted,
                                Interval<double> inside) noexcept
      : transfer_(transfer),
        wanted_(wanted),
        largest_color_(max(wanted.largest_color, 1.0)),
        end_(inside.end),
        budget_(wanted.tolerance, inside.end - inside.begin) {}

  /// Requests the position at which the optical depth reaches `depth`; the ray ends there.
  PELLUCID_HD void set_target_depth(double depth) noexcept { target_ = depth; }
  /// Returns that position in world arc length; infinite if the depth was not reached.
  PELLUCID_HD double target_position() const noexcept { return found_; }

  /// Returns whether the remainder of the ray cannot matter.
  PELLUCID_HD bool done() const noexcept {
    return found_ < infinity ||
           (target_ == infinity && budget_.allows_termination(rest(), wanted_.tolerance));
  }

  /// Integrates the next span, front to back.
  PELLUCID_HD void add_span(const MeshSpan& span) noexcept {
    ++cells_;
    budget_.set_remaining_length(max(end_ - span.begin, 0.0));
    const double length = span.end - span.begin;
    if (span.overlaps) {
      // The overlap and everything behind it are unknown.
      budget_.spend(length, 0, fold_.transparency(), largest_color_);
      return;
    }
    if (span.vacuum) {
      ++counts_.skipped;
      // Its neighbors may begin and end elsewhere.
      const double beside = transfer_.largest_extinction * (span.position_error + span.end_error);
      budget_.spend(length, 0, fold_.transparency(), largest_color_ * min(beside, 1.0));
      return;
    }
    const LinearData data{span.front[0], span.back[0],        span.value_error[0],
                          length,        span.position_error, span.end_error};
    const bool in_float = wanted_.precision == Precision::float32;
    if (in_float) {
      add<float>(data, span.begin);
    } else {
      add<double>(data, span.begin);
    }
  }

  /// Returns the result up to the last span.
  PELLUCID_HD RayResult result() const noexcept {
    RayResult result;
    result.radiance = fold_.radiance();
    result.optical_depth = fold_.optical_depth();
    result.opacity = fold_.opacity();
    // Folding in double costs 4 u a span (segment/compositor.h).
    const double folding = 4 * rounding_unit<double> * largest_color_ * static_cast<double>(cells_);
    result.error = budget_.spent() + (done() ? rest() : 0) + folding;
    result.proved = true;
    result.cells = cells_;
    result.evaluations = cells_;
    result.spans = counts_;
    return result;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Returns an upper bound on the radiance of the remainder.
  PELLUCID_HD double rest() const noexcept {
    return budget_.remainder_bound(fold_.transparency(), transfer_.largest_extinction,
                                   largest_color_);
  }

  template <class T>
  PELLUCID_HD void add(const LinearData& data, double begin) noexcept {
    CellSegment<T> found;
    integrate_linear_span(
        data, transfer_, largest_color_, true, [](double) noexcept { return 0.0; }, found);
    if (found.clear) {
      ++counts_.skipped;
      return;
    }
    ++counts_.closed;
    if (std::is_same_v<T, double>) ++counts_.in_double;
    const double before = fold_.optical_depth();
    budget_.spend(data.length, static_cast<double>(found.found.segment.opacity),
                  fold_.transparency(), found.error(largest_color_));
    fold_.add(found.found.segment);
    if (fold_.optical_depth() >= target_) {
      find(data, begin, target_ - before, fold_.optical_depth() - before);
    }
  }

  /// Finds the position in a span of depth `all` at which its optical depth reaches `depth`.
  PELLUCID_HD void find(const LinearData& data, double begin, double depth, double all) noexcept {
    const auto up_to = [&](double end) noexcept {
      return piecewise_linear_segment(transfer_.wide, data.front,
                                      data.front + end * (data.back - data.front),
                                      end * data.length)
          .optical_depth;
    };
    found_ = begin + solve_monotone(up_to, depth, 0, 1, 0, all) * data.length;
  }

  const TransferTables& transfer_;
  const RayTolerance& wanted_;
  double largest_color_, end_;
  RayBudget<double> budget_;
  FrontToBackCompositor<double> fold_{0.0};
  RuleCounts counts_;
  long cells_ = 0;
  double target_ = infinity, found_ = infinity;
};

namespace detail {

/// Returns the effect of data errors on the tables: an upper bound on the change of the extinction,
/// and of the colors, counted like the extinction that shows them.
template <class Data>
PELLUCID_HD inline double error_through_tables(const MultivariateTransfer<double>& transfer,
                                               const double* value_error,
                                               const Data* data_of) noexcept {
  double sum = 0;
  for (int i = 0; i < transfer.tables; ++i) {
    const int c = transfer.table[i].channel;
    const PiecewiseLinear<double>& table = transfer.table[i].table;
    const double off = value_error[c];
    if (!(off > 0)) continue;
    const CubicBernstein<double> data = as_cubic(data_of[c]);
    const int first = table.interval(data.hull_min() - off),
              last = table.interval(data.hull_max() + off);
    const Sensitivity<double> slopes = sensitivity(table, first, last, off);
    const double change = slopes.extinction_slope + slopes.largest_extinction * slopes.color_slope;
    sum += min(off * change, slopes.largest_extinction);
    if (slopes.jump) sum += jump_rounding(data, table, first, last, off);
  }
  return sum;
}

/// Returns the same for a span.
PELLUCID_HD inline double error_through_tables(const MultivariateTransfer<double>& transfer,
                                               const MeshSpan& span) noexcept {
  LinearBernstein<double> data[max_channels];
  for (int c = 0; c < transfer.channels; ++c) data[c] = {{span.front[c], span.back[c]}};
  return error_through_tables(transfer, span.value_error, data);
}

/// Returns the effect of the errors of the channels' data, beyond the rounding that panels charge
/// themselves, as an upper bound on the change of the extinction: no Gaussian is steeper than
/// √(2/e) times its peak and |K|, the Frobenius norm.
template <class Data>
PELLUCID_HD inline double extinction_error(const MultivariateTransfer<double>& transfer,
                                           const double* value_error, const Data* data) noexcept {
  double moved = 0;
  for (int c = 0; c < transfer.channels; ++c) {
    const double size = max(abs(data[c].hull_min()), abs(data[c].hull_max()));
    const double charged = 8 * rounding_unit<double> * size;
    if (value_error[c] > charged) moved = max(moved, value_error[c]);
  }
  if (!(moved > 0)) return 0;
  double sum = 0;
  for (int i = 0; i < transfer.gaussians.count; ++i) {
    const Gaussian<double>& g = transfer.gaussians.primitive[i];
    double square = 0;
    for (int r = 0; r < g.rows; ++r) {
      for (int k = 0; k < g.channels; ++k) {
        const double off = g.matrix[r][k] * value_error[k];
        square += off * off;
      }
    }
    sum += g.peak * min(0.86 * sqrt(square * static_cast<double>(g.channels)), 1.0);
  }
  return sum + error_through_tables(transfer, value_error, data);
}

/// Returns the same for a span.
PELLUCID_HD inline double extinction_error(const MultivariateTransfer<double>& transfer,
                                           const MeshSpan& span) noexcept {
  LinearBernstein<double> data[max_channels];
  for (int c = 0; c < transfer.channels; ++c) data[c] = {{span.front[c], span.back[c]}};
  return extinction_error(transfer, span.value_error, data);
}

PELLUCID_HD inline void add_span(const MultivariateTransfer<double>& transfer, const MeshSpan& span,
                                 double largest_extinction,
                                 MultivariateRayIntegrator& integrator) noexcept {
  const double length = span.end - span.begin;
  if (span.overlaps || span.vacuum || length == 0) {
    // Overlapping cells make the rest of the ray unknown. Cells next to vacuum, or of length 0, may
    // begin and end elsewhere.
    integrator.charge_opacity(
        span.overlaps ? 1 : largest_extinction * (span.position_error + span.end_error));
    return;
  }
  LinearSpan<double> data;
  data.length = length;
  for (int c = 0; c < transfer.channels; ++c) data.data[c] = {{span.front[c], span.back[c]}};
  integrator.add_stretch(data, {span.begin, span.end}, {},
                         min(extinction_error(transfer, span), largest_extinction),
                         span.position_error + span.end_error);
}

/// Calls visit for the spans of for_each_mesh_span() inside of `range`, the first one cut at its
/// begin.
template <class Visit>
PELLUCID_HD void for_each_span_inside(const Tetrahedra& mesh, const MeshFields& fields,
                                      const MeshRay& ray, Interval<double> range,
                                      Visit&& visit) noexcept {
  for_each_mesh_span(mesh, fields, ray.view, ray.hits, ray.count, [&](const MeshSpan& span) {
    if (span.end <= range.begin) return true;
    if (span.begin >= range.end) return false;
    if (span.begin >= range.begin) return visit(span);
    MeshSpan rest = span;
    const double share = (range.begin - span.begin) / (span.end - span.begin);
    for (int c = 0; c < fields.channels; ++c) {
      rest.front[c] += share * (span.back[c] - span.front[c]);
    }
    rest.begin = range.begin;
    return visit(rest);
  });
}

}  // namespace detail

/// Integrates a ray through a variable of a mesh. RayResult::error is a proved bound: the requested
/// tolerance, or more if rounding requires it. A ray through overlapping cells reports that its
/// error is unknown.
PELLUCID_HD inline RayResult integrate_mesh_ray(const Tetrahedra& mesh, const MeshFields& fields,
                                                const TransferTables& transfer, const MeshRay& ray,
                                                const RayTolerance& wanted) noexcept {
  const Interval<double> inside = ray.extent();
  if (inside.empty()) return missed_ray_result();
  MeshRayIntegrator integrator(transfer, wanted, inside);
  for_each_mesh_span(mesh, fields, ray.view, ray.hits, ray.count, [&](const MeshSpan& span) {
    integrator.add_span(span);
    return !integrator.done();
  });
  return integrator.result();
}

/// Integrates a ray through several variables of a mesh with a function of all of them.
/// `largest_extinction` is an upper bound on the extinction of the function.
PELLUCID_HD inline RayResult integrate_multivariate_mesh_ray(
    const Tetrahedra& mesh, const MeshFields& fields, const MultivariateTransfer<double>& transfer,
    double largest_extinction, const MeshRay& ray, const RayTolerance& wanted) noexcept {
  const Interval<double> inside = ray.extent();
  if (inside.empty()) return missed_ray_result();
  MultivariateRayIntegrator integrator(transfer, largest_extinction, wanted,
                                       inside.end - inside.begin);
  long cells = 0;
  for_each_mesh_span(mesh, fields, ray.view, ray.hits, ray.count, [&](const MeshSpan& span) {
    ++cells;
    integrator.set_remaining_length(max(inside.end - span.begin, 0.0));
    detail::add_span(transfer, span, largest_extinction, integrator);
    integrator.set_remaining_length(max(inside.end - span.end, 0.0));
    return !integrator.done();
  });
  RayResult result = integrator.result();
  result.cells = cells;
  return result;
}

/// Returns RayResult::half_opacity_depth of a ray with this opacity. If the given opacities differ
/// slightly from those of the ray, the result is at worst an end of the interval.
PELLUCID_HD inline double find_mesh_half_opacity(const Tetrahedra& mesh, const MeshFields& fields,
                                                 const TransferTables& transfer, const MeshRay& ray,
                                                 const RayTolerance& wanted, double opacity,
                                                 const HalfOpacity& half) noexcept {
  const Interval<double> inside = ray.extent();
  if (!(opacity > 0) || inside.empty()) return std::numeric_limits<double>::infinity();
  MeshRayIntegrator integrator(transfer, wanted, inside);
  integrator.set_target_depth(half.depth_to_half(opacity));
  detail::for_each_span_inside(mesh, fields, ray, half.range, [&](const MeshSpan& span) {
    integrator.add_span(span);
    return !integrator.done();
  });
  return min(integrator.target_position(), half.range.end);
}

/// Returns the same for several variables of a mesh.
PELLUCID_HD inline double find_multivariate_mesh_half_opacity(
    const Tetrahedra& mesh, const MeshFields& fields, const MultivariateTransfer<double>& transfer,
    double largest_extinction, const MeshRay& ray, const RayTolerance& wanted, double opacity,
    const HalfOpacity& half) noexcept {
  const Interval<double> inside = ray.extent();
  if (!(opacity > 0) || inside.empty()) return std::numeric_limits<double>::infinity();
  MultivariateRayIntegrator integrator(transfer, largest_extinction, wanted,
                                       inside.end - inside.begin);
  integrator.set_target_depth(half.depth_to_half(opacity));
  detail::for_each_span_inside(mesh, fields, ray, half.range, [&](const MeshSpan& span) {
    detail::add_span(transfer, span, largest_extinction, integrator);
    return !integrator.done();
  });
  return min(integrator.target_position(), half.range.end);
}

}  // namespace pellucid
