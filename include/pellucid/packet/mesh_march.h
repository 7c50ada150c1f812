// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/mesh_interface.h"
#include "pellucid/render/integrate_mesh_ray.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

template <int N>
PELLUCID_ALWAYS_INLINE Vec3<Batch<double, N>> gather_point(const Vec3<double>* point,
                                                           Batch<std::int32_t, N> index) noexcept {
  const double* base = &point->x;
  const Batch<std::int32_t, N> at = index + (index << 1);
  return {gather(base, at), gather(base + 1, at), gather(base + 2, at)};
}

/// What rays find ahead of them: spans of linear data, those of a step beside each other.
template <int N>
struct MeshSpanRows {
  static constexpr int steps = 24;
  static constexpr int size = steps * N;

  // In binary32, for the pieces: the data at both ends, how far they are off, and world lengths: of
  // the span, of the ray from its begin on, of how far its ends are off.
  float front[size], back[size], rounding[size], length[size], left[size], place_error[size];
  // As they are, for what is handed back.
  double exact_front[size], exact_back[size], exact_length[size], error[size];
  std::int32_t code[size];  ///< SpanNote
};

/// What is known of a span beside its numbers.
struct SpanNote {
  static constexpr std::int32_t handed_back = 1, overlaps = 2;
};

/// Rays in lanes through a mesh, some steps at a time.
template <int N>
class MeshMarch {
 public:
  using D = Batch<double, N>;
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Rows = MeshSpanRows<N>;

  MeshMarch(const PellucidMeshJob& job, const PellucidMeshRay* rays, int count) noexcept
      : mesh_(*static_cast<const Tetrahedra*>(job.mesh)),
        field_(static_cast<const MeshFields*>(job.fields)->channel[0]),
        fields_(*static_cast<const MeshFields*>(job.fields)),
        walk_(mesh_, view_) {
    for (int l = 0; l < N; ++l) {
      const PellucidMeshRay& ray = rays[l < count ? l : 0];
      ray_[l] = static_cast<const MeshRay*>(ray.ray);
      next_hit_[l] = 0;
    }
    const auto load = [&](auto&& number) {
      double of_lane[N];
      for (int l = 0; l < N; ++l) of_lane[l] = number(ray_[l]->view);
      return D::load(of_lane);
    };
    using View = RayView<double>;
    for (int a = 0; a < 3; ++a) {
      view_.origin[a] = load([a](const View& v) { return v.origin[a]; });
      view_.x[a] = load([a](const View& v) { return v.x[a]; });
      view_.y[a] = load([a](const View& v) { return v.y[a]; });
      view_.t[a] = load([a](const View& v) { return v.t[a]; });
    }
    view_.t_origin = load([](const View& v) { return v.t_origin; });
    view_.blur = load([](const View& v) { return v.blur; });
    double end[N];
    for (int l = 0; l < N; ++l) end[l] = rays[l < count ? l : 0].end;
    end_ = D::load(end);
    begin_paths(M::from_bits(count == N ? (1u << N) - 1u : (1u << count) - 1u));
  }

  M walking{false};  ///< whether a lane has tetrahedra ahead

  /// Rays that are not to be followed any further.
  void stop(M lanes) noexcept { walking = walking & !lanes; }

  /// Goes on until the rows are full or all rays are at their end. Bit s of a lane of the result:
  /// its s-th row holds a span that absorbs. absorbs(least, most, note): whether data in that range
  /// do, and what is to be noted of them.
  template <class Absorbs>
  I fill(Rows& rows, std::int32_t* cells, Absorbs&& absorbs) noexcept {
    I found(0), seen(0);
    for (int s = 0; s < Rows::steps && any(walking); ++s) {
      const M lanes = step(rows, s * N, absorbs);
      seen += select(walking, I(1), I(0));
      found = found + select(lanes, I(1 << s), I(0));
      const M ended = walking & (walk_.ahead() < I(0));
      if (any(ended)) end_paths(ended);
    }
    std::int32_t of_lane[N];
    seen.store(of_lane);
    for (int l = 0; l < N; ++l) cells[l] += of_lane[l];
    return found;
  }

 private:
  /// One tetrahedron of each lane.
  template <class Absorbs>
  [[gnu::flatten]] M step(Rows& rows, int at, Absorbs&& absorbs) noexcept {
    const M on = walking;
    const I tetrahedron = select(on, walk_.ahead() >> 2, I(0));
    walk_.step(
        on, [&](I point) noexcept { return field_.per_cell ? D(0) : gather(field_.value, point); });
    const SeenFace<D>& face = walk_.face();
    D weight[3];
    face.weights(weight);
    const F off = convert<float>(face.weight_error(view_.blur));
    const auto interpolate = [&](const D& a, const D& b, const D& c) noexcept {
      return a + multiply_add(weight[1], b - a, weight[2] * (c - a));
    };
    const auto range = [](const D& a, const D& b, const D& c) noexcept {
      return convert<float>(max(a, max(b, c)) - min(a, min(b, c)));
    };
    const SeenPoint<D>* p = face.seen;
    const D* v = face.carried;
    const D t = interpolate(p[0].t, p[1].t, p[2].t);
    const F t_error = off * range(p[0].t, p[1].t, p[2].t) + blur();
    D value, front_value;
    F value_error(0);
    if (field_.per_cell) {
      value = front_value = gather(field_.value, tetrahedron);
    } else {
      value = interpolate(v[0], v[1], v[2]);
      value_error = off * range(v[0], v[1], v[2]);
      front_value = value_;
    }

    // As span_between() and for_each_mesh_span() in traverse/mesh_spans.h.
    const D begin = max(t_, front_);
    const D share = select((t_ < front_) & (front_ < t), (front_ - t_) / (t - t_), D(0));
    const D at_begin = front_value + share * (value - front_value);
    const F most = front_error_ + t_error_ + t_error;
    const M overlaps = on & (front_ > D(0)) & (convert<float>(front_ - min(t_, t)) > most);
    const M ahead = on & (begin < t);
    const F error = max(value_error_, value_error);

    constexpr float u = rounding_unit<float>;
    const F f = convert<float>(at_begin), b = convert<float>(value);
    const F rounding = F(4 * u) * max(abs(f), abs(b)) + error;
    I note = select(overlaps, I(SpanNote::overlaps), I(0));
    const M found = (ahead & absorbs(min(f, b) - rounding, max(f, b) + rounding, note)) | overlaps;
    if (any(found)) {
      f.store(rows.front + at);
      b.store(rows.back + at);
      rounding.store(rows.rounding + at);
      const D length = max(t - begin, D(0));
      convert<float>(length).store(rows.length + at);
      convert<float>(end_ - begin).store(rows.left + at);
      (t_error_ + t_error).store(rows.place_error + at);
      at_begin.store(rows.exact_front + at);
      value.store(rows.exact_back + at);
      length.store(rows.exact_length + at);
      convert<double>(error).store(rows.error + at);
      note.store(rows.code + at);
    }
    const M forward = ahead | overlaps;
    front_ = select(forward, max(t, begin), front_);
    front_error_ = select(forward, t_error, front_error_);
    t_ = select(on, t, t_);
    value_ = select(on, value, value_);
    t_error_ = select(on, t_error, t_error_);
    value_error_ = select(on, value_error, value_error_);
    return found;
  }

  F blur() const noexcept { return convert<float>(view_.blur); }

  /// Takes the hits out by which the lanes' rays have left the mesh, and begins what comes next.
  void end_paths(M lanes) noexcept {
    std::int32_t left_by[N];
    walk_.left_by().store(left_by);
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      const MeshRay& ray = *ray_[l];
      for (int k = next_hit_[l]; k < ray.count; ++k) {
        if (ray.hits[k].code == left_by[l]) ray.hits[k].code = Tetrahedron::outside;
      }
    }
    begin_paths(lanes);
  }

  /// Begins at the next hits of the lanes' rays; those without one are not walking any more.
  void begin_paths(M lanes) noexcept {
    struct {
      std::int32_t point[3][N], code[N];
      double x[3][N], y[3][N], t[3][N], area[3][N], carried[3][N], at[N], value[N];
      float t_error[N], value_error[N];
    } all{};
    unsigned begun = 0, left_turned = 0;
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      const MeshRay& ray = *ray_[l];
      while (next_hit_[l] < ray.count && ray.hits[next_hit_[l]].code == Tetrahedron::outside) {
        ++next_hit_[l];
      }
      if (next_hit_[l] == ray.count) continue;
      const std::int32_t code = ray.hits[next_hit_[l]++].code;
      SeenFace<double> face;
      see_face(mesh_, ray.view, code, face);
      const MeshPlace place = detail::place_on(face, fields_, ray.view.blur);
      begun |= 1u << l;
      if (face.left) left_turned |= 1u << l;
      all.code[l] = code;
      for (int i = 0; i < 3; ++i) {
        all.point[i][l] = face.point[i];
        all.x[i][l] = face.seen[i].x;
        all.y[i][l] = face.seen[i].y;
        all.t[i][l] = face.seen[i].t;
        all.area[i][l] = face.area[i];
        all.carried[i][l] = field_.per_cell ? 0 : field_.value[face.point[i]];
      }
      all.at[l] = place.t;
      all.t_error[l] = static_cast<float>(place.t_error);
      all.value[l] = field_.per_cell ? 0 : place.value[0];
      all.value_error[l] = field_.per_cell ? 0 : static_cast<float>(place.value_error[0]);
    }
    const M on = M::from_bits(begun);
    walking = (walking & !lanes) | on;
    if (begun == 0) return;
    SeenFace<D> face;
    for (int i = 0; i < 3; ++i) {
      face.point[i] = I::load(all.point[i]);
      face.seen[i] = {D::load(all.x[i]), D::load(all.y[i]), D::load(all.t[i])};
      face.area[i] = D::load(all.area[i]);
      face.carried[i] = D::load(all.carried[i]);
    }
    face.left = M::from_bits(left_turned);
    walk_.enter(on, face, I::load(all.code));
    t_ = select(on, D::load(all.at), t_);
    value_ = select(on, D::load(all.value), value_);
    t_error_ = select(on, F::load(all.t_error), t_error_);
    value_error_ = select(on, F::load(all.value_error), value_error_);
  }

  const Tetrahedra& mesh_;
  const MeshField field_;
  const MeshFields& fields_;
  const MeshRay* ray_[N];
  std::int32_t next_hit_[N];
  RayView<D> view_;
  D end_;
  MeshWalk<D> walk_;

  // Where the lanes are: on the face reached last, and how far along the ray all in all.
  D t_, value_;
  F t_error_, value_error_;
  D front_{0};
  F front_error_{0};
};

}  // namespace pellucid
#endif
