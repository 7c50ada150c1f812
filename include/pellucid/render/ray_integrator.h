// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/device_call.h"
#include "pellucid/error/budget.h"
#include "pellucid/field/sample.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/segment/stride.h"
#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/curvature_bounds.h"
#include "pellucid/traverse/spans.h"

namespace pellucid {

/// Integrates one ray within a tolerance: it uses, for each span, the cheapest rule whose error is
/// within budget, and accounts for the errors.
///
/// With SingleOnly it gives up a ray at the first cell for which binary32 is not accurate enough:
/// needs_double(). Until then it does what it does without, so that a ray that is not given up has
/// the very same result.
template <class Value, bool SingleOnly = false>
class RayIntegrator {
 public:
  /// Keeps references to its arguments, which must outlive the integrator. `length` is the length
  /// of the ray inside the grid, in world units.
  PELLUCID_HD RayIntegrator(const StructuredGrid<Value, double>& grid, const Ray<double>& ray_grid,
                            const TransferTables& transfer, const RayTolerance& wanted,
                            double length) noexcept
      : grid_(grid),
        ray_(ray_grid),
        transfer_(transfer),
        wanted_(wanted),
        largest_color_(max(wanted.largest_color, 1.0)),
        budget_(wanted.tolerance, length) {}

  /// Returns whether the remainder of the ray cannot matter.
  PELLUCID_HD bool done() const noexcept {
    return needs_double_ || budget_.allows_termination(rest(), wanted_.tolerance);
  }
  /// Returns whether the ray was given up: its result says nothing.
  PELLUCID_HD bool needs_double() const noexcept { return needs_double_; }

  /// Skips a transparent span.
  PELLUCID_HD void skip(double length) noexcept {
    ++counts_.skipped;
    budget_.spend(length, 0, fold_.transparency(), 0);
  }

  /// Integrates a block of this kind, or a cube of such blocks, at once. Returns false if its cells
  /// have to be integrated one by one. `lower` is the lower end of the block's range.
  PELLUCID_HD bool try_block(BlockKind kind, double lower, const BlockStep& step) noexcept {
    const double length = step.t_end - step.t_begin;
    if (kind == BlockKind::skip) {
      skip(length);
      return true;
    }
    if (kind != BlockKind::constant) return false;
    ++counts_.constant;
    const Material<double> material = transfer_.wide.evaluate(lower);
    BoundedSegment<double> segment{constant_segment(material.extinction, material.color, length)};
    // The length is accurate to a few u of the arc length.
    const double place = 8 * rounding_unit<double> * step.t_end * material.extinction;
    add(segment, length, segment.segment.opacity,
        largest_color_ * (32 * rounding_unit<double> * segment.segment.opacity + min(place, 1.0)));
    return true;
  }

  /// Integrates one cell of a walk over the grid.
  PELLUCID_HD void add_cell(const StructuredWalk<double>::Step& step) noexcept {
    ++evaluations_;
    if (wanted_.precision == Precision::float64 ||
        (wanted_.grade == Grade::proved && wanted_.precision == Precision::automatic)) {
      in_double(step);
      return;
    }
    if (cell_in<float>(step, wanted_.precision == Precision::float32)) return;
    ++counts_.in_double;
    in_double(step);
  }

  /// Returns whether strides through a block may be within tolerance, assuming that the transfer
  /// function is everywhere as steep as anywhere in the block's range. `variation` bounds the
  /// variation of the data's derivative on half of a stride of this `length`.
  ///
  /// Estimates are used only if no cell has more than half of the second difference of the block:
  /// for waves of seven cells and longer, but not for noise, whose second differences three samples
  /// do not show.
  PELLUCID_HD bool is_smooth(const BlockClass& block, const BlockRange& range,
                             const CurvatureBounds& curvature, double variation,
                             double length) noexcept {
    if (!block.absorbs_in_cells()) return false;
    const double deviation = 0.5 * bend_deviation(variation, 0.5 * length);
    const double bound = length * deviation * static_cast<double>(from_upper_half(block.roughness));
    double guard = 1;
    if (wanted_.grade == Grade::estimated) {
      double jump = 0;
      for (int a = 0; a < 3; ++a) {
        jump += abs(ray_.direction[a]) * static_cast<double>(curvature.second_difference[a]);
      }
      if (2 * jump <= derivative_oscillation(range, ray_.direction)) guard = stride_guard<double>;
    }
    return bound <= guard * budget_.allowance(length, 0, fold_.transparency());
  }

  /// Integrates a stride from t_begin, where the data are `front`, through blocks whose derivative
  /// varies by at most `variation` on either half. Returns false if it is not within budget. `back`
  /// receives the data at its end.
  PELLUCID_HD PELLUCID_DEVICE_CALL bool try_stride(double t_begin, double length, double variation,
                                                   double front, double& back) noexcept {
    const double middle = sample(t_begin + 0.5 * length);
    back = sample(t_begin + length);  // NaN on a plane that vacuum begins at: no stride
    // The samples themselves are rounded.
    const double rounding =
        64 * rounding_unit<double> * max(abs(front), max(abs(middle), abs(back)));
    BoundedSegment<double> found;
    const bool good = integrate_stride(
        Stride<double>{front, middle, back, length,
                       bend_deviation(variation, 0.5 * length) + rounding},
        transfer_.wide, transfer_.wide_antiderivative, largest_color_, wanted_.grade,
        [&](double opacity) { return budget_.allowance(length, opacity, fold_.transparency()); },
        found);
    if (!good) return false;
    ++counts_.strides;
    add(found, length, found.segment.opacity,
        64 * rounding_unit<double> * found.segment.opacity * largest_color_);
    return true;
  }

  /// Returns the data at a position of the ray.
  PELLUCID_HD PELLUCID_DEVICE_CALL double sample(double t) noexcept {
    ++evaluations_;
    return sample_value<double>(grid_, ray_.at(t));
  }

  /// Returns the result up to the last span.
  PELLUCID_HD RayResult result() const noexcept {
    RayResult result;
    result.radiance = fold_.radiance();
    result.optical_depth = fold_.optical_depth();
    result.opacity = fold_.opacity();
    // Folding in double costs 4 u a span (segment/compositor.h).
    const double folding =
        4 * rounding_unit<double> * largest_color_ * static_cast<double>(evaluations_);
    result.error = budget_.spent() + rest() + folding;
    result.proved = proved_;
    result.evaluations = evaluations_;
    result.spans = counts_;
    return result;
  }

 private:
  /// Returns an upper bound on the radiance of the remainder.
  PELLUCID_HD double rest() const noexcept {
    return budget_.remainder_bound(fold_.transparency(), transfer_.largest_extinction,
                                   largest_color_);
  }

  /// Composites a span and charges its error. `opacity` is the one for which the allowance was
  /// computed.
  template <class T>
  PELLUCID_HD void add(const BoundedSegment<T>& span, double length, double opacity,
                       double rounding) noexcept {
    const double error = static_cast<double>(span.color_error) +
                         largest_color_ * static_cast<double>(span.opacity_error) + rounding;
    budget_.spend(length, opacity, fold_.transparency(), error);
    fold_.add(span.segment);
    proved_ = proved_ && span.proved;
  }

  /// Integrates the cell in double, or gives up the ray.
  PELLUCID_HD void in_double(const StructuredWalk<double>::Step& step) noexcept {
    if constexpr (SingleOnly) {
      needs_double_ = true;
    } else {
      cell_in<double>(step, true);
    }
  }

  /// Integrates the cell in T. Unless `forced`, returns false if T's rounding would take more than
  /// a quarter of the span's allowance.
  template <class T>
  PELLUCID_HD PELLUCID_DEVICE_CALL bool cell_in(const StructuredWalk<double>::Step& step,
                                                bool forced) noexcept {
    const double world_length = step.t_end - step.t_begin;
    CubicSpan<T> span;
    if (!make_span(grid_, step, span)) {  // vacuum
      skip(world_length);
      return true;
    }
    // The positions at which the ray meets the planes are accurate to a few u of its arc length.
    const double position_error = 8 * rounding_unit<double> * step.t_end;
    CellSegment<T> found;
    if (!integrate_cell(
            span.data, span.length(), position_error, transfer_, wanted_, forced,
            [&](double opacity) {
              return budget_.allowance(world_length, opacity, fold_.transparency());
            },
            found)) {
      return false;
    }
    if (found.clear) {
      skip(world_length);
      return true;
    }
    ++(found.line ? counts_.lines : found.found.panels ? counts_.panels : counts_.closed);
    add(found.found, world_length, found.opacity, found.rounding);
    return true;
  }

  const StructuredGrid<Value, double>& grid_;
  const Ray<double>& ray_;
  const TransferTables& transfer_;
  const RayTolerance& wanted_;
  double largest_color_;
  RayBudget<double> budget_;
  FrontToBackCompositor<double> fold_{0.0};
  RuleCounts counts_;
  long evaluations_ = 0;
  bool proved_ = true, needs_double_ = false;
};

}  // namespace pellucid
