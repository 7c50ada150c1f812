// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/scene.h"

namespace pellucid::test {

/// Returns the content of the scene's first layer, which becomes one of this kind.
template <class Content>
Content& content_of(Scene& scene) {
  if (scene.layers.empty()) scene.layers.emplace_back();
  LayerContent& content = scene.layers.front().content;
  if (!std::holds_alternative<Content>(content)) content = Content();
  return std::get<Content>(content);
}
inline VolumeContent& volume_of(Scene& scene) {
  return content_of<VolumeContent>(scene);
}
inline ChannelsContent& channels_of(Scene& scene) {
  return content_of<ChannelsContent>(scene);
}
inline MeshContent& mesh_of(Scene& scene) {
  return content_of<MeshContent>(scene);
}

/// Returns the content of the only layer, which must be of this kind.
inline const VolumeContent& volume_of(const Scene& scene) {
  return std::get<VolumeContent>(scene.layers.at(0).content);
}
inline const ChannelsContent& channels_of(const Scene& scene) {
  return std::get<ChannelsContent>(scene.layers.at(0).content);
}
inline const MeshContent& mesh_of(const Scene& scene) {
  return std::get<MeshContent>(scene.layers.at(0).content);
}
/// Returns the volume whose grid the rays of a scene of one layer cross.
inline const Volume& grid_volume(const Scene& scene) {
  return *grid_of(scene.layers.at(0));
}

}  // namespace pellucid::test
