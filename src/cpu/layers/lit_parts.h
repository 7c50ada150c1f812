// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "layer_stream.h"
#include "pellucid/segment/lit_cuts.h"

namespace pellucid {

class MultivariateRayIntegrator;

/// A stretch of a ray through layers in light, as MultivariateRayIntegrator integrates it: cut
/// where tables have control points and where a normal turns its edge to a light. Made anew for
/// each stretch; used by one thread.
class LitParts {
 public:
  explicit LitParts(const std::vector<LightSource<double>>& lights) : lights_(lights) {}

  /// Begins a stretch. The ray's direction has length 1.
  void start(const Ray<double>& ray, Interval<double> range);
  /// Adds the part of a layer's stretch in that range. The layer's function and look must outlive
  /// the stretch.
  void add(const LayerStretch& stretch, const MultivariateTransfer<double>& function,
           const LayerAppearance& look);
  /// Finds the cuts; call it behind the last layer.
  void finish();

  /// Integrates the stretch, until nothing more matters. `left_out` and `position_error`: as of
  /// MultivariateRayIntegrator::add_stretch().
  void integrate(double left_out, double position_error,
                 MultivariateRayIntegrator& integrator) const;

 private:
  friend struct LitPiece<LitParts>;

  template <class Allowance>
  PanelSegment<double> panel(double begin, double end, const PanelDemand<double>& demand,
                             const Allowance& allowance) const noexcept {
    for (std::size_t i = 0; i < layers_.size(); ++i) part_[i] = layers_[i].part(begin, end);
    return integrate_lit_panel(view(), part_.data(), begin, end, demand, allowance);
  }
  double length() const noexcept { return range_.end - range_.begin; }
  LitStretch<double> view() const noexcept;

  const std::vector<LightSource<double>>& lights_;
  Ray<double> ray_{};
  Interval<double> range_{0, 0};
  std::vector<LitLayer<double>> layers_;
  mutable std::vector<LitLayer<double>> part_;
  std::vector<double> cuts_;  ///< ascending, from 0 to 1
};

}  // namespace pellucid
