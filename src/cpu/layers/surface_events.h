// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "layer_stream.h"

namespace pellucid {

/// Something that a ray meets at a point: a surface, or a place where it may touch one.
struct SurfaceEvent {
  enum class Kind {
    surface,
    mark,   ///< a surface may begin here: the transparency in front matters, if it does
    charge  ///< it is not known whether the ray met the surface since the mark
  };
  double t = 0;
  Kind kind = Kind::surface;
  std::size_t isosurface = 0;  ///< of marks and charges
  double opacity = 0;          ///< of a charge: upper bound
  Rgb<double> color{};         ///< of an opaque surface
  /// Error of opacity and of opacity · color, together relative to the largest color.
  double error = 0;
};

/// The isosurfaces and slices of one layer along rays, one ray after the other. Used by one thread.
///
/// An isosurface is crossed where the data change from one side of its value to the other. Sides
/// are told only where the data are farther from the value than their rounding, and remembered from
/// stretch to stretch: so a crossing at the face between two cells counts once, and data that come
/// as close as rounding without changing sides are charged for instead. Data exactly at the value
/// are on neither side: they make a surface where they leave it for the other one.
class SurfaceEvents {
 public:
  /// All must outlive the object. `largest_color`: of the frame, at least 1.
  SurfaceEvents(const LayerSource& source, const std::vector<LightSource<double>>& lights,
                double largest_color);

  /// Begins a ray.
  void start(const Ray<double>& ray);
  /// Takes what lies on the next stretch in place of what is left of the last one.
  void take(const LayerStretch& stretch);
  /// Returns the next event, front to back; null behind the last one of the stretch.
  const SurfaceEvent* next() const { return next_ < events_.size() ? &events_[next_] : nullptr; }
  void pop() { ++next_; }

 private:
  struct Side {
    int side = 0;          ///< -1: below the value, 1: above, 0: not known
    bool pending = false;  ///< within rounding of the value since the mark
  };

  void follow(std::size_t isosurface, const LayerStretch& stretch);
  void charge(std::size_t isosurface, double t);
  void lie_in(std::size_t slice, double t);
  void meet(std::size_t slice, const LayerStretch& stretch);
  void add_crossing(const Isosurface& surface, const LayerStretch& stretch, double u,
                    double value_error);
  /// Returns the shaded color at u, off by at most `error`, where u is off by at most u_error.
  Rgb<double> lit(const Rgb<double>& color, const LayerStretch& stretch, double u, double u_error,
                  double& error) const;

  const LayerSource& source_;
  const std::vector<LightSource<double>>& lights_;
  double largest_color_;
  Ray<double> ray_{};
  double end_ = 0;  ///< of the data so far
  std::vector<Side> sides_;
  std::vector<SlicePosition> slices_;
  std::vector<bool> met_;
  std::vector<SurfaceEvent> events_;
  std::size_t next_ = 0;
};

}  // namespace pellucid
