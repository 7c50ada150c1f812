// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/mesh/face_hit.h"
#include "pellucid/packet/mesh/mesh_rays.h"
#include "pellucid/packet/mesh/mesh_rows.h"
#include "pellucid/traverse/mesh_spans.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes through a mesh, in numbers S, tetrahedron by tetrahedron. Values: what they see of
/// it, as MeshVariable.
template <class S, int N, class Values>
class MeshMarch {
 public:
  using T = Batch<S, N>;
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Rows = typename Values::Rows;
  using Span = typename Values::Span;

  MeshMarch(const PellucidMeshJob& job, int first, int count) noexcept
      : rays(job, first, count),
        values_(job),
        walk_(*seen(job.mesh)),
        blur_(convert<float>(rays.blur)),
        t_blur_(convert<float>(rays.t_blur)),
        front_(rays.from) {
    begin_paths(rays.meets & !rays.crowded);
  }

  MeshRays<S, N> rays;
  M walking{false};  ///< whether a lane has tetrahedra ahead
  /// Total error of positions that no neighboring span compensates: where vacuum begins and ends,
  /// and where rounding has left a span no length.
  F beside_vacuum{0};
  /// And those of the mesh, where what was passed over may have absorbed something.
  F passed_ends{0};

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
    values_.cross(walk_.dropped());
  }
  [[gnu::flatten]] void load_ahead() noexcept { walk_.load_ahead(); }
  [[gnu::flatten]] void see_ahead() noexcept {
    walk_.see_ahead([this](I point, ProjectedPoint<T>& q, T& v) noexcept { see(point, q, v); });
  }
  /// Puts what lies in the tetrahedra that were crossed down in row s, and begins anew where rays
  /// have left the mesh. Returns the lanes whose span absorbs: absorbs(span, rows, at, note),
  /// whether it does, and what is to be noted of it in the rows.
  template <class Absorbs>
  M put_down(Rows& rows, int s, Absorbs&& absorbs) noexcept {
    const M found = find_span(rows, s * N, absorbs);
    stop(t_ >= rays.until);
    const M ended = walking & (walk_.ahead() < I(0));
    if (any(ended)) end_paths(ended);
    return found;
  }

 private:
  template <class Absorbs>
  [[gnu::flatten]] M find_span(Rows& rows, int at, Absorbs&& absorbs) noexcept {
    const M on = walking;
    const SeenFace<T>& face = walk_.face();
    const FaceHit<S, N> place(face, blur_);
    const ProjectedPoint<T>* p = face.seen;
    F t_error;
    const T t = place.interpolate(p[0].t, p[1].t, p[2].t, t_error);
    t_error += known_to(t);
    auto&& span = values_.reach(face, place, tetrahedron_);

    // As span_between() and for_each_mesh_span() in traverse/mesh_spans.h.
    T begin = t_, end = t;
    M overlaps(false);
    F both = t_error_ + t_error, at_cuts(0);
    const M beyond = on & (t > rays.until);
    if (any(beyond)) {
      end = select(beyond, max(rays.until, t_), t);
      values_.cut_behind(beyond & (t_ < t), span, (end - t_) / (t - t_));
      both = select(beyond, both + both, both);
      at_cuts = select(beyond, rounded(rays.until), F(0));
    }
    const M behind = on & (min(t_, end) < front_);
    if (any(behind)) {
      begin = max(t_, front_);
      values_.cut(span, select((t_ < front_) & (front_ < end), (front_ - t_) / (end - t_), T(0)));
      const F most = front_error_ + t_error_ + t_error;
      overlaps = behind & (front_ > rays.from) & (convert<float>(front_ - min(t_, end)) > most);
      // What the data are where the span is cut moves with both faces, and no neighbour makes good
      // for it: twice what they are charged where it is whole. Where parts begin and end is rounded
      // to S.
      both = select(behind, both + both, both);
      at_cuts += select(behind & !(front_ > rays.from), rounded(rays.from), F(0));
    }
    const M ahead = on & (begin < end);
    const M vacuum = values_.vacuum(span);
    I note = select(overlaps, I(SpanNote::overlaps), I(0));
    const M found = (ahead & !vacuum & absorbs(span, rows, at, note)) | overlaps;
    if (any(found)) {
      const T length = max(end - begin, T(0));
      values_.put_down(span, length, rows, at);
      convert<float>(length).store(rows.length + at);
      convert<float>(rays.end - begin).store(rows.left + at);
      const F at_ends = off_at_ends(t_error);
      const bool steps = values_.steps();
      (steps ? F(0) : both).store(rows.position_error + at);
      ((steps ? both : at_ends) + at_cuts).store(rows.end_error + at);
      note.store(rows.code + at);
    }
    if constexpr (Values::passes_over_light) {
      passed_ends += select(ahead & !(vacuum | found), off_at_ends(t_error), F(0));
    }
    // What lies before the part, or behind it, is nothing to it.
    const F off = t_error_ + t_error;
    const M outside = (convert<float>(rays.from - max(t_, t)) > off) |
                      (convert<float>(min(t_, t) - rays.until) > off);
    beside_vacuum += select(on & (vacuum | !ahead) & !outside, off, F(0));
    // Past a hit that may not be the way's own: for a ray by itself to find out.
    const M past =
        on & (t - T(4) * (rays.t_blur + T(rays.t_rounding)) > next_t_) & (walk_.ahead() >= I(0));
    if (any(past)) give_up(past);
    const M forward = ahead | overlaps;
    front_ = select(forward, max(end, begin), front_);
    front_error_ = select(forward, t_error, front_error_);
    t_ = select(on, t, t_);
    t_error_ = select(on, t_error, t_error_);
    values_.go_on(on, span);
    // Behind vacuum the data begin anew.
    first_ = vacuum;
    return found;
  }

  void see(I point, ProjectedPoint<T>& seen, T& carried) noexcept {
    rays.see(point, seen, carried);
    values_.see(point);
  }

  /// Returns the error of a parameter by rounding to S.
  static F rounded(const T& t) noexcept {
    return F(static_cast<float>(rounding_unit<S>)) * abs(convert<float>(t));
  }

  /// Returns the error of those ends of a span that no neighbor compensates.
  F off_at_ends(const F& t_error) const noexcept {
    const M leaves = walk_.ahead() < I(0);
    return select(first_, t_error_, F(0)) + select(leaves, t_error, F(0));
  }

  /// Returns the error of a parameter that is interpolated, besides that of the weights: those of
  /// the points are rounded, and so is the result.
  F known_to(const T& t) const noexcept {
    return t_blur_ + F(static_cast<float>(2.1 * static_cast<double>(rounding_unit<S>))) *
                         abs(convert<float>(t));
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
    const FaceHit<S, N> place(face, blur_);
    const ProjectedPoint<T>* p = face.seen;
    F t_error;
    const T t = place.interpolate(p[0].t, p[1].t, p[2].t, t_error);
    next_t_ = select(on, T::load(all.next), next_t_);
    t_ = select(on, t, t_);
    t_error_ = select(on, t_error + known_to(t), t_error_);
    values_.begin(on, face, place);
    first_ = first_ | on;
    walk_.enter(on, face, I::load(all.code),
                [this](I point, ProjectedPoint<T>& q, T& w) noexcept { see(point, q, w); });
  }

  Values values_;
  MeshWalk<T> walk_;
  F blur_, t_blur_;
  I tetrahedron_{0};  ///< that is crossed

  // Where the lanes are: on the face reached last, and how far along the ray all in all.
  T t_;
  F t_error_;
  T next_t_;       ///< of the next hit that is not used up
  M first_{true};  ///< whether there is nothing in front of what comes
  T front_;
  F front_error_{0};
};

}  // namespace pellucid
#endif
