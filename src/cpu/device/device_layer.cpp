// SPDX-License-Identifier: Apache-2.0
#include "device_layer.h"

#include <algorithm>

#include "layers/layer_setup.h"

namespace pellucid {

std::string DeviceLayer::cannot_follow(const Layer& layer, const Integration& integration) {
  const auto* const volume = std::get_if<VolumeContent>(&layer.content);
  if (std::holds_alternative<LabelContent>(layer.content)) return "labels";
  if (std::holds_alternative<SourceContent>(layer.content)) return "stretch sources";
  if (volume != nullptr && volume->mask) return "masks of labels";
  if (has_surfaces(layer)) return "isosurfaces and slices";
  if (volume == nullptr && layer.shading) return "light on other data than one volume";
  if (volume == nullptr && layer.gradient_opacity) {
    return "gradient opacity of other data than one volume";
  }
  if (extinction_factor_of(layer) != nullptr) return "factors of the extinction";
  if (integration.method == Method::exact) return "";
  const bool plain = volume != nullptr && !layer.shading && !layer.gradient_opacity;
  if (integration.method == Method::midpoint && plain &&
      integration.precision != Precision::float64) {
    return "";
  }
  return "this method";
}

DeviceLayer::DeviceLayer(const Layer& layer, const LayerSetting& setting,
                         const ParallelFor& parallel) {
  scene_.wanted = setting.wanted;
  if (std::holds_alternative<VolumeContent>(layer.content)) set_volume(layer, setting, parallel);
  if (std::holds_alternative<ChannelsContent>(layer.content)) {
    set_channels(layer, setting, parallel);
  }
  if (std::holds_alternative<MeshContent>(layer.content)) set_mesh(layer);
}

void DeviceLayer::set_volume(const Layer& layer, const LayerSetting& setting,
                             const ParallelFor& parallel) {
  const auto& content = std::get<VolumeContent>(layer.content);
  const Volume& volume = *content.volume;
  const MultichannelGrid grid = multichannel_grid(Channels({{"value", "", content.volume}}));
  LitGrid& lit = scene_.lit;
  lit.grid = {grid.data[0], grid.type[0], {grid.axis[0], grid.axis[1], grid.axis[2]}};
  lit.grid_from_world = volume.grid_from_world();
  transfer_.emplace(*content.transfer_function);
  scene_.transfer = transfer_->tables();
  const BlockRecords& records = volume.block_records(parallel);
  classes_ = BlockClassesStorage(records, transfer_->tables(),
                                 std::max(setting.wanted.largest_color, 1.0), parallel);
  lit.blocks = {records, classes_.view()};
  scene_.look = DeviceLook::grid;
  // Where all is in double anyway there is nothing to try in binary32.
  scene_.single_first = setting.integration.method == Method::exact &&
                        setting.wanted.grade == Grade::estimated &&
                        setting.wanted.precision == Precision::automatic;
  if (setting.integration.method == Method::midpoint) {
    scene_.sampling_step = setting.integration.step * volume.voxel_size();
  }
  if (is_lit(layer)) set_light(layer, setting);
}

void DeviceLayer::set_light(const Layer& layer, const LayerSetting& setting) {
  look_.emplace(layer);
  lights_ = light_sources(setting.lights);
  LitGrid& lit = scene_.lit;
  lit.transfer = transfer_->tables().wide;
  lit.largest_extinction = largest_extinction(layer);
  if (look_->reflection() != nullptr) {
    lit.is_lit = true;
    lit.reflection = *look_->reflection();
    lit.field_gradient = layer.shading->gradient == GradientKind::field;
    lit.light = lights_.data();
    lit.lights = static_cast<int>(lights_.size());
  }
  if (look_->extinction_factor() != nullptr) {
    lit.has_gradient_opacity = true;
    lit.gradient_opacity = *look_->extinction_factor();
  }
  scene_.look = DeviceLook::lit_grid;
  scene_.single_first = false;
}

void DeviceLayer::set_channels(const Layer& layer, const LayerSetting& setting,
                               const ParallelFor& parallel) {
  const auto& content = std::get<ChannelsContent>(layer.content);
  const Channels& channels = *content.channels;
  scene_.channels = multichannel_grid(channels);
  scene_.grid_from_world = channels.grid().grid_from_world();
  channel_blocks_ = MultivariateBlocksStorage(channels, *content.transfer_function,
                                              setting.negligible_extinction, parallel);
  scene_.channel_blocks = channel_blocks_.view();
  scene_.function = content.transfer_function->view();
  scene_.largest_extinction = largest_extinction(layer);
  scene_.look = DeviceLook::channels;
}

void DeviceLayer::set_mesh(const Layer& layer) {
  const auto& content = std::get<MeshContent>(layer.content);
  const TetrahedralMesh& mesh = content.mesh->mesh();
  scene_.mesh = mesh.view();
  scene_.mesh_points = static_cast<std::int64_t>(mesh.points().size());
  scene_.mesh_nodes = static_cast<std::int64_t>(mesh.tree_size());
  scene_.mesh_faces = static_cast<std::int64_t>(mesh.boundary_size());
  fields_.emplace(*content.mesh);
  scene_.fields = fields_->view();
  if (content.univariate() != nullptr) {
    transfer_.emplace(*content.univariate());
    scene_.transfer = transfer_->tables();
    scene_.look = DeviceLook::mesh;
    return;
  }
  scene_.function = content.multivariate()->view();
  scene_.largest_extinction = largest_extinction(layer);
  scene_.look = DeviceLook::mesh_channels;
}

}  // namespace pellucid
