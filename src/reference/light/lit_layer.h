// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "layer_data.h"
#include "lit_part.h"
#include "pellucid/scene/layer.h"
#include "ray_lights.h"
#include "table.h"

namespace pellucid::reference {

/// A stretch of a ray in a layer, and where it has to be cut.
struct LitStretch {
  LayerStretch data;
  std::vector<Real> cuts;   ///< in (0, 1), ascending: between them everything is smooth
  std::vector<Bend> bends;  ///< of the normal
};

/// A layer with its light, gradient opacity and surfaces, or without. A view of it.
class LitLayer {
 public:
  /// Prepares a layer, which is in its place.
  LitLayer(const Layer& layer, const std::vector<Clip>& of_scene);

  const Layer& layer() const { return layer_; }
  /// Returns what LayerData::stretches() returns.
  std::vector<LayerStretch> stretches(const RealRay& ray, std::uint64_t& cells,
                                      Real& overlap) const {
    return data_.stretches(ray, cells, overlap);
  }
  LitStretch prepared(LayerStretch stretch, const RayLights& lights) const;
  /// Returns the part [begin, end] of a stretch, world arc length, between neighbouring cuts.
  LitPart part(const LitStretch& stretch, Real begin, Real end, const RayLights& lights) const;
  /// Returns a color of the layer's as the lights show it at u of a stretch.
  Rgb<double> shaded_surface(const Rgb<double>& color, const LayerStretch& stretch, Real u,
                             const RayLights& lights) const;

 private:
  /// Returns whether the medium absorbs nowhere.
  bool is_clear(const LayerStretch& stretch) const;
  void add_shading_cuts(const RayLights& lights, LitStretch& stretch) const;
  /// Returns the argument of a factor of the extinction: the magnitude of a gradient, or a channel.
  const Chord& argument(const LayerStretch& stretch) const;

  const Layer& layer_;
  LayerData data_;
  std::size_t gradient_, argument_;       ///< indices of chords
  Real flat_ = 0, flat_of_surfaces_ = 0;  ///< g0
  std::optional<TransferFunction> factor_;
  std::optional<Table> factor_table_;
};

}  // namespace pellucid::reference
