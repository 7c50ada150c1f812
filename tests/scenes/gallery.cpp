// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/gallery.h"

namespace pellucid::scenes {

Gallery gallery() {
  Gallery all;
  for (const auto group :
       {marschner_lobb_gallery, scan_gallery, cell_gallery, table_gallery, grid_gallery,
        stride_gallery, gaussian_gallery, mesh_gallery, layer_gallery}) {
    for (GalleryEntry& entry : group()) all.push_back(std::move(entry));
  }
  return all;
}

Scene scene_of(const Exhibit& exhibit, std::size_t camera, int size) {
  Scene scene = make_scene(exhibit.volume, exhibit.transfer_function,
                           exhibit.cameras.at(camera).camera, {size, size});
  if (!exhibit.layers.empty()) {
    scene.layers = exhibit.layers;
    scene.clips = exhibit.clips;
  } else if (exhibit.mesh && exhibit.multivariate) {
    scene.layers = {{MeshContent{exhibit.mesh, exhibit.multivariate}}};
  } else if (exhibit.mesh) {
    scene.layers = {{MeshContent{exhibit.mesh, exhibit.transfer_function}}};
  } else if (exhibit.channels) {
    scene.layers = {{ChannelsContent{exhibit.channels, exhibit.multivariate}}};
  }
  scene.samples = exhibit.samples;
  return scene;
}

}  // namespace pellucid::scenes
