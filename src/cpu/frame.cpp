// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <algorithm>
#include <optional>

namespace pellucid {
namespace {

/// The largest component of what lies behind the data.
double brightest(const std::optional<Rgb<double>>& background) {
  return background ? std::max({background->r, background->g, background->b}) : 0;
}

/// Rounding a pixel to binary32 costs at most half a unit in its last place.
double storage_error(double value) {
  return std::max(value, 1.0) * 0x1p-24;
}

}  // namespace

Frame::Frame(const Scene& described, const RenderOptions& options, int threads)
    : scene(described),
      camera(make_camera_frame(described.camera, described.size)),
      tolerance(0),
      reserved(described.transfer_function ? described.transfer_function->approximation_error(
                                                 brightest(described.background))
                                           : 0) {
  const Integration& integration = scene.integration;
  TracerTask task{scene, options, {}, threads};
  task.wanted.tolerance =
      std::max(integration.tolerance - reserved - storage_error(largest_color(scene)),
               0.25 * integration.tolerance);
  tolerance = task.wanted.tolerance;
  task.wanted.grade = integration.grade;
  task.wanted.precision = integration.precision;
  task.wanted.largest_color = std::max(largest_color(scene), brightest(scene.background));
  tracer = scene.mesh           ? make_mesh_tracer(task)
           : scene.multivariate ? make_multivariate_tracer(task)
                                : make_univariate_tracer(task);
}

}  // namespace pellucid
