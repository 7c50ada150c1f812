// SPDX-License-Identifier: Apache-2.0
#include "import_shaped.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "chord_fit.h"
#include "import_paths.h"
#include "import_ways.h"
#include "pellucid/scene/error.h"

namespace pellucid::imported {
namespace {

/// Limit of data, but for the last of them: positions of nodes that are farther away are these.
constexpr double farthest = 2e37;
/// Relative rounding of the ends of intervals, and of VTK's own arithmetic.
constexpr double rounding_of_vtk = 1e-13;
/// Points of one function. What is finer is fitted more coarsely, and told.
constexpr std::size_t max_points = 200'000;
/// Places at which a curve is compared with VTK's own function.
constexpr std::size_t compared_places = 256;

ColorSpace space_of(const ShapedFunction& function) {
  switch (function.space) {
    case 0:
      return ColorSpace::rgb;
    case 1:
      return function.wraps_hue ? ColorSpace::hsv : ColorSpace::hsv_without_wrap;
    case 2:
      return ColorSpace::lab;
    case 3:
      return ColorSpace::diverging;
    case 4:
      return ColorSpace::way;
    case 5:
      return ColorSpace::step;
    default:
      throw Error("colors: the color space " + std::to_string(function.space) +
                  " of this VTK is not known; take RGB, HSV, Lab, CIEDE2000, Diverging or Step");
  }
}

/// Returns whether a straight way in Lab passes a place where vtkMath's branches do not meet.
bool may_change_branch(const Rgb<double>& from, const Rgb<double>& to) {
  const auto branches = [](const Rgb<double>& color) {
    const auto [l, a, b] = lab_of(triple(color));
    const double y = (l + 16) / 116, threshold = std::cbrt(0.008856);
    return std::array{a / 500 + y > threshold, y > threshold, y - b / 200 > threshold};
  };
  return branches(from) != branches(to);
}

/// Makes a FittedCurve of a ShapedFunction.
class Fitter {
 public:
  Fitter(const ShapedFunction& function, double deviation, const SampleWay& sample_way)
      : given_(function), deviation_(deviation), sample_way_(sample_way) {}

  FittedCurve fitted() {
    if (given_.nodes.empty()) return {{{0, {0, 0, 0}}}, 0};
    space_ = given_.is_color ? space_of(given_) : ColorSpace::rgb;
    // VTK's colors leave the logarithm out where the nodes begin at 0 or below.
    is_logarithmic_ = given_.is_logarithmic && !(given_.is_color && given_.nodes.front().x <= 0);
    cut();
    if (is_straight_) {
      for (const Stretch& stretch : stretches_) push({stretch.node.x, stretch.node.y});
    } else {
      fit_chords();
    }
    add_ends();
    return std::move(made_);
  }

 private:
  /// A node and the way to the next one.
  struct Stretch {
    ShapedNode node;
    bool is_straight = true, is_logarithmic = false;
  };

  bool is_jump(const ShapedNode& node) const { return given_.jumps && node.sharpness > 0.99; }

  /// Splits the stretches at jumps, and straight ones where they enter and leave the limits.
  void cut() {
    for (std::size_t i = 0; i < given_.nodes.size(); ++i) {
      ShapedNode from = given_.nodes[i];
      from.x = std::clamp(from.x, -farthest, farthest);
      if (i + 1 == given_.nodes.size()) {
        add({{from.x, from.y}});
        break;
      }
      ShapedNode to = given_.nodes[i + 1];
      to.x = std::clamp(to.x, -farthest, farthest);
      add_stretch(from, to);
    }
    for (const Stretch& stretch : stretches_) is_straight_ = is_straight_ && stretch.is_straight;
  }

  void add_stretch(const ShapedNode& from, const ShapedNode& to) {
    bool logarithmic = is_logarithmic_ && from.x < to.x;
    if (logarithmic && !(from.x > 0)) {
      logarithmic = false;
      made_.has_no_number = true;
    }
    const double middle =
        place_at(std::clamp(from.midpoint, 0.00001, 0.99999), from.x, to.x, logarithmic);
    if (is_jump(from)) {
      add_lines({{from.x, from.y}, {middle, from.y}, {middle, to.y}}, to);
    } else if (space_ == ColorSpace::step) {
      add_lines({{from.x, from.y}, {from.x, to.y}}, to);
    } else if (space_ == ColorSpace::rgb && !logarithmic && from.sharpness < 0.01) {
      if (from.midpoint == 0.5) {
        add_lines({{from.x, from.y}}, to);
      } else {
        add_lines({{from.x, from.y}, {middle, 0.5 * (from.y + to.y)}}, to);
      }
    } else if (from.x == to.x) {
      add({{from.x, from.y}});
    } else {
      // Cut on its way, and not at its ends.
      stretches_.push_back({from, false, logarithmic});
      stretches_.push_back({{to.x, to.y}});
    }
  }

  /// Adds straight lines through points, up to but without `to`.
  void add_lines(std::vector<CurvePoint> points, const ShapedNode& to) {
    points.push_back({to.x, to.y});
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      add({{points[i].x, points[i].y}});
      add_crossings(points[i], points[i + 1]);
    }
  }

  void add_crossings(const CurvePoint& a, const CurvePoint& b) {
    const double start[] = {a.y.r, a.y.g, a.y.b}, end[] = {b.y.r, b.y.g, b.y.b};
    std::vector<double> shares;
    for (int c = 0; c < 3; ++c) {
      for (const double limit : {0.0, given_.largest}) {
        if ((start[c] - limit) * (end[c] - limit) < 0 && std::isfinite(limit)) {
          shares.push_back((limit - start[c]) / (end[c] - start[c]));
        }
      }
    }
    std::sort(shares.begin(), shares.end());
    for (const double share : shares) {
      const double x = a.x + share * (b.x - a.x);
      if (x > stretches_.back().node.x && x < b.x) add({{x, a.y + share * (b.y - a.y)}});
    }
  }

  /// Adds the begin of a straight stretch, its color cut.
  void add(Stretch stretch) {
    stretch.node.y = within(stretch.node.y);
    stretches_.push_back(stretch);
  }
  Rgb<double> within(const Rgb<double>& y) const {
    const auto part = [&](double x) { return std::clamp(x, 0.0, given_.largest); };
    return {part(y.r), part(y.g), part(y.b)};
  }

  void fit_chords() {
    Function function;
    function.format = given_.is_color ? "colors" : "opacities";
    function.numbers = ColorEncoding::linear;
    function.space = space_;
    function.largest_color = function.largest_opacity = given_.largest;
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      const auto& [node, straight, logarithmic] = stretches_[i];
      const double sharpness = straight ? 0 : node.sharpness;
      const double midpoint = straight ? 0.5 : node.midpoint;
      if (given_.is_color) {
        function.colors.push_back({node.x, node.y, midpoint, sharpness, logarithmic});
        if (straight || i + 1 == stretches_.size()) continue;
        add_way(stretches_[i + 1].node, function.colors.back());
      } else {
        function.opacities.push_back(
            {node.x, node.y.r, midpoint, sharpness, logarithmic, given_.jumps});
      }
    }
    if (function.colors.empty()) function.colors.push_back({function.opacities.front().x});
    if (function.opacities.empty()) function.opacities.push_back({function.colors.front().x});
    const double largest_opacity = given_.is_color ? 1 : given_.largest;
    const Curves curves(function);
    for (double limit = deviation_;; limit *= 64) {
      ChordFit<Curves> chords(curves, limit, limit, function.format, given_.largest,
                              largest_opacity, max_points);
      try {
        take(chords);
      } catch (const Error&) {
        if (!(limit < largest_deviation)) throw;
        made_.is_coarse = true;
        continue;
      }
      return;
    }
  }

  void take(ChordFit<Curves>& chords) {
    for (const OpacityPoint& p : chords.points()) {
      const Rgb<double> value{p.opacity, p.opacity, p.opacity};
      push({p.value, given_.is_color ? p.color : value});
    }
    made_.deviation = given_.is_color ? chords.color_deviation() : chords.depth_deviation();
    if (made_.deviation > 0) made_.deviation += rounding_of_vtk;
    made_.deviation += way_deviation_;
    if (has_lab_step_) made_.deviation += lab_step;
  }

  void add_way(const ShapedNode& to, ColorNode& from) {
    has_lab_step_ = has_lab_step_ || space_ == ColorSpace::diverging ||
                    (space_ == ColorSpace::lab && may_change_branch(from.color, to.y));
    if (space_ != ColorSpace::way) return;
    if (from.color == to.y) {
      from.way = {{0, from.color}, {1, to.y}};
      return;
    }
    if (!sample_way_) throw Error("colors: the ways of CIEDE2000 are VTK's alone");
    MeasuredWay way = measured_way(from.color, to.y, sample_way_);
    from.way = std::move(way.corners);
    way_deviation_ = std::max(way_deviation_, way.deviation);
  }

  /// Adds a point. The middle one of three points at one place has no width and is removed.
  void push(const CurvePoint& point) {
    Curve& curve = made_.points;
    const std::size_t size = curve.size();
    if (size >= 1 && curve.back() == point) return;
    if (size >= 2 && curve[size - 1].x == point.x && curve[size - 2].x == point.x) {
      curve.back() = point;
    } else {
      curve.push_back(point);
    }
  }

  void add_ends() {
    const double first = made_.points.front().x, last = made_.points.back().x;
    const auto outside = [&](const std::optional<Rgb<double>>& color) {
      return given_.is_clamped ? color : std::optional<Rgb<double>>(Rgb<double>{0, 0, 0});
    };
    const auto below = outside(given_.below), above = outside(given_.above);
    if (below) {
      const Curve inner = std::move(made_.points);
      made_.points = {{first, within(*below)}};
      for (const CurvePoint& point : inner) push(point);
    }
    if (above) push({last, within(*above)});
  }

  static constexpr double largest_deviation = 0.05;
  const ShapedFunction& given_;
  const double deviation_;
  const SampleWay& sample_way_;
  ColorSpace space_ = ColorSpace::rgb;
  bool is_logarithmic_ = false, is_straight_ = true, has_lab_step_ = false;
  double way_deviation_ = 0;
  std::vector<Stretch> stretches_;
  FittedCurve made_;
};

/// Returns the difference of two values, as FittedCurve::deviation counts it.
double difference(const ShapedFunction& function, const Rgb<double>& ours,
                  const Rgb<double>& theirs) {
  if (function.is_color) return largest_component(ours - theirs);
  const double largest = function.largest;
  const double a = ours.r, b = std::clamp(theirs.r, 0.0, largest);
  // Thin and dense opacities are followed to within as much.
  if (std::abs(a - b) <= thin_opacity) return 0;
  if (largest <= 1 && std::min(a, b) >= 1 - 2 * dense_opacity) return 0;
  const auto depth = [&](double x) { return largest <= 1 ? -std::log1p(-x) : x; };
  return std::abs(std::log(depth(a) / depth(b)));
}

/// Raises the deviation to what the curve is off VTK's own function at some places.
void compare(const ShapedFunction& function, const SampleFunction& own, FittedCurve& fitted) {
  const Curve& curve = fitted.points;
  const std::size_t step = curve.size() / compared_places + 1;
  double most = 0;
  for (std::size_t i = 1; i < curve.size(); i += step) {
    const double x = curve[i - 1].x / 2 + curve[i].x / 2;
    if (!(x > curve[i - 1].x && x < curve[i].x)) continue;
    const double share = (x - curve[i - 1].x) / (curve[i].x - curve[i - 1].x);
    Rgb<double> theirs = own(x, x, 1).at(0);
    if (std::isnan(theirs.r + theirs.g + theirs.b)) continue;
    for (double* const c : {&theirs.r, &theirs.g, &theirs.b}) {
      *c = std::clamp(*c, 0.0, function.largest);
    }
    const Rgb<double> ours = curve[i - 1].y + share * (curve[i].y - curve[i - 1].y);
    most = std::max(most, difference(function, ours, theirs));
  }
  if (most > fitted.deviation + 1e-9) fitted.deviation = 2 * most;
}

}  // namespace

FittedCurve fit(const ShapedFunction& function, double deviation, const SampleWay& sample_way,
                const SampleFunction& own) {
  FittedCurve fitted = Fitter(function, deviation, sample_way).fitted();
  if (own) compare(function, own, fitted);
  return fitted;
}

std::vector<ShapedNode> ramp(const std::array<double, 2>& range, bool is_color) {
  const double end = is_color ? 1 : 0.5;
  if (range[0] == range[1]) return {{range[0], {end, end, end}}};
  return {{range[0], {0, 0, 0}}, {range[1], {end, end, end}}};
}

}  // namespace pellucid::imported
