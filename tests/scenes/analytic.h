// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "pellucid/scene/scene.h"

namespace pellucid::scenes {

/// A ray through data whose trilinear reconstruction is known exactly, with the pixel that a closed
/// form gives for it.
struct AnalyticRay {
  std::string name;
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const TransferFunction> transfer_function;
  Vec3<double> origin, direction;

  Rgb<double> radiance;
  double opacity = 0;
  /// NaN: not stated.
  double half_opacity_depth = std::numeric_limits<double>::quiet_NaN();
};

std::vector<AnalyticRay> analytic_rays();

/// The ray as a parallel image of one pixel.
Scene one_pixel_scene(const AnalyticRay& ray);

}  // namespace pellucid::scenes
