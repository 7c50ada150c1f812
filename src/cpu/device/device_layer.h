// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "layers/layer_appearance.h"
#include "mesh/mesh_field_storage.h"
#include "pellucid/cuda/device_scene.h"
#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/multivariate_blocks_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

struct LayerSetting;

/// Data of a layer for a device, in the host's memory.
class DeviceLayer {
 public:
  /// Prepares a layer for a device. The layer is in its place, cannot_follow() has nothing to say
  /// of it, and it must outlive the object.
  DeviceLayer(const Layer& layer, const LayerSetting& setting, const ParallelFor& parallel);
  DeviceLayer(const DeviceLayer&) = delete;
  DeviceLayer& operator=(const DeviceLayer&) = delete;

  /// Returns why a device cannot follow rays through the layer yet; empty if it can.
  static std::string cannot_follow(const Layer& layer, const Integration& integration);

  /// Returns the layer's part of a scene, with the tolerance of rays.
  const DeviceScene& scene() const noexcept { return scene_; }

 private:
  void set_volume(const Layer& layer, const LayerSetting& setting, const ParallelFor& parallel);
  void set_light(const Layer& layer, const LayerSetting& setting);
  void set_channels(const Layer& layer, const LayerSetting& setting, const ParallelFor& parallel);
  void set_mesh(const Layer& layer);

  DeviceScene scene_;
  std::optional<TransferTablesStorage> transfer_;
  BlockClassesStorage classes_;
  std::optional<LayerAppearance> look_;
  std::vector<LightSource<double>> lights_;
  MultivariateBlocksStorage channel_blocks_;
  std::optional<MeshFieldStorage> fields_;
};

}  // namespace pellucid
