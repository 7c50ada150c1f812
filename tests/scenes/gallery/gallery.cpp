// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/gallery.h"

#include <cmath>
#include <limits>

#include "tests/scenes/real.h"

namespace pellucid::scenes {
namespace {

/// A wavy sheet through the focal point with a hole in it, translucent on one side, and nearer than
/// all data, on the camera, in one corner.
std::shared_ptr<const Image> make_backdrop(const Camera& camera, ImageSize size) {
  auto image = std::make_shared<Image>();
  image->width = size.width;
  image->height = size.height;
  const double middle = length(camera.focal_point - camera.position);
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      const double x = (column + 0.5) / size.width, y = (row + 0.5) / size.height;
      const bool hole = std::hypot(x - 0.6, y - 0.45) < 0.17;
      const bool corner = x + y < 0.5;
      const double depth = middle + 0.5 * std::sin(7 * x) * std::cos(5 * y + 1);
      const float alpha = hole ? 0.0f : x < 0.3 ? 0.5f : 1.0f;
      image->pixels.push_back({alpha, 0.5f * alpha, 0.25f * alpha, alpha});
      image->depth.push_back(hole     ? std::numeric_limits<float>::infinity()
                             : corner ? 0.0f
                                      : static_cast<float>(depth));
    }
  }
  return image;
}

}  // namespace

std::string GalleryEntry::why_missing() const {
  return file.empty() ? std::string() : scenes::why_missing(file);
}

Gallery gallery() {
  Gallery all;
  for (const auto group :
       {marschner_lobb_gallery, scan_gallery, cell_gallery, table_gallery, grid_gallery,
        stride_gallery, gaussian_gallery, mesh_gallery, layer_gallery, light_gallery}) {
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
  scene.lights = exhibit.lights;
  scene.samples = exhibit.samples;
  if (exhibit.backdrop) scene.backdrop = make_backdrop(scene.camera, scene.size);
  return scene;
}

}  // namespace pellucid::scenes
