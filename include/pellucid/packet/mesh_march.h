// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/mesh_rays.h"
#include "pellucid/traverse/mesh_spans.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// What rays find ahead of them: spans of linear data, those of a step beside each other.
template <class S, int N>
struct MeshSpanRows {
  static constexpr int steps = 24;
  static constexpr int size = steps * N;

  // In binary32, for the pieces: the data at both ends, how far they are off, and world lengths: of
  // the span, of the ray from its begin on, of how far its ends are off where the data go on as
  // they are there, and where they do not.
  float front[size], back[size], rounding[size], length[size], left[size], place_error[size],
      end_error[size];
  std::int32_t code[size];  ///< SpanNote

  /// The same in numbers S, for what is handed back: in binary32 there is nothing to add.
  static constexpr bool more_exact = !std::is_same_v<S, float>;
  struct Exact {
    S front[size], back[size], length[size];
    float error[size];
  };
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<more_exact, Exact, Nothing> exact;
};

/// What is known of a span beside its numbers.
struct SpanNote {
  static constexpr std::int32_t handed_back = 1, overlaps = 2;
};

/// Rays in lanes through a mesh, in numbers S, tetrahedron by tetrahedron.
template <class S, int N>
class MeshMarch {
 public:
  using T = Batch<S, N>;
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Rows = MeshSpanRows<S, N>;

  MeshMarch(const PellucidMeshJob& job, int first, int count) noexcept
      : rays(job, first, count),
        field_(*static_cast<const MeshField*>(job.field)),
        walk_(*static_cast<const Tetrahedra*>(job.mesh)),
        blur_(convert<float>(rays.blur)),
        t_blur_(convert<float>(rays.t_blur)),
        front_(rays.eye) {
    begin_paths(rays.meets & !rays.crowded);
  }

  MeshRays<S, N> rays;
  M walking{false};  ///< whether a lane has tetrahedra ahead
  /// How far off are places that no span makes good for, all in all: where vacuum begins and ends,
  /// and where rounding has left a span no length.
  F beside_vacuum{0};

  /// Rays that are not to be followed any further.
  void stop(M lanes) noexcept { walking = walking & !lanes; }

  /// Rays of which this will not tell anything.
  void give_up(M lanes) noexcept {
    rays.crowded = rays.crowded | lanes;
    stop(lanes);
  }

  /// Gives up rays that have gone through more tetrahedra than there are: none should.
  void stop_lost(const I& cells) noexcept { give_up(walking & (cells > I(rays.tetrahedra()))); }

  // A step of each lane, in parts as those of MeshWalk.

  [[gnu::flatten]] void cross() noexcept {
    tetrahedron_ = select(walking, walk_.ahead() >> 2, I(0));
    walk_.cross(walking);
  }
  [[gnu::flatten]] void load_ahead() noexcept { walk_.load_ahead(); }
  [[gnu::flatten]] void see_ahead() noexcept {
    walk_.see_ahead([this](I point, SeenPoint<T>& q, T& v) noexcept { rays.see(point, q, v); });
  }
  /// Puts what lies in the tetrahedra that were crossed down in row s, and begins anew where rays
  /// have left the mesh. Returns the lanes whose span absorbs: absorbs(least, most, note), whether
  /// data in that range do, and what is to be noted of them.
  template <class Absorbs>
  M put_down(Rows& rows, int s, Absorbs&& absorbs) noexcept {
    const M found = find_span(rows, s * N, absorbs);
    const M ended = walking & (walk_.ahead() < I(0));
    if (any(ended)) end_paths(ended);
    return found;
  }

 private:
  template <class Absorbs>
  [[gnu::flatten]] M find_span(Rows& rows, int at, Absorbs&& absorbs) noexcept {
    const M on = walking;
    const SeenFace<T>& face = walk_.face();
    const T sum = face.area[0] + face.area[1] + face.area[2];
    const M flat = !(sum > T(0));
    const T inverse = T(1) / select(flat, T(1), sum);
    const T to_second = select(flat, T(S(1.0 / 3)), face.area[1] * inverse),
            to_third = select(flat, T(S(1.0 / 3)), face.area[2] * inverse);
    F across(0), size(0);
    for (int i = 0; i < 3; ++i) {
      across += abs(convert<float>(face.seen[i].x)) + abs(convert<float>(face.seen[i].y));
      size += convert<float>(face.size[i]);
    }
    const F off =
        select(flat, F(1), interpolation_error<S>(size, across, blur_, convert<float>(inverse)));
    // From the first point's, and how far that may be off.
    const auto interpolate = [&](const T& a, const T& b, const T& c, F& error) noexcept {
      const T second = b - a, third = c - a;
      error = off * convert<float>(abs(second) + abs(third));
      return a + multiply_add(to_second, second, to_third * third);
    };
    const SeenPoint<T>* p = face.seen;
    F t_error, value_error(0);
    const T t = interpolate(p[0].t, p[1].t, p[2].t, t_error);
    t_error += known_to(t);
    T value, front_value;
    if (field_.per_cell) {
      value = front_value = load_cells(tetrahedron_);
    } else {
      value = interpolate(face.carried[0], face.carried[1], face.carried[2], value_error);
      front_value = value_;
    }

    // As span_between() and for_each_mesh_span() in traverse/mesh_spans.h.
    T begin = t_, at_begin = front_value;
    M overlaps(false);
    F both = t_error_ + t_error, at_eye(0);
    const M behind = on & (min(t_, t) < front_);
    if (any(behind)) {
      begin = max(t_, front_);
      const T share = select((t_ < front_) & (front_ < t), (front_ - t_) / (t - t_), T(0));
      at_begin = front_value + share * (value - front_value);
      const F most = front_error_ + t_error_ + t_error;
      overlaps = behind & (front_ > rays.eye) & (convert<float>(front_ - min(t_, t)) > most);
      // What the data are where the span is cut moves with both faces, and no neighbour makes good
      // for it: twice what they are charged where it is whole. Where rays begin is rounded to S.
      both = select(behind, both + both, both);
      at_eye =
          select(behind & !(front_ > rays.eye),
                 F(static_cast<float>(rounding_unit<S>)) * abs(convert<float>(rays.eye)), F(0));
    }
    const M ahead = on & (begin < t);
    const M vacuum = is_nan(front_value + value);
    const F error = max(value_error_, value_error);

    constexpr float u = rounding_unit<float>;
    const F f = convert<float>(at_begin), b = convert<float>(value);
    const F rounding = F(4 * u) * max(abs(f), abs(b)) + error;
    I note = select(overlaps, I(SpanNote::overlaps), I(0));
    const M found =
        (ahead & !vacuum & absorbs(min(f, b) - rounding, max(f, b) + rounding, note)) | overlaps;
    if (any(found)) {
      f.store(rows.front + at);
      b.store(rows.back + at);
      rounding.store(rows.rounding + at);
      const T length = max(t - begin, T(0));
      convert<float>(length).store(rows.length + at);
      convert<float>(rays.end - begin).store(rows.left + at);
      const M leaves = walk_.ahead() < I(0);
      const F at_ends = select(first_, t_error_, F(0)) + select(leaves, t_error, F(0));
      (field_.per_cell ? F(0) : both).store(rows.place_error + at);
      ((field_.per_cell ? both : at_ends) + at_eye).store(rows.end_error + at);
      if constexpr (Rows::more_exact) {
        at_begin.store(rows.exact.front + at);
        value.store(rows.exact.back + at);
        length.store(rows.exact.length + at);
        // Where all that it comes of is equal it is exact.
        const F rounded = F(static_cast<float>(4 * rounding_unit<S>)) * max(abs(f), abs(b));
        const M even = (error == F(0)) & (f == b);
        (error + select(even, F(0), rounded)).store(rows.exact.error + at);
      }
      note.store(rows.code + at);
    }
    beside_vacuum += select(on & (vacuum | !ahead), t_error_ + t_error, F(0));
    // Past a hit that may not be the way's own: for a ray by itself to find out.
    const M past =
        on & (t - T(4) * (rays.t_blur + T(rays.t_rounding)) > next_t_) & (walk_.ahead() >= I(0));
    if (any(past)) give_up(past);
    const M forward = ahead | overlaps;
    front_ = select(forward, max(t, begin), front_);
    front_error_ = select(forward, t_error, front_error_);
    t_ = select(on, t, t_);
    value_ = select(on, value, value_);
    t_error_ = select(on, t_error, t_error_);
    value_error_ = select(on, value_error, value_error_);
    // Behind vacuum the data begin anew.
    first_ = vacuum;
    return found;
  }

  /// How far a parameter that is interpolated is off, beside what the weights are: those of the
  /// points are rounded, and so is the result.
  F known_to(const T& t) const noexcept {
    return t_blur_ + F(static_cast<float>(2.1 * static_cast<double>(rounding_unit<S>))) *
                         abs(convert<float>(t));
  }

  T load_cells(I tetrahedron) const noexcept {
    std::int32_t at[N];
    S value[N];
    tetrahedron.store(at);
    for (int l = 0; l < N; ++l) value[l] = static_cast<S>(field_.value[at[l]]);
    return T::load(value);
  }

  /// Takes the hits out by which the lanes' rays have left the mesh, and begins what comes next.
  void end_paths(M lanes) noexcept {
    std::int32_t left_by[N];
    walk_.left_by().store(left_by);
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      rays.use_up(l, left_by[l]);
    }
    begin_paths(lanes);
  }

  /// Begins at the next hits of the lanes' rays; those without one are not walking any more.
  void begin_paths(M lanes) noexcept {
    struct {
      std::int32_t point[3][N], code[N];
      S x[3][N], y[3][N], t[3][N], area[3][N], size[3][N], value[3][N], next[N];
    } all{};
    unsigned begun = 0, turned = 0;
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      const auto* hit = rays.next(l);
      if (hit == nullptr) continue;
      SeenFace<S> face;
      rays.see(l, hit->code, face);
      begun |= 1u << l;
      if (face.left) turned |= 1u << l;
      all.code[l] = hit->code;
      all.next[l] = rays.next_t(l);
      for (int i = 0; i < 3; ++i) {
        all.point[i][l] = face.point[i];
        all.x[i][l] = face.seen[i].x;
        all.y[i][l] = face.seen[i].y;
        all.t[i][l] = face.seen[i].t;
        all.area[i][l] = face.area[i];
        all.size[i][l] = face.size[i];
        all.value[i][l] = face.carried[i];
      }
    }
    const M on = M::from_bits(begun);
    walking = (walking & !lanes) | on;
    if (begun == 0) return;
    SeenFace<T> face;
    for (int i = 0; i < 3; ++i) {
      face.point[i] = I::load(all.point[i]);
      face.seen[i] = {T::load(all.x[i]), T::load(all.y[i]), T::load(all.t[i])};
      face.area[i] = T::load(all.area[i]);
      face.size[i] = T::load(all.size[i]);
      face.carried[i] = T::load(all.value[i]);
    }
    face.left = M::from_bits(turned);
    T weight[3];
    face.weights(weight);
    const auto interpolate = [&](const T& a, const T& b, const T& c) noexcept {
      return a + multiply_add(weight[1], b - a, weight[2] * (c - a));
    };
    const auto range = [](const T& a, const T& b, const T& c) noexcept {
      return convert<float>(abs(b - a) + abs(c - a));
    };
    const F off = convert<float>(face.error(rays.blur));
    const SeenPoint<T>* p = face.seen;
    const T* v = face.carried;
    next_t_ = select(on, T::load(all.next), next_t_);
    const T t = interpolate(p[0].t, p[1].t, p[2].t);
    t_ = select(on, t, t_);
    value_ = select(on, interpolate(v[0], v[1], v[2]), value_);
    t_error_ = select(on, off * range(p[0].t, p[1].t, p[2].t) + known_to(t), t_error_);
    value_error_ = select(on, off * range(v[0], v[1], v[2]), value_error_);
    first_ = first_ | on;
    walk_.enter(on, face, I::load(all.code),
                [this](I point, SeenPoint<T>& q, T& w) noexcept { rays.see(point, q, w); });
  }

  const MeshField field_;
  MeshWalk<T> walk_;
  F blur_, t_blur_;
  I tetrahedron_{0};  ///< that is crossed

  // Where the lanes are: on the face reached last, and how far along the ray all in all.
  T t_, value_;
  F t_error_, value_error_;
  T next_t_;       ///< of the next hit that is not used up
  M first_{true};  ///< whether there is nothing in front of what comes
  T front_;
  F front_error_{0};
};

}  // namespace pellucid
#endif
