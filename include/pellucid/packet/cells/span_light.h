// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/random_errors.h"
#include "pellucid/packet/cells/nodes_of_lanes.h"
#include "pellucid/packet/cells/span_piece.h"
#include "pellucid/packet/light.h"
#include "pellucid/segment/gauss_panel.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Returns the largest rounding error of a position along a span, as a world length.
inline float place_rounding(const PacketLight& light) noexcept {
  return 8 * rounding_unit<float> * light.farthest;
}

/// Bounds on the light of a piece of a span, before any node is shaded.
template <int N>
struct LightOfPiece {
  using F = Batch<float, N>;
  GradientStretch<F> along;
  F color_error;                        ///< of the color beside these: tables' kinks and rounding
  F range;                              ///< of the colors
  F turns, sharpness;                   ///< as of error_of_three_nodes()
  LitBounds<F> bounds;                  ///< on what light makes of a color
  typename LikeErrors<F>::Signs signs;  ///< of the piece, for errors that repeat
};

/// Standard deviations of a piece's color by three and by six nodes: error_of_three_nodes() and
/// error_of_six_nodes() times the range of the colors. Errors are charged at four deviations, at
/// six where a piece is alone or pieces are alike (LikeErrors).
template <int N>
class NodeDeviations {
 public:
  using F = Batch<float, N>;

  NodeDeviations(F range, F turns, F sharpness, F depth) noexcept
      : turns_(turns),
        sharpness_(sharpness),
        range_(F(1.5f / RandomErrors<F>::deviations) * range),
        depth_(depth) {}

  F by_three() const noexcept { return deviation(error_of_three_nodes(turns_, sharpness_)); }
  F by_six() const noexcept { return deviation(error_of_six_nodes(turns_, sharpness_)); }

 private:
  F deviation(F of_nodes) const noexcept {
    const F deep = select(depth_ <= F(8), min(F(2) * of_nodes, F(1)), F(1));
    return range_ * select(depth_ <= F(1), of_nodes, deep);
  }

  F turns_, sharpness_, range_, depth_;
};

/// The light of the spans that lanes work on.
template <int N>
class SpanLight {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using M = BatchMask<N>;

  /// `to_eye`: the directions from which the lanes' rays come, of length 1.
  SpanLight(const PacketLight& light, const Vec3<F>& to_eye) noexcept
      : to_eye_(to_eye), light_(light) {
    const Reflection<float>& r = light.reflection;
    float brightest = r.ambient;
    for (int i = 0; i < light.lights; ++i) {
      brightest += (r.diffuse + r.specular) * largest_component(light.light[i].color);
    }
    inverse_light_ = brightest > 0 ? 1 / brightest : 0;
  }

  /// Begins spans of these gradients in the world, and of their magnitude if there is a factor of
  /// it. `entry`, `length`: where they begin, from PacketLight's origin, and their world length, if
  /// there are point lights. Returns the lanes in which one of these is too near for nodes.
  M begin(M lanes, const CubicBernstein<F> (&gradient)[3], const CubicBernstein<F>& magnitude,
          const Vec3<F>& entry, F length) noexcept {
    const M near = begin_kinks(lanes, gradient, entry, length);
    if (light_.factor != nullptr) begin_factor(lanes, magnitude);
    return near;
  }

  bool has_factor() const noexcept { return light_.factor != nullptr; }
  float largest_factor() const noexcept { return light_.largest_factor; }
  /// Returns where the next piece has to end, as a share of the cell: g·l changes its sign there,
  /// or g·h if highlights have a kink, or the magnitude comes to a control point of the factor.
  F kink() const noexcept { return min(kink_, factor_end_); }
  /// The lanes have gone past this share of their cells.
  void go_past(M lanes, F to) noexcept {
    const M past = lanes & (to >= kink_ - F(1e-5f)) & (to < F(1));
    if (any(past)) kink_ = select(past, next_kink(past, to + F(2e-3f)), kink_);
    const M ends = lanes & (to >= factor_end_ - F(1e-6f)) & (to < F(1));
    if (any(ends)) {
      interval_ += select(ends & factor_crosses_, select(factor_rises_, I(1), I(-1)), I(0));
      factor_ = load_extinction<F>(*light_.factor, interval_);
      find_factor_end(ends, to);
    }
  }

  /// Makes the extinction of a piece, the share [from, to] of its cell, what the factor makes of
  /// it: a polynomial of degree 6, whose depth four nodes have. Lanes in which the factor is not
  /// known well enough have an infinite depth_error.
  [[gnu::noinline]] void weaken(SpanPiece<float, N>& piece, F from, F to,
                                const SpanLanes<float, N>& span, F largest_color) noexcept {
    part_ = restrict_to(magnitude_, from, to);
    const detail::PanelNodes<4, F> nodes(piece.length, [&](F u) noexcept {
      return Material<F>{extinction(span, evaluate(piece.parts.front, u), u), {}};
    });
    const F largest = max(factor_at(part_.hull_min()), factor_at(part_.hull_max()));
    // Where a piece ends beside a control point, as much of the next slope is in it.
    const F off =
        F(2) * magnitude_error_ * factor_.steepest + F(16 * rounding_unit<float>) * largest;
    const F unweakened = span.extinction.largest * piece.length;
    const M known = factor_known_ & (F(2) * magnitude_error_ < F(light_.factor->narrowest));
    piece.depth_error = select(known, piece.depth_error * (largest + off) + unweakened * off,
                               F(std::numeric_limits<float>::infinity()));
    piece.seen.depth = nodes.total;
    piece.found.segment = segment_of_depth(nodes.total, Rgb<F>{});
    piece.add_up_rounding(largest_color);
  }

  /// Returns the gradients on the lanes' cells, seen from their place at u.
  GradientStretch<F> around(F u) const noexcept {
    GradientStretch<F> result{{gradient_[0], gradient_[1], gradient_[2]}, {}, F(0), to_eye_};
    if (light_.points > 0) result.middle = entry_ - to_eye_ * (u * length_);
    return result;
  }

  /// Bounds the light on a piece, the share [from, to] of its cell. Transfer: a BinnedTransfer, or
  /// several.
  template <class Transfer>
  [[gnu::noinline]] void measure(const SpanPiece<float, N>& piece, F from, F to,
                                 const Transfer& transfer, LightOfPiece<N>& result) const noexcept {
    // The range of the table's colors within the piece.
    const F change = min(piece.spread.range, piece.spread.slope * range_of(piece.seen));
    measure(change, piece.spread.kinks, F(transfer.largest_color), from, to, result);
  }
  /// Bounds the light on colors up to `largest` that differ by `change`; `kinks`: their error.
  [[gnu::flatten, gnu::noinline]] void measure(F change, F kinks, F largest, F from, F to,
                                               LightOfPiece<N>& result) const noexcept {
    set_along(from, to, result.along);
    const Bounds<F> squares = result.along.square();
    LitBounds<F>& bounds = result.bounds;
    bounds = light_bounds(light_.reflection, light_.light, light_.lights, result.along, squares);
    // The range of the colors: of those without light, of light's factors and addends.
    const F brightest = largest_component(bounds.upper.factor);
    const F range = brightest * change +
                    largest * largest_component(bounds.upper.factor - bounds.lower.factor) +
                    largest_component(bounds.upper.added - bounds.lower.added);
    const F flat = F(light_.reflection.flat_square);
    // The direction to a point light has its distance for a denominator, as the normal |g|.
    const F turns = (squares.upper + flat) / max(squares.lower + flat, F(smallest_normal<float>)) *
                    turns_of_distance(result.along);
    result.range = range;
    result.turns = turns;
    result.sharpness = bounds.sharpness;
    result.color_error =
        brightest * kinks + color_rounding(light_.reflection, light_.light, light_.lights, squares,
                                           largest, F(gradient_rounding<float>));
    if (light_.points > 0) {
      result.color_error += place_doubt(light_.reflection, light_.light, light_.lights,
                                        result.along, largest, F(place_rounding(light_)));
    }
    // The same for pieces that mirror each other.
    const F feature[LikeErrors<F>::features] = {
        F(1) / turns, F(inverse_light_) * (brightest + largest_component(bounds.upper.added)),
        F(inverse_light_) *
            (largest_component(bounds.lower.factor) + largest_component(bounds.lower.added)),
        F(inverse_light_) * range};
    result.signs = LikeErrors<F>::signs(feature);
  }

  /// Returns what light makes of colors at u of a piece.
  Lit<F> lit_at(const LightOfPiece<N>& of, F u) const noexcept {
    return light_up(light_.reflection, light_.light, light_.lights, of.along.at(u),
                    of.along.position(u), to_eye_);
  }
  /// Returns extinction and color at u of a piece. `known`: as of color_at().
  template <class Transfer>
  Material<F> material(const LightOfPiece<N>& of, const SpanPiece<float, N>& piece,
                       const SpanLanes<float, N>& span, F u, M lanes, const Transfer& transfer,
                       ColorInterval<F>& known) const noexcept {
    const F value = evaluate(piece.parts.front, u);
    const Rgb<F> unlit = color_at(
        transfer, clamp(value, piece.seen.color_lower, piece.seen.color_upper), lanes, known);
    return {extinction(span, value, u), lit_at(of, u).apply(unlit)};
  }

  /// Returns the color of a piece by three Gauss nodes, or by six in the lanes of `more`. The
  /// depths at the nodes are exact for the extinction of a table; where a factor weakens it, those
  /// of PanelNodes.
  [[gnu::flatten, gnu::noinline]] Rgb<F> color(const LightOfPiece<N>& of,
                                               const SpanPiece<float, N>& piece,
                                               const SpanLanes<float, N>& span, M lanes, M more,
                                               const BinnedTransfer& transfer,
                                               ColorInterval<F>& known) const noexcept {
    const NodesOfLanes<N> nodes(more);
    const F(&data)[4] = piece.parts.front.b;
    const CubicBernstein<F>(&g)[3] = of.along.component;
    const ExtinctionInterval<F>& interval = span.extinction;
    const bool weakened = light_.factor != nullptr;
    F end[4];  // rates of the coefficients
    for (int k = 0; k < 4; ++k) {
      end[k] = piece.length * (interval.at_lower + interval.slope * (data[k] - interval.lower));
    }
    // Plain numbers: an array of batches would be set to 0 first.
    float rate[6][N], depth[6][N], normal[3][6][N], lit_color[3][6][N];
    // A pass of its own, in which the root and the quotient of one node wait for no other.
    nodes.for_each([&](int j) noexcept {
      const typename NodesOfLanes<N>::Weights at = nodes.value_weights(j);
      const Vec3<F> n = shading_normal(light_.reflection,
                                       Vec3<F>{at.sum(g[0].b), at.sum(g[1].b), at.sum(g[2].b)});
      n.x.store(normal[0][j]);
      n.y.store(normal[1][j]);
      n.z.store(normal[2][j]);
    });
    nodes.for_each([&](int j) noexcept {
      const typename NodesOfLanes<N>::Weights at = nodes.value_weights(j);
      const F value = at.sum(data);
      if (weakened) {
        (piece.length * extinction(span, value, nodes.position(j))).store(rate[j]);
      } else {
        max(at.sum(end), F(0)).store(rate[j]);
        nodes.integral_weights(j).sum(end).store(depth[j]);
      }
      const Rgb<F> unlit = color_at(
          transfer, clamp(value, piece.seen.color_lower, piece.seen.color_upper), lanes, known);
      const Vec3<F> n{F::load(normal[0][j]), F::load(normal[1][j]), F::load(normal[2][j])};
      const Vec3<F> position =
          light_.points > 0 ? of.along.position(nodes.position(j)) : Vec3<F>{F(0), F(0), F(0)};
      const Rgb<F> color =
          light_up_normal(light_.reflection, light_.light, light_.lights, n, position, to_eye_)
              .apply(unlit);
      color.r.store(lit_color[0][j]);
      color.g.store(lit_color[1][j]);
      color.b.store(lit_color[2][j]);
    });
    if (weakened) {
      nodes.for_each([&](int j) noexcept { nodes.collocated(j, rate).store(depth[j]); });
    }
    // As panel_color().
    F origin(std::numeric_limits<float>::max());
    nodes.for_each([&](int j) noexcept {
      origin = min(origin, select(F::load(rate[j]) > F(0), F::load(depth[j]), origin));
    });
    F sum(0);
    Rgb<F> color{};
    nodes.for_each([&](int j) noexcept {
      const F weight =
          nodes.weight(j) * F::load(rate[j]) * exp(min(origin - F::load(depth[j]), F(0)));
      sum += weight;
      color += weight *
               Rgb<F>{F::load(lit_color[0][j]), F::load(lit_color[1][j]), F::load(lit_color[2][j])};
    });
    return (F(1) / select(sum > F(0), sum, F(1))) * color;
  }

 protected:
  /// Begins spans as begin(), but for the magnitude.
  M begin_kinks(M lanes, const CubicBernstein<F> (&gradient)[3], const Vec3<F>& entry,
                F length) noexcept {
    begin_gradients(lanes, gradient);
    return begin_loaded(lanes, entry, length);
  }
  /// Begins the same where gradient_ is loaded.
  M begin_loaded(M lanes, const Vec3<F>& entry, F length) noexcept {
    begin_places(lanes, entry, length);
    M near(false);
    if (light_.points > 0) near = lanes & (distance_to_lights() < F(nearest_light) * length_);
    kink_ = select(lanes, next_kink(lanes, F(0)), kink_);
    return near;
  }
  /// Begins spans as begin() where the first kink is known; -1 where a point light is too near.
  M begin_known(M lanes, const CubicBernstein<F> (&gradient)[3], const CubicBernstein<F>& magnitude,
                const Vec3<F>& entry, F length, F kink) noexcept {
    begin_gradients(lanes, gradient);
    begin_places(lanes, entry, length);
    kink_ = select(lanes, kink, kink_);
    if (light_.factor != nullptr) begin_factor(lanes, magnitude);
    return lanes & (kink < F(0));
  }

  Vec3<F> to_eye_;
  CubicBernstein<F> gradient_[3];

 private:
  using Kind = LightSource<float>::Kind;
  using I = Batch<std::int32_t, N>;
  /// Least distance of a point light, in lengths of the way through the cell.
  static constexpr float nearest_light = 8;

  void begin_gradients(M lanes, const CubicBernstein<F> (&gradient)[3]) noexcept {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 4; ++k) {
        gradient_[c].b[k] = select(lanes, gradient[c].b[k], gradient_[c].b[k]);
      }
    }
  }
  void begin_places(M lanes, const Vec3<F>& entry, F length) noexcept {
    if (light_.points == 0) return;
    for (int c = 0; c < 3; ++c) entry_[c] = select(lanes, entry[c], entry_[c]);
    length_ = select(lanes, length, length_);
  }
  [[gnu::noinline]] void begin_factor(M lanes, const CubicBernstein<F>& magnitude) noexcept {
    for (int k = 0; k < 4; ++k) magnitude_.b[k] = select(lanes, magnitude.b[k], magnitude_.b[k]);
    const F largest = max(abs(magnitude_.hull_min()), abs(magnitude_.hull_max()));
    const F error = F(32 * rounding_unit<float> + gradient_rounding<float>) * largest;
    magnitude_error_ = select(lanes, error, magnitude_error_);
    factor_ = find_extinction(*light_.factor, magnitude_.b[0], lanes, interval_);
    find_factor_end(lanes, F(0));
  }

  /// Returns the extinction at u of a piece, where the data have this value.
  F extinction(const SpanLanes<float, N>& span, F value, F u) const noexcept {
    const ExtinctionInterval<F>& interval = span.extinction;
    const F result = max(interval.at_lower + interval.slope * (value - interval.lower), F(0));
    return light_.factor == nullptr ? result : result * factor_at(evaluate(part_, u));
  }
  F factor_at(F magnitude) const noexcept { return factor_.bounded(magnitude); }
  /// Finds where the magnitude leaves its interval of the factor, or turns, behind `from`.
  [[gnu::noinline]] void find_factor_end(M lanes, F from) noexcept {
    const PieceEnd<F> end = piece_end(restrict_to(magnitude_, min(from, F(1)), F(1)), factor_.lower,
                                      factor_.upper, magnitude_error_, lanes);
    // Every piece goes on for a little, so that none is empty.
    const F place = from + max((F(1) - from) * end.place, F(2e-6f));
    factor_end_ = select(lanes, select(end.place < F(1), place, F(2)), factor_end_);
    factor_crosses_ = (factor_crosses_ & !lanes) | (lanes & end.crosses);
    factor_rises_ = (factor_rises_ & !lanes) | (lanes & end.rising);
    factor_known_ = (factor_known_ & !lanes) | (lanes & end.found);
  }

  /// Sets the gradients on the share [from, to] of the lanes' cells.
  void set_along(F from, F to, GradientStretch<F>& result) const noexcept {
    // By two cuts, whose rounding is part of gradient_rounding. At 1 a cut does not give the same
    // to the bit.
    const F beginning = from / max(to, F(smallest_normal<float>));
    const M ends = to < F(1);
    const bool cuts_end = any(ends), cuts_beginning = any(from > F(0));
    for (int c = 0; c < 3; ++c) {
      CubicBernstein<F>& f = result.component[c];
      for (int k = 0; k < 4; ++k) f.b[k] = gradient_[c].b[k];
      if (cuts_end) {
        const CubicBernstein<F> front = cut(f, to).front;
        for (int k = 0; k < 4; ++k) f.b[k] = select(ends, front.b[k], f.b[k]);
      }
      if (cuts_beginning) f = cut(f, beginning).back;
    }
    result.to_eye = to_eye_;
    if (light_.points > 0) {
      result.middle = entry_ - to_eye_ * (F(0.5f) * (from + to) * length_);
      result.half_length = F(0.5f) * (to - from) * length_;
    }
  }

  static Vec3<F> place_of(const LightSource<float>& light) noexcept {
    return {F(light.place.x), F(light.place.y), F(light.place.z)};
  }
  /// From the lanes' cells to the nearest point light.
  F distance_to_lights() const noexcept {
    F nearest(std::numeric_limits<float>::infinity());
    for (int i = 0; i < light_.lights; ++i) {
      if (light_.light[i].kind != Kind::point) continue;
      nearest = min(nearest, length(place_of(light_.light[i]) - entry_) - length_);
    }
    return nearest;
  }
  /// The largest square of the distance of a point light over the smallest one, on a stretch.
  F turns_of_distance(const GradientStretch<F>& along) const noexcept {
    F most(1);
    for (int i = 0; i < light_.lights; ++i) {
      if (light_.light[i].kind != Kind::point) continue;
      const F away = length(place_of(light_.light[i]) - along.middle);
      const F ratio =
          (away + along.half_length) / max(away - along.half_length, F(smallest_normal<float>));
      most = max(most, ratio * ratio);
    }
    return most;
  }

  /// Returns the first place behind `from` where g·l of any light, or g·h, changes its sign; 2:
  /// none.
  [[gnu::flatten, gnu::noinline]] F next_kink(M lanes, F from) const noexcept {
    F nearest(2);
    from = min(from, F(1));
    const GradientStretch<F> whole = around(F(0));
    const auto put = [&](M ends, F place) noexcept {
      nearest = select(ends, min(nearest, from + (F(1) - from) * place), nearest);
    };
    const auto look_at = [&](const CubicBernstein<F>& f, auto&& moved) noexcept {
      const F size = max(abs(f.hull_min()), abs(f.hull_max()));
      const M straddles = lanes & (f.hull_min() < F(0)) & (f.hull_max() > F(0));
      if (none(straddles)) return;
      const M rises = f.b[0] < F(0);
      const F far = F(4) * size;
      const PieceEnd<F> end = piece_end(f, select(rises, -far, F(0)), select(rises, F(0), far),
                                        F(1e-6f) * size, straddles);
      // An extremum ends a piece too, and the next one begins there.
      put(straddles & (end.place < F(1)), moved(end));
    };
    const auto here = [](const PieceEnd<F>& end) noexcept { return end.place; };
    const bool highlights = has_kink_in_highlight(light_.reflection);
    const bool begun = any(from > F(0));
    const auto left_along = [&](const Vec3<F>& direction) noexcept {
      const CubicBernstein<F> f = whole.along(direction);
      return begun ? restrict_to(f, from, F(1)) : f;
    };
    for (int i = 0; i < light_.lights; ++i) {
      if (light_.light[i].kind == Kind::point) {
        GradientStretch<F> left;
        set_along(from, F(1), left);
        look_at_point(left, light_.light[i], look_at);
        continue;
      }
      const LightDirections<F> to = directions(light_.light[i], Vec3<F>{}, to_eye_);
      look_at(left_along(to.light), here);
      if (highlights && light_.light[i].kind != Kind::head) look_at(left_along(to.half), here);
    }
    return nearest;
  }

  /// Looks at g·p of a point light, p = P - x: a polynomial of degree 4. The cubic that has, of its
  /// Bernstein coefficients b, b_0, (4 b_1 - b_0) / 3, (4 b_3 - b_4) / 3 and b_4 differs from it by
  /// u² (1 - u)² times their fourth difference. That is small where the light is far away. Newton's
  /// steps go from the cubic's zero to that of g·p.
  template <class LookAt>
  void look_at_point(const GradientStretch<F>& along, const LightSource<float>& light,
                     const LookAt& look_at) const noexcept {
    const Vec3<F> to_middle = place_of(light) - along.middle;
    const Vec3<F> half = along.to_eye * along.half_length;
    const CubicBernstein<F> first = along.along(to_middle - half);
    const CubicBernstein<F> last = along.along(to_middle + half);
    const F b[5] = {first.b[0], F(0.75f) * first.b[1] + F(0.25f) * last.b[0],
                    F(0.5f) * (first.b[2] + last.b[1]),
                    F(0.25f) * first.b[3] + F(0.75f) * last.b[2], last.b[3]};
    constexpr float third = 1.0f / 3;
    look_at(
        CubicBernstein<F>{
            {b[0], F(third) * (F(4) * b[1] - b[0]), F(third) * (F(4) * b[3] - b[4]), b[4]}},
        [&](const PieceEnd<F>& end) noexcept {
          F at = end.place;
          for (int step = 0; step < 2; ++step) {
            const CubicBernstein<F> low{{b[0], b[1], b[2], b[3]}}, high{{b[1], b[2], b[3], b[4]}};
            const F lower = evaluate(low, at), upper = evaluate(high, at);
            const F value = interpolate(lower, upper, at), slope = F(4) * (upper - lower);
            const F move = value / select(slope == F(0), F(1), slope);
            const M steps = end.crosses & (abs(move) <= F(0.125f));
            at = select(steps, clamp(at - move, F(0), F(1)), at);
          }
          return at;
        });
  }

  const PacketLight& light_;
  CubicBernstein<F> magnitude_;  ///< if there is a factor of it
  float inverse_light_;          ///< 1 / the brightest factor of a color
  // Of the lanes' cells, if there is a factor of the magnitude:
  F magnitude_error_{0};          ///< what it may be off by
  I interval_{0};                 ///< of the factor, in which the next piece is
  ExtinctionInterval<F> factor_;  ///< that interval
  F factor_end_{2};               ///< where the next piece has to end for it; 2: nowhere
  M factor_crosses_{false}, factor_rises_{false}, factor_known_{true};
  CubicBernstein<F> part_;  ///< the magnitude on the piece that weaken() was given last
  // Of the lanes' cells, if there are point lights:
  Vec3<F> entry_{F(0), F(0), F(0)};  ///< in the world, from the middle of the grid
  F length_{1};                      ///< of the way through them, world length
  F kink_{2};
};

}  // namespace pellucid
#endif
