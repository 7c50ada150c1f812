// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/internal/moving_pictures.h"

#include <algorithm>

namespace pellucid {
namespace {

constexpr double step = 1;
/// Least ratio of the times of exact and sampled pictures at which sampled ones are preferred.
constexpr double least_gain = 1.5;

}  // namespace

Scene sampled_scene(Scene scene) {
  scene.integration.method = Method::midpoint;
  scene.integration.step = step;
  return scene;
}

void MovingPictures::note(bool sampled, double seconds, double pixels) noexcept {
  if (pixels > 0) (sampled ? sampled_ : exact_) = seconds / pixels;
}

bool MovingPictures::are_sampled(double pixels, double seconds) const noexcept {
  if (!(exact_ > 0) || !(sampled_ > 0)) return true;
  return exact_ > least_gain * sampled_ && exact_ * pixels > seconds;
}

}  // namespace pellucid
