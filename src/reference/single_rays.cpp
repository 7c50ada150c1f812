// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "pellucid/reference/render.h"
#include "pellucid/scene/error.h"
#include "scene_integral.h"

namespace pellucid {

using reference::SceneIntegral;

struct ReferenceRays::Parts {
  explicit Parts(const Scene& shown) : scene(shown), integral(scene) {}

  Scene scene;  ///< Keeps what the integral is a view of.
  SceneIntegral integral;
};

ReferenceRays::ReferenceRays(const Scene& scene) {
  check_data(scene);
  parts_ = std::make_shared<const Parts>(scene);
}

ReferencePixel ReferenceRays::operator()(const Vec3<double>& origin, const Vec3<double>& direction,
                                         double end) const {
  return parts_->integral(origin, direction, end);
}

ReferencePixel reference_ray(const Volume& volume, const TransferFunction& transfer_function,
                             const Vec3<double>& origin, const Vec3<double>& direction) {
  return SceneIntegral(volume, transfer_function)(origin, direction);
}

ReferencePixel reference_ray(const Channels& channels,
                             const MultivariateTransferFunction& transfer_function,
                             const Vec3<double>& origin, const Vec3<double>& direction) {
  if (channels.count() != transfer_function.channels()) {
    throw Error("reference ray: the transfer function sees " +
                std::to_string(transfer_function.channels()) + " channels, but there are " +
                std::to_string(channels.count()) + "; make it for as many");
  }
  return SceneIntegral(channels, transfer_function)(origin, direction);
}

ReferencePixel reference_ray(const Scene& scene, const Vec3<double>& origin,
                             const Vec3<double>& direction) {
  return ReferenceRays(scene)(origin, direction);
}

}  // namespace pellucid
