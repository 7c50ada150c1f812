// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/gallery.h"

namespace pellucid::scenes {

Gallery gallery() {
  Gallery all;
  for (const auto group : {marschner_lobb_gallery, scan_gallery, cell_gallery, table_gallery,
                           grid_gallery, stride_gallery, gaussian_gallery, mesh_gallery}) {
    for (GalleryEntry& entry : group()) all.push_back(std::move(entry));
  }
  return all;
}

Scene scene_of(const Exhibit& exhibit, std::size_t camera, int size) {
  Scene scene = make_scene(exhibit.volume, exhibit.transfer_function,
                           exhibit.cameras.at(camera).camera, {size, size});
  scene.channels = exhibit.channels;
  scene.multivariate = exhibit.multivariate;
  scene.mesh = exhibit.mesh;
  scene.samples = exhibit.samples;
  return scene;
}

}  // namespace pellucid::scenes
