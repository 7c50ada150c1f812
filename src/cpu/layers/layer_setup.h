// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "layer_stream.h"
#include "ray_tracer.h"

namespace pellucid {

class DeviceLayer;

/// Settings of a frame for its layers: all that a layer's set-up depends on beside the layer.
struct LayerSetting {
  Integration integration;
  std::vector<Light> lights;
  RayTolerance wanted;
  double negligible_extinction = 0;  ///< that a layer may ignore all along a ray
  bool depth = false;
  std::optional<InstructionSet> instruction_set;
  std::optional<GaussianMarch> gaussian_march;

  LayerSetting(const Integration& integration, const RayTolerance& wanted,
               double negligible_extinction, const std::vector<Light>& lights,
               const RenderOptions& options);
  bool operator==(const LayerSetting&) const = default;
};

/// A layer in its place with what its rays need. Frames that show it in the same way share it.
class LayerSetup {
 public:
  /// `layer`: as the scene has it. What is needed of its data's blocks is made on so many threads.
  LayerSetup(const Layer& layer, const LayerSetting& setting, int threads);
  ~LayerSetup();
  LayerSetup(const LayerSetup&) = delete;
  LayerSetup& operator=(const LayerSetup&) = delete;

  /// Returns whether this is the set-up of a layer with these data and functions in this place;
  /// its name, clips and visibility do not matter.
  bool shows(const Layer& layer) const;
  const LayerSetting& setting() const noexcept { return setting_; }

  /// Returns the layer, in its place.
  const Layer& layer() const noexcept { return layer_; }
  double largest_extinction() const noexcept { return largest_extinction_; }
  /// Returns the tracer of the layer alone; null if it takes the general path.
  const RayTracer* fast() const noexcept { return fast_.get(); }
  /// Returns the layer for the general path. The first call makes it; safe from any thread.
  const LayerSource& source() const;
  /// Returns what a device needs of the layer, for which DeviceLayer::cannot_follow() is empty. The
  /// first call makes it; safe from any thread.
  const DeviceLayer& device(const ParallelFor& parallel) const;

 private:
  void make_source(const ParallelFor& parallel) const;

  const LayerContent content_;  ///< as the scene has it
  const Affine<double> transform_;
  const LayerSetting setting_;
  const Layer layer_;
  const double largest_extinction_;
  std::unique_ptr<const RayTracer> fast_;
  mutable std::once_flag source_made_;
  mutable std::unique_ptr<const LayerSource> source_;
  mutable std::once_flag device_made_;
  mutable std::unique_ptr<const DeviceLayer> device_;
};

}  // namespace pellucid
