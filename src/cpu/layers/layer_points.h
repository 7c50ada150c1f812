// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>

#include "layer_stream.h"
#include "pellucid/field/sample.h"

namespace pellucid {

/// Data of a layer at a point of a ray.
struct LayerPoint {
  int function = -1;  ///< index of LayerSource::functions(); -1: absent, or vacuum
  double value[max_channels]{};
  // Of layers that need them (LayerAppearance), once they are asked for:
  Vec3<double> gradient{};     ///< in the world, for light
  double factor_argument = 0;  ///< of LayerAppearance::extinction_factor()
  GridPlace<double> place{};   ///< of grids: where it is
};

/// The points of one layer along rays, one ray after the other, each front to back. Used by one
/// thread.
class LayerPoints {
 public:
  LayerPoints() = default;
  LayerPoints(const LayerPoints&) = delete;
  LayerPoints& operator=(const LayerPoints&) = delete;
  virtual ~LayerPoints() = default;

  /// Does what those of LayerStream do.
  virtual Interval<double> start(const Ray<double>& ray) = 0;
  virtual void restrict_to_range(Interval<double> range) = 0;
  /// Returns the first position from t on at which the layer may absorb, as far as blocks of its
  /// data tell; infinite: it does not in this range.
  virtual double next_from(double t) = 0;
  /// Finds what the layer has at t, in the range, behind all former ones.
  virtual void find(double t, LayerPoint& point) = 0;
  /// Returns whether find() also takes places in front of former ones.
  virtual bool goes_back() const { return false; }
  /// Finds the gradient and the factor's argument, of the point that was found last or before.
  virtual void find_gradients(LayerPoint& point) const = 0;
};

/// The points of the stretches of any layer.
class StreamPoints : public LayerPoints {
 public:
  StreamPoints(std::unique_ptr<LayerStream> stream, const LayerSource& source)
      : stream_(std::move(stream)), source_(source) {}

  Interval<double> start(const Ray<double>& ray) override { return stream_->start(ray); }
  void restrict_to_range(Interval<double> range) override;
  double next_from(double t) override;
  void find(double t, LayerPoint& point) override;
  void find_gradients(LayerPoint& /*point*/) const override {}

 private:
  void come_to(double t);

  std::unique_ptr<LayerStream> stream_;
  const LayerSource& source_;
  LayerStretch stretch_;
  bool ended_ = false;
};

/// Returns the point of a stretch at t, within it or at its ends.
LayerPoint point_of(const LayerStretch& stretch, const LayerSource& source, double t);

}  // namespace pellucid
