// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "grid/field.h"
#include "layer_data.h"
#include "light/lit_layer.h"
#include "mixture/mixture.h"
#include "pellucid/reference/render.h"
#include "projection.h"
#include "table.h"

namespace pellucid::reference {

/// The volume rendering integral through data with a transfer function. A view of both.
class SceneIntegral {
 public:
  /// Prepares the integral of a scene that check_data() accepts.
  explicit SceneIntegral(const Scene& scene);
  SceneIntegral(const Volume& volume, const TransferFunction& transfer_function);
  SceneIntegral(const Channels& channels, const MultivariateTransferFunction& transfer_function);

  /// Integrates along a ray with a direction of length 1, up to `end` if the scene has a backdrop.
  /// Adds the number of cells crossed to `cells`.
  ReferencePixel operator()(const RealRay& ray, bool with_depth, std::uint64_t& cells,
                            Real end = std::numeric_limits<Real>::infinity()) const;
  /// Returns the same with its half-opacity depth. Throws Error for a direction of length 0, and
  /// for an end without a backdrop.
  ReferencePixel operator()(const Vec3<double>& origin, const Vec3<double>& direction,
                            Real end = std::numeric_limits<Real>::infinity()) const;

 private:
  /// Data of one field without clips.
  std::unique_ptr<const Field> field_;
  std::optional<Table> table_;  ///< or
  std::optional<Mixture> mixture_;
  /// Data of all other scenes: the layers in their places.
  std::vector<std::unique_ptr<const Layer>> layers_;
  std::vector<std::unique_ptr<const LayerData>> data_;  ///< or
  std::vector<std::unique_ptr<const LitLayer>> lit_;    ///< if any of them is_lit()
  std::vector<Light> lights_;
  /// Over the others, in the order of the list.
  std::vector<std::unique_ptr<const Projection>> projections_;
};

}  // namespace pellucid::reference
