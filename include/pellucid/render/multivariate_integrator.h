// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/device_call.h"
#include "pellucid/error/budget.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/math/solve_monotone.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/segment/multivariate_panel.h"

namespace pellucid {

/// Integrates one ray through several fields within a tolerance. It cuts each cell until every
/// panel is within budget, and accounts for the errors. In double throughout.
class MultivariateRayIntegrator {
 public:
  /// Keeps references to its arguments, which must outlive the integrator. `length` is the length
  /// of the ray inside the grid, in world units.
  PELLUCID_HD MultivariateRayIntegrator(const MultivariateTransfer<double>& transfer,
                                        double largest_extinction, const RayTolerance& wanted,
                                        double length) noexcept
      : transfer_(&transfer),
        largest_extinction_(largest_extinction),
        tolerance_(wanted.tolerance),
        length_(length),
        budget_(wanted.tolerance, length) {
    demand_.grade = wanted.grade;
    demand_.largest_color = max(wanted.largest_color, 1.0);
  }

  /// Uses another function for the spans from here on. `largest_extinction` of the constructor must
  /// bound all of them.
  PELLUCID_HD void set_transfer(const MultivariateTransfer<double>& transfer) noexcept {
    transfer_ = &transfer;
  }

  /// Requests the position at which the optical depth reaches `depth`; the ray ends there.
  PELLUCID_HD void set_target_depth(double depth) noexcept { target_ = depth; }
  /// Returns that position in world arc length; infinite if the depth was not reached.
  PELLUCID_HD double target_position() const noexcept { return found_; }

  /// Returns whether the remainder of the ray cannot matter.
  PELLUCID_HD bool done() const noexcept {
    return found_ < infinity ||
           (target_ == infinity && budget_.allows_termination(rest(), tolerance_));
  }

  /// Skips empty spans: sets the remaining length of the ray.
  PELLUCID_HD void set_remaining_length(double remaining_length) noexcept {
    budget_.set_remaining_length(remaining_length);
  }

  /// Charges the budget for an unknown opacity of at most `opacity` at a point of the ray.
  PELLUCID_HD void charge_opacity(double opacity) noexcept {
    ++counts_.skipped;
    budget_.spend(0, 0, fold_.transparency(), demand_.largest_color * min(opacity, 1.0));
  }

  /// Skips a span with an extinction of at most `extinction`, and charges the budget for it.
  PELLUCID_HD void skip(double length, double extinction) noexcept {
    ++counts_.skipped;
    budget_.spend(length, 0, fold_.transparency(),
                  demand_.largest_color * min(extinction * length, 1.0));
  }

  /// Integrates a span on which all channels are cubic, or linear; cuts it until it is within
  /// budget. `range` is its interval on the ray in world arc length. `left_out` is an upper bound
  /// on the ignored extinction, above all of primitives outside of the set. `position_error` bounds
  /// the error of its ends.
  template <class Span>
  PELLUCID_HD void add_stretch(const Span& span, Interval<double> range, PrimitiveSet primitives,
                               double left_out, double position_error) noexcept {
    demand_.primitives = primitives;
    add_panels(SpanPanels<Span>{*transfer_, span, most_span_panels()}, range, left_out,
               position_error);
  }

  /// Adds the panels of any stretch. It has a length() in world units, panel(begin, end, demand,
  /// allowance): the PanelSegment of a part, or where to cut it, and most_panels(): of a ray, after
  /// which the tolerance is not proved any more. Estimates then decide where to cut, and errors are
  /// still charged with what is proved: to 1e-3, for half as many panels again. After twice as
  /// many, or at once in the grade `estimated`, parts are taken as they come, whatever their error.
  template <class Stretch>
  PELLUCID_HD PELLUCID_DEVICE_CALL void add_panels(const Stretch& stretch, Interval<double> range,
                                                   double left_out,
                                                   double position_error) noexcept {
    ++evaluations_;
    // The parts still to do, by their ends, the nearest last.
    double ends[max_cuts + 1];
    int open = 1;
    ends[0] = 1;
    double begin = 0;
    while (open > 0) {
      const double end = ends[open - 1];
      // If the span's length changes, inner cuts move in proportion.
      demand_.position_error =
          begin > 0 && end < 1 ? (end - begin) * position_error : position_error;
      const bool many = panels_ > stretch.most_panels(), proved = demand_.grade == Grade::proved;
      demand_.estimate_suffices = proved && many;
      demand_.last_resort = open > max_cuts || !(end - begin > 1e-9) || (!proved && many) ||
                            panels_ / 2 > stretch.most_panels();
      const PanelSegment<double> panel = integrate(stretch, begin, end, left_out);
      if (!panel.done) {
        const double cut = begin + panel.cut * (end - begin);
        if (cut > begin && cut < end) {
          ends[open++] = cut;
        } else {
          ends[open++] = 0.5 * (begin + end);
        }
        continue;
      }
      if (fold_.optical_depth() >= target_) find(stretch, begin, end, range);
      begin = end;
      --open;
      if (done()) return;
    }
  }

  /// Puts a surface over what is behind it, at the position t. `color`: its radiance if it were
  /// opaque. `error`: of its opacity, and of opacity · color, together relative to the largest
  /// color.
  PELLUCID_HD void add_surface(double opacity, const Rgb<double>& color, double error,
                               double t) noexcept {
    budget_.spend(0, opacity, fold_.transparency(), demand_.largest_color * min(error, 1.0));
    SegmentResult<double> surface;
    surface.opacity = opacity;
    surface.transparency = 1 - opacity;
    surface.optical_depth = opacity < 1 ? -log1p(-opacity) : infinity;
    surface.radiance = opacity * color;
    fold_.add(surface);
    ++panels_;
    if (fold_.optical_depth() >= target_ && found_ == infinity) found_ = t;
  }

  /// Returns the transparency in front of what comes next.
  PELLUCID_HD double transparency() const noexcept { return fold_.transparency(); }
  /// Charges the budget for an unknown opacity that is seen through `transparency`.
  PELLUCID_HD void charge_opacity_behind(double transparency, double opacity) noexcept {
    budget_.spend(0, 0, transparency, demand_.largest_color * min(opacity, 1.0));
  }

  /// Returns the result up to the last span.
  PELLUCID_HD RayResult result() const noexcept {
    RayResult result;
    result.radiance = fold_.radiance();
    result.optical_depth = fold_.optical_depth();
    result.opacity = fold_.opacity();
    // Folding in double costs 4 u a span (segment/compositor.h).
    const double folding =
        4 * rounding_unit<double> * demand_.largest_color * static_cast<double>(panels_);
    result.error = budget_.spent() + rest() + folding;
    result.proved = proved_;
    result.evaluations = evaluations_;
    result.spans = counts_;
    return result;
  }

 private:
  static constexpr int max_cuts = 60;
  /// Tolerance that is proved of a ray where its own cannot be.
  static constexpr double coarse_tolerance = 1e-3;

  /// Error that a panel may use.
  struct Allowance {
    const RayBudget<double>& budget;
    double length, transparency, least;
    double proved;  ///< the largest bound, where estimates decide

    PELLUCID_HD double operator()(double opacity) const noexcept {
      return max(budget.allowance(length, opacity, transparency), least);
    }
  };
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Returns an upper bound on the radiance of the remainder.
  PELLUCID_HD double rest() const noexcept {
    return budget_.remainder_bound(fold_.transparency(), largest_extinction_,
                                   demand_.largest_color);
  }

  /// Returns after how many panels without light a ray gives up its tolerance: rounding alone may
  /// take more than the budget has, of data and colors near the ends of numbers. That takes some
  /// 0.1 s. Tolerances that no picture has are not given up.
  PELLUCID_HD long most_span_panels() const noexcept {
    return tolerance_ < 1e-8 ? std::numeric_limits<long>::max() : 1 << 16;
  }

  /// Panels of several variables along a span.
  template <class Span>
  struct SpanPanels {
    const MultivariateTransfer<double>& transfer;
    const Span& span;
    long most;

    PELLUCID_HD double length() const noexcept { return span.length; }
    PELLUCID_HD long most_panels() const noexcept { return most; }
    template <class Allowance>
    PELLUCID_HD PELLUCID_DEVICE_CALL PanelSegment<double> panel(
        double begin, double end, const PanelDemand<double>& demand,
        const Allowance& allowance) const noexcept {
      if (!(begin > 0 || end < 1)) {
        return integrate_multivariate_panel(transfer, span, demand, allowance);
      }
      return integrate_multivariate_panel(transfer, span.part(transfer.channels, begin, end),
                                          demand, allowance);
    }
  };

  template <class Stretch>
  PELLUCID_HD PanelSegment<double> integrate(const Stretch& stretch, double begin, double end,
                                             double left_out) noexcept {
    const double length =
        begin > 0 || end < 1 ? (end - begin) * stretch.length() : stretch.length();
    // Errors that are proved may have used up the budget where estimates decide.
    const double share = length / length_;
    const double least = demand_.estimate_suffices
                             ? 0.5 * tolerance_ * share
                             : RayBudget<double>::minimum_allowance(tolerance_, share);
    const double proved = panels_ - stretch.most_panels() < stretch.most_panels() / 2
                              ? coarse_tolerance * share
                              : infinity;
    const Allowance allowance{budget_, length, fold_.transparency(), least, proved};
    const PanelSegment<double> panel = stretch.panel(begin, end, demand_, allowance);
    if (!panel.done) return panel;
    ++panels_;
    const double error =
        panel.error(demand_.largest_color) + demand_.largest_color * min(left_out * length, 1.0);
    budget_.spend(length, panel.opacity, fold_.transparency(), error);
    before_ = fold_.optical_depth();
    if (!(panel.found.segment.optical_depth > 0)) {
      ++counts_.skipped;
      return panel;
    }
    ++(panel.found.panels ? counts_.panels : counts_.lines);
    fold_.add(panel.found.segment);
    proved_ = proved_ && panel.found.proved;
    return panel;
  }

  /// Finds the position in the part [begin, end] of a stretch at which the depth reaches the
  /// target. It uses the depths of lines, which are within the tolerance there.
  template <class Stretch>
  PELLUCID_HD void find(const Stretch& stretch, double begin, double end,
                        Interval<double> range) noexcept {
    PanelDemand<double> demand = demand_;
    demand.last_resort = true;
    demand.estimate_suffices = false;
    demand.grade = Grade::proved;
    const auto nothing = [](double) noexcept { return 0.0; };
    const auto inside = [&](double to) noexcept {
      return stretch.panel(begin, to, demand, nothing).found.segment.optical_depth;
    };
    const double at =
        solve_monotone(inside, target_ - before_, begin, end, 0.0, fold_.optical_depth() - before_);
    found_ = range.begin + at * (range.end - range.begin);
  }

  const MultivariateTransfer<double>* transfer_;
  double largest_extinction_;
  double tolerance_, length_;
  PanelDemand<double> demand_;
  RayBudget<double> budget_;
  FrontToBackCompositor<double> fold_{0.0};
  RuleCounts counts_;
  long evaluations_ = 0, panels_ = 0;
  bool proved_ = true;
  double before_ = 0;  ///< the optical depth in front of the last panel
  double target_ = infinity, found_ = infinity;
};

}  // namespace pellucid
