// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <numbers>
#include <utility>

#include "tests/packet/against_one_by_one.h"
#include "tests/packet/smooth_frames.h"
#include "tests/support/one_layer.h"

namespace pellucid {

/// Smooth scenes seen so closely that pixels lie between others.
class SeenClosely : public SmoothFrames {
 protected:
  /// Looks at some place of the scene from nearby, so many voxels from pixel to pixel.
  void zoom(Scene& scene, double voxels) {
    scene.size = {44 + static_cast<int>(random_() % 9), 44 + static_cast<int>(random_() % 9)};
    Camera& camera = scene.camera;
    const double far = length(camera.position - camera.focal_point),
                 half = 0.5 * voxels * scene.size.height * test::grid_volume(scene).voxel_size();
    if (camera.projection == Projection::orthographic) {
      camera.parallel_scale = half;
    } else {
      camera.vertical_angle = 2 * std::atan(half / far) * 180 / std::numbers::pi;
    }
    const Vec3<double> aside = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    camera.position = camera.position + aside * (0.15 * far);
    camera.focal_point = camera.focal_point + aside * (0.15 * far);
  }

  std::array<int, 3> values() {
    const auto size = [&] { return static_cast<int>(uniform(24, 60)); };
    return {size(), size(), size()};
  }

  /// The scene from nearby, from the side or along an axis or a diagonal.
  Scene seen_closely(std::shared_ptr<const Volume> volume, Points points) {
    const Vec3<double> direction =
        one_of(3) ? directions[random_() % std::size(directions)] : aside();
    Scene scene = make_scene(std::move(volume), std::move(points), direction, one_of(2));
    zoom(scene, power(0.05, 1.5));
    return scene;
  }

  std::shared_ptr<const Volume> of_waves(int most, double longest) {
    return make_volume(values(), waves(1 + static_cast<int>(uniform(0, most)), power(9, longest)),
                       {uniform(0.7, 1.4), uniform(0.7, 1.4), uniform(0.7, 1.4)});
  }

  static void expect_many(const Seen& seen, std::size_t of_a_frame) {
    EXPECT_GT(seen.between, static_cast<std::size_t>(seen.frames) * of_a_frame);
  }
};

}  // namespace pellucid
