// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/extinction_piece.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <type_traits>
#include <vector>

#include "pellucid/scene/internal/binned_transfer_storage.h"
#include "pellucid/scene/transfer_function.h"

namespace pellucid {
namespace {

using Wide = long double;

/// The cubic's value, from its Bernstein form in long double.
template <class F>
Wide value_at(const CubicBernstein<F>& f, Wide t) {
  const Wide s = 1 - t, b0 = static_cast<Wide>(f.b[0]), b1 = static_cast<Wide>(f.b[1]),
             b2 = static_cast<Wide>(f.b[2]), b3 = static_cast<Wide>(f.b[3]);
  return s * s * s * b0 + 3 * t * s * s * b1 + 3 * t * t * s * b2 + t * t * t * b3;
}

/// Cubics of all kinds: monotone and not, flat, with a double root, with values on the ends of the
/// interval, far from zero.
class Cubics {
 public:
  explicit Cubics(unsigned seed) : random_(seed) {}
  double uniform() { return std::uniform_real_distribution<double>()(random_); }

  template <class F>
  CubicBernstein<F> make(double lower, double upper) {
    const double width = upper - lower, start = lower + width * uniform();
    const int kind = static_cast<int>(uniform() * 8);
    const double reach = width * std::pow(10.0, uniform() * 5 - 3);
    double b[4] = {start, 0, 0, 0};
    for (int k = 1; k < 4; ++k) b[k] = start + reach * (2 * uniform() - 1);
    switch (kind) {
      case 0:
        std::sort(b + 1, b + 4);
        break;
      case 1:
        std::sort(b + 1, b + 4, std::greater<>());
        break;
      case 2:  // leaves along a plateau
        b[2] = b[1];
        break;
      case 3:  // straight
        for (int k = 1; k < 3; ++k) b[k] = b[0] + k * (b[3] - b[0]) / 3;
        break;
      case 4:  // begins at an end of the interval
        b[0] = uniform() < 0.5 ? lower : upper;
        break;
      case 5: {  // touches an end of the interval
        const double at = uniform(), end = uniform() < 0.5 ? lower : upper, c = b[3] - end;
        // end + c (t - at)² times a line.
        const double line0 = 1 - 0.5 * uniform(), line1 = 1 - 0.5 * uniform();
        const double q[3] = {at * at, -at * (1 - at), (1 - at) * (1 - at)};
        b[0] = end + c * q[0] * line0;
        b[1] = end + c * (2 * q[1] * line0 + q[0] * line1) / 3;
        b[2] = end + c * (q[2] * line0 + 2 * q[1] * line1) / 3;
        b[3] = end + c * q[2] * line1;
        break;
      }
      default:
        break;
    }
    CubicBernstein<F> f;
    for (int k = 0; k < 4; ++k) f.b[k] = static_cast<F>(b[k]);
    f.b[0] = clamp(f.b[0], static_cast<F>(lower), static_cast<F>(upper));
    return f;
  }

 private:
  std::mt19937 random_;
};

/// The rounding that packets state for data, of which a quarter is `close`.
template <class F>
F rounding_of(const CubicBernstein<F>& f) {
  constexpr F unit = rounding_unit<F>;
  return F(8) * unit * max(abs(f.hull_min()), abs(f.hull_max())) +
         F(80) * unit * (f.hull_max() - f.hull_min());
}

/// How far f, on [0, t], goes back from where it went: 0 where it is monotone.
template <class F>
Wide goes_back(const CubicBernstein<F>& f, Wide t) {
  Wide least = value_at(f, 0), most = least, up = 0, down = 0;
  for (int i = 1; i <= 64; ++i) {
    const Wide v = value_at(f, t * i / 64);
    up = std::max(up, v - least);
    down = std::max(down, most - v);
    least = std::min(least, v);
    most = std::max(most, v);
  }
  return std::min(up, down);
}

/// Where f turns, or would but for a touch, in (0, 1).
template <class F>
std::vector<Wide> turns_of(const CubicBernstein<F>& f) {
  const Wide d0 = static_cast<Wide>(f.b[1]) - static_cast<Wide>(f.b[0]),
             d1 = static_cast<Wide>(f.b[2]) - static_cast<Wide>(f.b[1]),
             d2 = static_cast<Wide>(f.b[3]) - static_cast<Wide>(f.b[2]);
  // d0 + 2 t (d1 - d0) + t² (d2 - 2 d1 + d0).
  const Wide half = d1 - d0, square = d2 - 2 * d1 + d0, radicand = half * half - d0 * square;
  std::vector<Wide> turns;
  if (radicand < 0) return turns;
  const Wide w = -(half + std::copysign(std::sqrt(radicand), half));
  for (const Wide t : {w / square, d0 / w}) {
    if (t > 0 && t < 1) turns.push_back(t);
  }
  return turns;
}

/// Where f first leaves [lower, upper] by more than `by`, within 2^-60 of it, or 1: the first of
/// many steps, then bisection.
template <class F>
Wide leaves_at(const CubicBernstein<F>& f, Wide lower, Wide upper, Wide by) {
  const auto outside = [&](Wide t) {
    const Wide v = value_at(f, t);
    return v < lower - by || v > upper + by;
  };
  constexpr int steps = 256;
  for (int i = 1; i <= steps; ++i) {
    if (!outside(static_cast<Wide>(i) / steps)) continue;
    Wide in = static_cast<Wide>(i - 1) / steps, out = static_cast<Wide>(i) / steps;
    for (int n = 0; n < 60; ++n) {
      const Wide middle = (in + out) / 2;
      (outside(middle) ? out : in) = middle;
    }
    return out;
  }
  return 1;
}

template <class F>
class PieceEnds : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(PieceEnds, Numbers);

TYPED_TEST(PieceEnds, AreWhereTheDataLeaveOrTurn) {
  using F = TypeParam;
  Cubics cubics(7);
  int crossing = 0, turning = 0, needless = 0, whole = 0, lost = 0;
  Wide largest_miss = 0, largest_outside = 0, largest_back = 0;
  for (int n = 0; n < 100000; ++n) {
    const double far = n % 3 == 0 ? 1000 * cubics.uniform() : 0;
    const auto lower = static_cast<F>(far + cubics.uniform());
    const auto upper =
        static_cast<F>(static_cast<double>(lower) + std::pow(10.0, cubics.uniform() * 4 - 2));
    const CubicBernstein<F> f =
        cubics.make<F>(static_cast<double>(lower), static_cast<double>(upper));
    const F rounding = rounding_of(f), close = F(0.25) * rounding;
    const PieceEnd<F> end = piece_end(f, lower, upper, close, true);
    ASSERT_TRUE(end.place >= 0 && end.place <= 1) << n;
    if (!end.found) {
      ++lost;
      continue;
    }
    const Wide place = static_cast<Wide>(end.place), allowed = static_cast<Wide>(rounding),
               lo = static_cast<Wide>(lower), hi = static_cast<Wide>(upper);
    const auto share = [&](Wide x) { return x / static_cast<Wide>(close); };
    // Nothing before the end is outside, and the end is not before anything is.
    Wide outside = 0;
    for (int i = 0; i <= 64; ++i) {
      const Wide v = value_at(f, place * i / 64);
      outside = std::max({outside, lo - v, v - hi});
    }
    largest_outside = std::max(largest_outside, share(outside));
    ASSERT_LE(outside, 2 * static_cast<Wide>(close)) << n;
    if (end.crosses) {
      ++crossing;
      const Wide miss = std::fabs(value_at(f, place) - (end.rising ? hi : lo));
      largest_miss = std::max(largest_miss, share(miss));
      ASSERT_LE(miss, 2 * static_cast<Wide>(close)) << n;
      ASSERT_LE(place, leaves_at(f, lo, hi, 2 * static_cast<Wide>(close)) + 1e-18L) << n;
    } else if (end.place < 1) {
      ++turning;
      // At the value of a turn; or there is none at all, and it costs a cut and no more.
      const std::vector<Wide> all = turns_of(f);
      const Wide here = value_at(f, place);
      const bool turns = std::any_of(all.begin(), all.end(), [&](Wide t) {
        return std::fabs(value_at(f, t) - here) <= allowed;
      });
      if (!turns) ++needless;
      ASSERT_TRUE(turns || all.empty()) << n;
    } else {
      ++whole;
    }
    // Either it never leaves the hull, or it is monotone up to rounding.
    if (f.hull_min() < lower - close || f.hull_max() > upper + close) {
      const Wide back = goes_back(f, place);
      largest_back = std::max(largest_back, share(back));
      ASSERT_LE(back, allowed) << n;
    }
  }
  EXPECT_GT(crossing, 20000);
  EXPECT_GT(turning, 5000);
  EXPECT_GT(whole, 20000);
  EXPECT_LE(lost, 0);
  this->RecordProperty("needless_of_turning",
                       std::to_string(needless) + "/" + std::to_string(turning));
  this->RecordProperty("largest_miss_of_close", std::to_string(largest_miss));
  this->RecordProperty("largest_outside_of_close", std::to_string(largest_outside));
  this->RecordProperty("largest_way_back_of_close", std::to_string(largest_back));
}

TYPED_TEST(PieceEnds, CutsAreTheSameCubic) {
  using F = TypeParam;
  Cubics cubics(8);
  for (int n = 0; n < 20000; ++n) {
    const CubicBernstein<F> f = cubics.make<F>(-1, 3);
    const auto t = static_cast<F>(cubics.uniform());
    const CutCubic<F> parts = cut(f, t);
    const Wide slack = 16 * static_cast<Wide>(rounding_unit<F>) *
                       static_cast<Wide>(max(abs(f.hull_min()), abs(f.hull_max())));
    for (const double s : {0.0, 0.3, 0.5, 0.9, 1.0}) {
      const Wide x = static_cast<Wide>(s), at = static_cast<Wide>(t);
      ASSERT_NEAR(static_cast<double>(value_at(parts.front, x)),
                  static_cast<double>(value_at(f, x * at)), static_cast<double>(slack));
      ASSERT_NEAR(static_cast<double>(value_at(parts.back, x)),
                  static_cast<double>(value_at(f, at + x * (1 - at))), static_cast<double>(slack));
    }
  }
}

/// A piece by quadrature in double: 4 Gauss points in each of many panels.
struct Truth {
  double depth = 0, opacity = 0;
  Rgb<double> radiance{};
};
template <class T>
Truth quadrature(const CubicBernstein<T>& data, double length, const PiecewiseLinear<double>& table,
                 int panels) {
  constexpr double node[2] = {0.3399810435848563, 0.8611363115940526},
                   weight[2] = {0.6521451548625461, 0.3478548451374538};
  Truth truth;
  for (int p = 0; p < panels; ++p) {
    // Within a panel the depth in front of a point is that of its parts, linearly interpolated to
    // second order: what is left is far below what is checked.
    double extinction[4], share[4];
    Rgb<double> color[4];
    double all = 0;
    for (int k = 0; k < 4; ++k) {
      const double x = k < 2 ? -node[1 - k] : node[k - 2];
      share[k] = weight[k < 2 ? 1 - k : k - 2] / 2 * length / panels;
      const double t = (p + 0.5 * (1 + x)) / panels;
      const Material<double> m =
          table.evaluate(static_cast<double>(value_at(data, static_cast<Wide>(t))));
      extinction[k] = m.extinction;
      color[k] = m.color;
      all += share[k] * m.extinction;
    }
    double in_front = truth.depth;
    for (int k = 0; k < 4; ++k) {
      const double part = share[k] * extinction[k];
      truth.radiance += std::exp(-in_front) * -std::expm1(-part) * color[k];
      in_front += part;
    }
    truth.depth += all;
  }
  truth.opacity = -std::expm1(-truth.depth);
  return truth;
}

std::vector<TransferFunction::Point> random_points(Cubics& cubics) {
  // Corners of the extinction at every third point: the colors bend in between.
  const int count = 4 + static_cast<int>(cubics.uniform() * 20);
  std::vector<TransferFunction::Point> points;
  double value = 0;
  for (int i = 0; i < count; ++i) {
    points.push_back({value, 0, {cubics.uniform(), 2 * cubics.uniform(), cubics.uniform()}});
    value += 0.02 + cubics.uniform();
  }
  const double most = std::pow(10.0, cubics.uniform() * 3 - 1);
  for (int i = 0, next = 0; i < count; i = next) {
    next = std::min(i + 3, count);
    const double from =
        i == 0 ? most * cubics.uniform() : points[static_cast<std::size_t>(i)].extinction;
    const double to = cubics.uniform() < 0.2 ? 0 : most * cubics.uniform();
    const int end = std::min(i + 3, count - 1);
    for (int k = i; k <= end; ++k) {
      const double s =
          (points[static_cast<std::size_t>(k)].value - points[static_cast<std::size_t>(i)].value) /
          std::max(points[static_cast<std::size_t>(end)].value -
                       points[static_cast<std::size_t>(i)].value,
                   1e-9);
      points[static_cast<std::size_t>(k)].extinction = std::max(from + s * (to - from), 0.0);
    }
  }
  return points;
}

/// What the colors of a piece differ by.
template <class T>
ColorSpread<float> spread_of(const PieceDepth<T>& piece, const ExtinctionInterval<T>& interval,
                             const BinnedTransfer& bins) {
  return {static_cast<float>(interval.color_range), static_cast<float>(interval.color_slope),
          color_kink_error(bins, piece.lower, piece.upper)};
}

/// panel_piece() of data as color_in_panel() in packet/span_piece.h calls it.
template <class T>
BoundedSegment<float> seen_in_panel(const CubicBernstein<T>& data, T length,
                                    const PieceDepth<T>& depth,
                                    const ExtinctionInterval<T>& interval, bool proved,
                                    const SegmentResult<float>& found, const BinnedTransfer& bins) {
  const PiecePanel<T> panel = piece_panel(data, interval, length);
  ColorInterval<T> color;
  return panel_piece(depth, panel, spread_of(depth, interval, bins), proved, found, bins, true,
                     color);
}

TEST(ExtinctionPiece, KinksBetweenValuesAlikeInFloatCount) {
  constexpr double offset = 1000, width = 0x1p-20;  // a 64th of what floats differ by
  const auto point = [](double share, double red) {
    return TransferFunction::Point{offset + share * width, 1, {red, 0, 0}};
  };
  const TransferFunction function({point(0, 0), point(0.5, 1), point(1, 0), point(1e8, 0)});
  const BinnedTransferStorage storage(function.view<double>());
  const double lower = offset + 0.25 * width, upper = offset + 0.75 * width;
  ASSERT_EQ(static_cast<float>(lower), static_cast<float>(upper));
  // The kink's mean is 0.75 where data are spread evenly, and the color at their mean is 1.
  EXPECT_GE(color_kink_error(storage.view(), lower, upper), 0.25f);
}

template <class T>
class Pieces : public testing::Test {};
TYPED_TEST_SUITE(Pieces, Numbers);

TYPED_TEST(Pieces, DepthAndColorAreWithinWhatIsSaid) {
  using T = TypeParam;
  Cubics cubics(9);
  int pieces = 0, bent = 0, thick = 0, in_panel = 0;
  double largest_depth = 0, largest_color = 0, largest_in_panel[2] = {};
  for (int t = 0; t < 300; ++t) {
    const TransferFunction function(random_points(cubics));
    const PiecewiseLinear<double> table = function.view<double>();
    const BinnedTransferStorage storage(table);
    const BinnedTransfer& bins = storage.view();
    ColorInterval<T> color;
    const double first = table.value[0], last = table.value[table.count - 1];
    for (int n = 0; n < 200; ++n) {
      const auto start = static_cast<T>(first + (last - first) * cubics.uniform());
      int index = 0;
      const ExtinctionInterval<T> interval = find_extinction(bins, start, true, index);
      const CubicBernstein<T> data =
          cubics.make<T>(std::max(static_cast<double>(interval.lower), first - 1),
                         std::min(static_cast<double>(interval.upper), last + 1));
      if (!(data.b[0] >= interval.lower && data.b[0] < interval.upper)) continue;
      const T rounding = rounding_of(data), close = T(0.25) * rounding;
      const PieceEnd<T> end = piece_end(data, interval.lower, interval.upper, close, true);
      if (!end.found || !(end.place > 0)) continue;
      CubicBernstein<T> piece = data;
      if (end.place < 1) {
        piece = cut(data, end.place).front;
        if (end.crosses) piece.b[3] = end.rising ? interval.upper : interval.lower;
      }
      const auto length = static_cast<T>(std::pow(10.0, cubics.uniform() * 4 - 3)) * end.place;
      const PieceDepth<T> depth = piece_depth(piece, interval, length);
      const BoundedSegment<float> found =
          colored_piece(depth, spread_of(depth, interval, bins), bins, true, color);
      const Truth truth = quadrature(piece, static_cast<double>(length), table, 64);

      ++pieces;
      constexpr double u = 0x1p-24;
      const double value_error = static_cast<double>(rounding + close),
                   depth_slack = static_cast<double>(length) *
                                 (value_error * static_cast<double>(interval.steepest) +
                                  8 * u * static_cast<double>(interval.largest));
      const double depth_error =
          std::fabs(static_cast<double>(found.segment.optical_depth) - truth.depth);
      ASSERT_LE(depth_error, depth_slack + 1e-9 * truth.depth) << t << ", " << n;
      largest_depth = std::max(largest_depth, depth_error / depth_slack);
      ASSERT_NEAR(static_cast<double>(found.segment.opacity), truth.opacity,
                  depth_slack + 8 * u + 1e-9);

      // Colors as if the opacity were right: what color_error says.
      const double opacity = static_cast<double>(found.segment.opacity);
      if (!(truth.opacity > 0)) continue;
      const auto color_off_of = [&](const Rgb<float>& radiance) {
        const double scale = opacity / truth.opacity;
        return std::max({std::fabs(static_cast<double>(radiance.r) - truth.radiance.r * scale),
                         std::fabs(static_cast<double>(radiance.g) - truth.radiance.g * scale),
                         std::fabs(static_cast<double>(radiance.b) - truth.radiance.b * scale)});
      };
      const double color_off = color_off_of(found.segment.radiance);
      const double brightest = static_cast<double>(bins.largest_color);
      // Rounding as next_piece() in packet/span_piece.h has it, and 2^-11 of the range of the
      // colors for the quadrature.
      constexpr double colored = is_single<T> ? 32 * u : 12 * u, shown = is_single<T> ? 1 : 1.125;
      const double slack =
          opacity * (colored * brightest +
                     std::min(shown * value_error * static_cast<double>(interval.color_slope),
                              brightest)) +
          2 * depth_slack * brightest + 1e-7 * opacity;
      const double said = static_cast<double>(found.color_error);
      ASSERT_LE(color_off, said * (1 + 0x1p-11) + slack) << t << ", " << n;
      if (said > 100 * slack) {
        largest_color = std::max(largest_color, color_off / said);
        ++bent;
      }
      if (truth.depth > 3) ++thick;

      if (!(found.segment.optical_depth <= largest_panel_depth<float>)) continue;
      for (const bool proved : {false, true}) {
        const BoundedSegment<float> better =
            seen_in_panel(piece, length, depth, interval, proved, found.segment, bins);
        const double still_said = static_cast<double>(better.color_error),
                     still_off = color_off_of(better.segment.radiance);
        ASSERT_LE(still_off, still_said * (1 + 0x1p-11) + slack) << t << ", " << n;
        if (still_said < 100 * slack) continue;
        largest_in_panel[proved] = std::max(largest_in_panel[proved], still_off / still_said);
        ++in_panel;
      }
    }
  }
  EXPECT_GT(in_panel, 3000);
  this->RecordProperty("largest_error_in_panel_of_estimate", std::to_string(largest_in_panel[0]));
  this->RecordProperty("largest_error_in_panel_of_bound", std::to_string(largest_in_panel[1]));
  EXPECT_GT(bent, 3000);
  EXPECT_GT(thick, 3000);
  this->RecordProperty("pieces", pieces);
  this->RecordProperty("bent", bent);
  this->RecordProperty("thick", thick);
  this->RecordProperty("largest_depth_error_of_bound", std::to_string(largest_depth));
  this->RecordProperty("largest_color_error_of_bound", std::to_string(largest_color));
}

/// A cubic with the range [0, 1], and an extinction that is linear in it and nowhere negative.
struct Shape {
  double b[4];
  double near, change;

  double at(double t) const {
    const double s = 1 - t;
    return s * s * s * b[0] + 3 * t * s * s * b[1] + 3 * t * t * s * b[2] + t * t * t * b[3];
  }
  double rate(double v) const { return std::max(near + change * v, 0.0); }
  void normalise() {
    double lower = at(0), upper = lower;
    for (int i = 1; i <= 200; ++i) {
      lower = std::min(lower, at(i / 200.0));
      upper = std::max(upper, at(i / 200.0));
    }
    for (double& x : b) x = (x - lower) / std::max(upper - lower, 1e-9);
  }
};

Shape random_shape(Cubics& cubics) {
  const auto one_of = [&](int n) { return cubics.uniform() * n < 1; };
  Shape s{};
  for (double& x : s.b) x = one_of(4) ? 10 * cubics.uniform() - 5 : cubics.uniform();
  if (one_of(4)) s.b[0] = s.b[1] = 0;
  if (one_of(4)) s.b[2] = s.b[3] = 1;
  if (one_of(5)) {  // Chebyshev's T3, nearly
    const double t3[4] = {0, 3, -2, 1};
    for (int k = 0; k < 4; ++k) s.b[k] = t3[k] + 0.2 * cubics.uniform();
  }
  if (one_of(6)) s.b[1] = s.b[2] = s.b[0];  // a plateau
  s.normalise();
  s.near = one_of(3) ? 0 : std::pow(10.0, -4 * cubics.uniform());
  s.change = one_of(2) ? cubics.uniform() : -s.near * (one_of(3) ? 1 : cubics.uniform());
  if (s.near == 0) s.change = 1;
  return s;
}

/// How far the nodes' mean of max(v - k, 0) is from the true one, for the worst of many k; both
/// weighted by extinction · transparency.
double miss_of_kinks(const Shape& shape, double depth) {
  constexpr int parts = 300;
  double mean = 0, value[parts];
  for (int i = 0; i < parts; ++i) {
    value[i] = shape.at((i + 0.5) / parts);
    mean += shape.rate(value[i]) / parts;
  }
  if (!(mean > 1e-6 * std::max(shape.near, shape.near + shape.change))) return 0;
  double weight[parts], sum = 0, in_front = 0;
  for (int i = 0; i < parts; ++i) {
    const double part = depth * shape.rate(value[i]) / mean / parts;
    weight[i] = std::exp(-in_front) * -std::expm1(-part);
    in_front += part;
    sum += weight[i];
  }
  double seen[piece_nodes], seen_weight[piece_nodes], seen_sum = 0;
  int node = 0;
  for_each_panel_node<piece_nodes>(
      CubicBernstein<double>{{shape.b[0], shape.b[1], shape.b[2], shape.b[3]}},
      depth * shape.near / mean, depth * shape.change / mean, [&](double v, double w) {
        seen[node] = v;
        seen_weight[node++] = w;
        seen_sum += w;
      });
  double worst = 0;
  for (int kink = 1; kink < 60; ++kink) {
    const double k = kink / 60.0;
    double truth = 0, found = 0;
    for (int i = 0; i < parts; ++i) truth += weight[i] * std::max(value[i] - k, 0.0);
    for (int i = 0; i < piece_nodes; ++i) found += seen_weight[i] * std::max(seen[i] - k, 0.0);
    worst = std::max(worst, std::fabs(truth / sum - found / seen_sum));
  }
  return worst;
}

/// Random search and then hill climbing: twice the worst is charged, or more. It has to stay below
/// 1/1.7 of that, and above 1/5.
TEST(ExtinctionPiece, KinksInPanelsAreTwiceTheWorstFound) {
  Cubics cubics(11);
  double closest = 0;
  for (const double depth : {0.01, 0.5, 1.0, 2.0, 4.0}) {
    Shape worst_shape{};
    double worst = 0;
    const auto look_at = [&](const Shape& shape) {
      const double miss = miss_of_kinks(shape, depth);
      if (!(miss > worst)) return false;
      worst = miss;
      worst_shape = shape;
      return true;
    };
    for (int i = 0; i < 4000; ++i) look_at(random_shape(cubics));
    double spread = 0.3;
    for (int i = 0; i < 1500; ++i) {
      Shape s = worst_shape;
      for (double& x : s.b) x += cubics.uniform() < 0.5 ? spread * (cubics.uniform() - 0.5) : 0;
      s.near *= std::exp(spread * (cubics.uniform() - 0.5));
      s.change *= std::exp(spread * (cubics.uniform() - 0.5));
      s.normalise();
      if (s.near + s.change < 0) continue;
      if (!look_at(s)) spread = std::max(0.98 * spread, 1e-3);
    }
    // color_kink_error() is a quarter for this kink.
    const double said = 0.25 * panel_kink_factor(depth);
    std::printf("[ accuracy ] depth %-5g kinks in a panel: worst %.2e = %.2f of the estimate\n",
                depth, worst, worst / said);
    EXPECT_LE(worst, said / 1.7) << "depth " << depth;
    closest = std::max(closest, worst / said);
  }
  EXPECT_GT(closest, 0.2);
}

}  // namespace
}  // namespace pellucid
