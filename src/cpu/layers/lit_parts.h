// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "layer_stream.h"
#include "pellucid/segment/lit_panel.h"

namespace pellucid {

/// A stretch of a ray through layers in light, as MultivariateRayIntegrator integrates it: cut
/// where tables have control points and where a normal turns its edge to a light. Made anew for
/// each stretch; used by one thread.
class LitParts {
 public:
  explicit LitParts(const std::vector<LightSource<double>>& lights) : lights_(lights) {}

  /// Begins a stretch. The ray's direction has length 1.
  void start(const Ray<double>& ray, Interval<double> range);
  /// Adds the part of a layer's stretch in that range.
  void add(const LayerStretch& stretch, const LayerSource& source);
  /// Finds the cuts; call it behind the last layer.
  void finish();

  double length() const noexcept { return range_.end - range_.begin; }
  /// Returns the part [begin, end] integrated, or where to cut it.
  template <class Allowance>
  PanelSegment<double> panel(double begin, double end, const PanelDemand<double>& demand,
                             const Allowance& allowance) const noexcept {
    PanelSegment<double> result;
    if (!demand.last_resort && find_cut(begin, end, result.cut)) return result;
    for (std::size_t i = 0; i < layers_.size(); ++i) part_[i] = layers_[i].part(begin, end);
    const LitStretch<double> stretch = view();
    return integrate_lit_panel(stretch, part_.data(), begin, end, demand, allowance);
  }

 private:
  bool find_cut(double begin, double end, double& cut) const noexcept;
  LitStretch<double> view() const noexcept;

  const std::vector<LightSource<double>>& lights_;
  Ray<double> ray_{};
  Interval<double> range_{0, 0};
  std::vector<LitLayer<double>> layers_;
  mutable std::vector<LitLayer<double>> part_;
  std::vector<double> cuts_;  ///< ascending
};

}  // namespace pellucid
