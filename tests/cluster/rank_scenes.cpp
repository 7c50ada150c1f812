// SPDX-License-Identifier: Apache-2.0
#include "tests/cluster/rank_scenes.h"

#include <algorithm>
#include <cmath>

#include "tests/scenes/cameras.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/layer_makers.h"

namespace pellucid::cluster_tests {
namespace {

using namespace pellucid::scenes;

/// Values that do not change along x in halves: jumps lie on planes through values and through the
/// middles of cells, where bricks of given boxes meet.
NamedScene jump_on_a_face(int size) {
  const VolumePointer volume =
      make_volume<std::uint8_t>(grid_description({17, 12, 12}), [](int i, int, int) {
        return i < 8 ? 40 : i > 8 ? 200 : 120;
      });
  const TransferPointer function = transfer({{0, 0.1, {1, 0.5, 0.2}},
                                             {120, 0.1, {1, 0.5, 0.2}},
                                             {120, 0.8, {0.2, 0.4, 1}},
                                             {255, 0.8, {0.2, 0.4, 1}}});
  Scene scene =
      make_scene(volume, function, perspective_camera({30, 20, 40}, {8, 6, 6}, 30), {size, size});
  return {"a jump on a brick's face", scene, false, true};
}

/// Rays in the planes of values, and of the faces of bricks.
NamedScene along_faces(int size) {
  const VolumePointer volume =
      make_volume<std::uint8_t>(grid_description({17, 17, 17}), [](int i, int j, int k) {
        return 128 + 60 * std::sin(0.7 * i + 0.4 * j) * std::cos(0.5 * k);
      });
  const TransferPointer function =
      transfer({{0, 0, {1, 1, 1}}, {128, 0.02, {1, 0.4, 0.1}}, {255, 0.3, {0.1, 0.6, 1}}});
  Scene scene =
      make_scene(volume, function, parallel_camera({8, 8, 60}, {0, 0, -1}, 8.0 * size / (size - 1)),
                 {size, size});
  return {"a view along the faces of bricks", scene, false, true};
}

/// Proved bounds of gradient opacity, which fail to keep to small shares of a tolerance.
NamedScene gradient_opacity(int size) {
  const VolumePointer volume =
      make_volume<std::uint8_t>(grid_description({96, 96, 96}), [](int i, int j, int k) {
        const double x = i / 47.5 - 1, y = j / 47.5 - 1, z = k / 47.5 - 1;
        const double r = std::sqrt(x * x + y * y + z * z);
        return std::clamp(128 + 90 * std::cos(14 * r) * (1 - r / 2) + 25 * std::sin(9 * x + 5 * z),
                          0.0, 255.0);
      });
  const TransferPointer function =
      transfer({{120, 0, {0.1, 0.3, 1}}, {180, 0.06, {1, 0.6, 0.2}}, {255, 0.25, {1, 1, 0.9}}});
  Scene scene =
      make_scene(volume, function, perspective_camera({200, 153, 230}, {47.5, 47.5, 47.5}, 30),
                 {size / 2 + 4, size / 2});
  scene.layers[0].gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0, 0.1}, {6, 1}});
  scene.integration.grade = Grade::proved;
  scene.integration.tolerance = 1e-3;
  return {"gradient opacity, proved", scene, false, false, true};
}

NamedScene camera_inside(int size) {
  NamedScene named = along_faces(size);
  named.name = "a camera inside of a brick";
  named.scene.camera = perspective_camera({9.1, 7.3, 8.2}, {2, 3, 14}, 80);
  return named;
}

NamedScene camera_on_a_face(int size) {
  NamedScene named = along_faces(size);
  named.name = "a camera on the face of a brick";
  named.scene.camera = perspective_camera({8, 7.3, 8.2}, {8, 3, 14}, 80);
  return named;
}

}  // namespace

std::vector<NamedScene> rank_scenes(int size) {
  std::vector<NamedScene> list{jump_on_a_face(size), along_faces(size), camera_inside(size),
                               camera_on_a_face(size), gradient_opacity(size)};
  std::size_t n = 0;
  for (const auto group : {layer_gallery, light_gallery}) {
    for (const GalleryEntry& entry : group()) {
      if (!entry.why_missing().empty()) continue;
      const Exhibit exhibit = entry.make(size);
      for (std::size_t camera = 0; camera < exhibit.cameras.size(); ++camera) {
        // One camera after the other in the short run.
        list.push_back({entry.name + ", " + exhibit.cameras[camera].name,
                        scene_of(exhibit, camera, size), camera != n % exhibit.cameras.size()});
      }
      ++n;
    }
  }
  return list;
}

}  // namespace pellucid::cluster_tests
