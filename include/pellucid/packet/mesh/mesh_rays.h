// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/mesh_interface.h"
#include "pellucid/simd/batch.h"
#include "pellucid/traverse/boundary_hits.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes as they see a mesh, and where they go through its boundary. What is seen is found
/// in double and rounded to S: places are small, in S too, where they matter, which is close to the
/// ray. Parameters are counted from the ray's closest point to the middle of the mesh's box.
template <class S, int N>
class MeshRays {
 public:
  using T = Batch<S, N>;
  using D = Batch<double, N>;
  using F = Batch<float, N>;
  using M = BatchMask<N>;

  /// Crossing of a ray and the boundary.
  struct Hit {
    S t;
    std::int32_t code;
  };
  /// Largest number of hits of one ray; rays with more are not for lanes.
  static constexpr int max_hits = 48;

  MeshRays(const PellucidMeshJob& job, int first, int count) noexcept
      : mesh_(*seen(job.mesh)), points_(seen(job.points)) {
    const auto load = [this](auto&& number) {
      double of_lane[N];
      for (int l = 0; l < N; ++l) of_lane[l] = number(view_of_[l]);
      return D::load(of_lane);
    };
    using View = RayFrame<double>;
    double eye_at[N], direction[3][N], from_at[N], until_at[N];
    const double extent = length(mesh_.upper - mesh_.lower);
    const double unit = power_of_two_below(1 / extent);
    for (int l = 0; l < N; ++l) {
      const PellucidMeshRay& ray = job.rays[first + (l < count ? l : 0)];
      const Vec3<double> o{ray.origin[0], ray.origin[1], ray.origin[2]},
          d{ray.direction[0], ray.direction[1], ray.direction[2]};
      view_of_[l] = make_ray_frame({o, d}, mesh_.center(), mesh_.coordinate_bound);
      eye_at[l] = -view_of_[l].t_origin;
      // What is beyond the last number there is as good as infinite.
      constexpr auto last = static_cast<double>(std::numeric_limits<S>::max());
      from_at[l] = min(eye_at[l] + ray.begin, last);
      until_at[l] = min(eye_at[l] + ray.end, last);
      from_of_[l] = static_cast<S>(from_at[l]);
      until_of_[l] = static_cast<S>(until_at[l]);
      view_of_[l].t_origin = 0;
      // Places across the ray in units of about the mesh's size: products of small ones must not
      // underflow in binary32.
      view_of_[l].x = view_of_[l].x * unit;
      view_of_[l].y = view_of_[l].y * unit;
      view_of_[l].position_error *= unit;
      for (int a = 0; a < 3; ++a) direction[a][l] = d[a];
      hits_[l] = 0;
      next_[l] = 0;
    }
    for (int a = 0; a < 3; ++a) {
      view_.origin[a] = load([a](const View& v) { return v.origin[a]; });
      view_.x[a] = load([a](const View& v) { return v.x[a]; });
      view_.y[a] = load([a](const View& v) { return v.y[a]; });
      view_.t[a] = load([a](const View& v) { return v.t[a]; });
      direction_[a] = convert<float>(D::load(direction[a]));
    }
    blur = convert<S>(load([](const View& v) { return v.position_error; }));
    t_blur = blur * T(static_cast<S>(1 / unit));
    // A parameter is no farther from the middle than the diagonal.
    t_rounding = static_cast<S>(static_cast<double>(rounding_unit<S>) * extent);
    eye = convert<S>(D::load(eye_at));
    from = convert<S>(D::load(from_at));
    until = convert<S>(D::load(until_at));
    find_hits(M::from_bits(count == N ? (1u << N) - 1u : (1u << count) - 1u));
  }

  T blur;          ///< how far what is seen may be off across the ray, beside its rounding to S, in
                   ///< the units of such places
  T t_blur;        ///< and along it, in world units
  S t_rounding;    ///< what rounding to S takes from a parameter at most
  T eye;           ///< the parameter of where the rays begin
  T from, until;   ///< those between which their parts are
  T begin, end;    ///< where the parts may be in the mesh
  M meets{false};  ///< whether they meet it
  M crowded{false};  ///< whether they are not for lanes, as with more hits than there is room for

  std::int32_t tetrahedra() const noexcept { return mesh_.count; }

  /// A point as the rays see it, and its value.
  PELLUCID_ALWAYS_INLINE void see(Batch<std::int32_t, N> point, ProjectedPoint<T>& seen,
                                  T& value) const noexcept {
    D number[4];
    load_records<4>(&points_->position.x, point, number);
    const ProjectedPoint<D> exact = view_.project({number[0], number[1], number[2]});
    seen = {convert<S>(exact.x), convert<S>(exact.y), convert<S>(exact.t)};
    value = convert<S>(number[3]);
  }

  /// The next hit of a lane's ray, or null.
  const Hit* next(int lane) noexcept {
    int& n = next_[lane];
    while (n < hits_[lane] && hit_[lane][n].code == Tetrahedron::outside) ++n;
    return n < hits_[lane] ? &hit_[lane][n++] : nullptr;
  }
  /// The parameter of the next hit, which stays.
  S next_t(int lane) const noexcept {
    int n = next_[lane];
    while (n < hits_[lane] && hit_[lane][n].code == Tetrahedron::outside) ++n;
    return n < hits_[lane] ? hit_[lane][n].t : std::numeric_limits<S>::max();
  }
  /// Takes a hit out by which the ray has left.
  void use_up(int lane, std::int32_t code) noexcept {
    for (int n = next_[lane]; n < hits_[lane]; ++n) {
      if (hit_[lane][n].code == code) hit_[lane][n].code = Tetrahedron::outside;
    }
  }
  /// The face of a hit, as the lane's ray sees it.
  void see(int lane, std::int32_t code, SeenFace<S>& face) const noexcept {
    see_face(
        mesh_, code,
        [&](std::int32_t point) noexcept {
          const ProjectedPoint<double> p = view_of_[lane].project(points_[point].position);
          return ProjectedPoint<S>{static_cast<S>(p.x), static_cast<S>(p.y), static_cast<S>(p.t)};
        },
        face);
    for (int i = 0; i < 3; ++i) {
      face.carried[i] = static_cast<S>(points_[face.point[i]].value);
    }
  }

 private:
  /// The largest power of two <= x, for normal x > 0.
  static double power_of_two_below(double x) noexcept {
    double power = 1;
    while (power > x) power *= 0.5;
    while (2 * power <= x) power *= 2;
    return power;
  }

  /// Which rays may meet the box. Boxes are larger than what is in them by 2^-21 of the largest
  /// coordinate; where the ray meets a plane is known to 8 u of the way.
  M meet(const BoundaryNode& box, const F (&origin)[3], const F (&inverse)[3],
         const M (&still)[3]) const noexcept {
    F first(-std::numeric_limits<float>::max()), last(std::numeric_limits<float>::max());
    M inside(true);
    for (int a = 0; a < 3; ++a) {
      const F lower(box.lower[a]), upper(box.upper[a]);
      const F p = (lower - origin[a]) * inverse[a], q = (upper - origin[a]) * inverse[a];
      if (any(still[a])) {
        inside = inside & ((!still[a]) | ((origin[a] >= lower) & (origin[a] <= upper)));
      }
      first = select(still[a], first, max(first, min(p, q)));
      last = select(still[a], last, min(last, max(p, q)));
    }
    const F slack = F(8 * rounding_unit<float>) * (abs(first) + abs(last));
    return inside & (first - slack <= last);
  }

  [[gnu::flatten]] void find_hits(M on) noexcept {
    F origin[3], inverse[3];
    M still[3];
    for (int a = 0; a < 3; ++a) {
      origin[a] = convert<float>(view_.origin[a]);
      still[a] = abs(direction_[a]) < F(1e-30f);
      inverse[a] = F(1) / select(still[a], F(1), direction_[a]);
    }
    std::int32_t stack[64];
    int open = 0;
    stack[open++] = 0;
    while (open > 0) {
      const BoundaryNode& node = mesh_.tree[stack[--open]];
      if (none(on & meet(node, origin, inverse, still))) continue;
      if (node.count == 0) {
        stack[open++] = node.first;
        stack[open++] = node.first + 1;
        continue;
      }
      for (std::int32_t i = 0; i < node.count; ++i) try_face(on, mesh_.boundary[node.first + i]);
    }
    S first[N], last[N];
    unsigned met = 0;
    for (int l = 0; l < N; ++l) {
      first[l] = last[l] = S(0);
      if (hits_[l] == 0) continue;
      met |= 1u << l;
      // Mostly two; in order of the parameter, then of the face, as MeshHit's.
      Hit* const hit = hit_[l];
      for (int n = 1; n < hits_[l]; ++n) {
        const Hit moved = hit[n];
        int k = n;
        for (; k > 0 && (moved.t < hit[k - 1].t ||
                         (moved.t == hit[k - 1].t && moved.code < hit[k - 1].code));
             --k) {
          hit[k] = hit[k - 1];
        }
        hit[k] = moved;
      }
      first[l] = max(hit[0].t, from_of_[l]);
      last[l] = min(hit[hits_[l] - 1].t, until_of_[l]);
    }
    begin = T::load(first);
    end = T::load(last);
    meets = M::from_bits(met) & (begin <= end);
  }

  void try_face(M on, std::int32_t code) noexcept {
    const Tetrahedron& t = mesh_.tetrahedron[code >> 2];
    SeenFace<T> face;
    for (int i = 0; i < 3; ++i) {
      const Vec3<double>& p = points_[t.corner[corner_of_face(code & 3, i)]].position;
      const ProjectedPoint<D> exact = view_.project({D(p.x), D(p.y), D(p.z)});
      face.seen[i] = {convert<S>(exact.x), convert<S>(exact.y), convert<S>(exact.t)};
    }
    const M through = on & turn_around_ray(face);
    if (none(through)) return;
    T weight[3];
    face.weights(weight);
    const T at = face.seen[0].t + (weight[1] * (face.seen[1].t - face.seen[0].t) +
                                   weight[2] * (face.seen[2].t - face.seen[0].t));
    for (unsigned left = bits(through); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      if (hits_[l] == max_hits) {
        crowded = crowded | M::from_bits(1u << l);
      } else {
        hit_[l][hits_[l]++] = {at[l], code};
      }
    }
  }

  const Tetrahedra& mesh_;
  const MeshPoint* points_;
  RayFrame<D> view_;
  Vec3<F> direction_;
  RayFrame<double> view_of_[N];
  S from_of_[N], until_of_[N];
  int hits_[N], next_[N];
  Hit hit_[N][max_hits];
};

}  // namespace pellucid
#endif
