// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "layers/layer_appearance.h"
#include "pellucid/packet/interface.h"
#include "pellucid/packet/light.h"
#include "pellucid/packet/surfaces.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/scene/internal/binned_transfer_storage.h"
#include "pellucid/scene/scene.h"
#include "sources/grid_gradient.h"

namespace pellucid {

/// Returns a layer's light as packets see it; of an unlit layer, the world alone. None: packets
/// have no such light: more than they hold, numbers whose squares binary32 has not.
std::optional<PacketLight> packet_light(const LayerAppearance& look,
                                        const Reflection<double>* reflection, const Volume& volume,
                                        const std::vector<LightSource<double>>& lights);
/// Return how a layer reflects light, and a light seen from `origin`, in binary32.
Reflection<float> in_single(const Reflection<double>& reflection);
LightSource<float> in_single(const LightSource<double>& light, const Vec3<double>& origin);
/// Puts at most PacketLight::max_lights lights into `result`, seen from the middle of the corners,
/// which is returned, and how far a corner or a light is from there.
Vec3<double> place_lights(std::span<const Vec3<double>> corners,
                          const std::vector<LightSource<double>>& lights, PacketLight& result);
/// Returns light that leaves all colors as they are, with no normal that turns.
PacketLight no_light();
/// Puts down how gradients of a grid are turned into the world.
void set_world_gradient(const Volume& volume, PacketLight& result);
/// Returns whether binary32 holds the square of x well.
bool has_moderate_square(double x);
/// Returns the largest gradient that data of this range may have between two values.
double steepest_gradient(const LayerAppearance& look, const Volume& volume);
/// Returns whether binary32 tells magnitudes of gradients up to `steepest` apart at the control
/// points of a factor of at most `largest`.
bool suits_single(const PiecewiseLinear<double>& factor, double largest, double steepest);
/// Takes such a factor; `storage` must outlive the light.
void set_factor(const PiecewiseLinear<double>& factor, double largest, double steepest,
                std::optional<BinnedTransferStorage>& storage, PacketLight& result);

/// Returns the largest extinction of a function along data that are off by this, beside their
/// rounding.
double most_extinction_on(const PiecewiseLinear<double>& function,
                          const CubicBernstein<double>& data, double off);
/// Returns what was integrated of what packets hand back. `opacity`: the bound on it for which
/// there was an allowance.
PellucidCellResult scalar_fallback(const RayResult& found, double opacity);

/// The light of a volume and its gradient opacity as packets see them, and cells that packets hand
/// back.
class GridLight {
 public:
  /// Null where packets have no light for the layer: surfaces that are not plain, proofs, data that
  /// binary32 does not hold, highlights of point lights with a kink, factors with jumps, and what
  /// packet_light() has not. All that is given must outlive the object.
  static std::unique_ptr<const GridLight> make(const Layer& layer, const std::vector<Light>& lights,
                                               const RayTolerance& wanted);

  const PacketLight& view() const noexcept { return light_; }
  /// Returns the isosurfaces; null where there are none.
  const PacketSurfaces* surfaces() const noexcept { return surfaces_ ? &*surfaces_ : nullptr; }
  /// Integrates a part of a cell. `step`: the ray's way through it; `world`: the ray. Where less
  /// than `least_allowance` is allowed for what absorbs, the ray has spent so much that it had
  /// better be followed otherwise: `result` leaves it.
  void integrate(const StructuredWalk<double>::Step& step, const Ray<double>& world,
                 const PellucidCell& cell, const TransferTables& transfer, double least_allowance,
                 PellucidCellResult& result) const;

 private:
  GridLight(const Layer& layer, const std::vector<Light>& lights, const RayTolerance& wanted);

  const Volume& volume_;
  RayTolerance wanted_;
  LayerAppearance look_;
  std::vector<LightSource<double>> lights_;
  std::optional<GridGradient> gradient_, magnitude_;
  std::optional<BinnedTransferStorage> factor_;
  PacketLight light_;
  std::optional<PacketSurfaces> surfaces_;
};

}  // namespace pellucid
