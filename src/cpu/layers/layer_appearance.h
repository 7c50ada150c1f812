// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pellucid/math/bernstein.h"
#include "pellucid/scene/layer.h"
#include "pellucid/segment/shading.h"

namespace pellucid {

/// Look of a layer beside its functions, as rays need it: light, a factor of the extinction and
/// surfaces.
class LayerAppearance {
 public:
  /// The layer is in its place and must outlive the object.
  explicit LayerAppearance(const Layer& layer);
  LayerAppearance(const LayerAppearance&) = delete;
  LayerAppearance& operator=(const LayerAppearance&) = delete;

  const Layer& layer() const noexcept { return layer_; }
  /// Return how the medium and how surfaces reflect light; null where the layer has no light.
  const Reflection<double>* reflection() const noexcept {
    return reflection_ ? &*reflection_ : nullptr;
  }
  const Reflection<double>* surface_reflection() const noexcept {
    return surface_reflection_ ? &*surface_reflection_ : nullptr;
  }
  /// Returns the factor of the extinction: of the magnitude of a gradient, or of a channel of
  /// several (value_factor()), which factor_argument() makes a number from 0 on.
  const PiecewiseLinear<double>* extinction_factor() const noexcept {
    return factors_ ? &factor_view_ : nullptr;
  }
  /// Returns the factor of a channel's value, where there is one; else null.
  const ChannelTransferFunction* value_factor() const noexcept { return value_factor_; }
  /// Returns the argument of extinction_factor() along data of value_factor()'s channel.
  CubicBernstein<double> factor_argument(const CubicBernstein<double>& data) const noexcept {
    CubicBernstein<double> argument = data;
    for (double& b : argument.b) b += factor_shift_;
    return argument;
  }
  double factor_argument(double datum) const noexcept { return datum + factor_shift_; }
  /// Returns whether its panels need light or a factor.
  bool is_lit() const noexcept { return reflection_ || factors_; }
  /// Returns whether its medium absorbs anywhere.
  bool has_medium() const noexcept { return has_medium_; }
  bool has_surfaces() const noexcept { return pellucid::has_surfaces(layer_); }
  const std::vector<Isosurface>& isosurfaces() const noexcept { return layer_.isosurfaces; }
  const std::vector<Slice>& slices() const noexcept { return layer_.slices; }

 private:
  const Layer& layer_;
  std::optional<Reflection<double>> reflection_, surface_reflection_;
  std::optional<TransferFunction> factors_;
  PiecewiseLinear<double> factor_view_{};
  const ChannelTransferFunction* value_factor_ = nullptr;
  double factor_shift_ = 0;
  bool has_medium_;
};

/// Returns a function that absorbs at the values of the layer's isosurfaces in a channel and no
/// farther from them than rounding moves data, or by `off`. None: the channel has no isosurfaces.
std::optional<TransferFunction> isosurface_support(const LayerAppearance& look, int channel,
                                                   double off);

/// Crossing of a ray and the plane of a slice.
struct SlicePosition {
  double t;            ///< world arc length; infinite where it does not
  double error;        ///< largest error of t
  bool along = false;  ///< whether the ray runs in the plane: nobody knows what it sees of it
};
std::vector<SlicePosition> slice_positions(const std::vector<Slice>& slices,
                                           const Ray<double>& ray);

/// Returns the scene's lights as rays see them.
std::vector<LightSource<double>> light_sources(const std::vector<Light>& lights);

}  // namespace pellucid
