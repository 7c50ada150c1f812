// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>

#include "pellucid/cpu/render.h"

namespace pellucid {

/// The same scene by quadrature in double to 1e-12, cell by cell: adaptive Gauß-Kronrod
/// (Boost.Math); with a multivariate transfer function 20 nodes of Gauß and Legendre to parts that
/// are halved until no Gaussian can stand between them (src/reference/multivariate_ray.cpp). Slow.
/// Shares no kernel with the fast path: it has its own ray-plane sorting, search of tetrahedra
/// (each of which is met by itself), interpolation, transfer-function lookup, crossings and
/// quadrature. Method, precision, step, tolerance and grade
/// of the scene are not looked at, but refused where render() refuses them; a pixel is the mean of
/// its samples. Only RenderOptions and the report are shared with cpu/. Throws what
/// pellucid::render throws.
Image render_reference(const Scene& scene, const RenderOptions& options = {},
                       RenderReport* report = nullptr);

/// What one ray gathers, in double. Where the transparency falls below 1e-16 the ray ends: the
/// optical depth is that of the part gone through.
struct ReferencePixel {
  Rgb<double> radiance{};  ///< premultiplied
  double opacity = 0;
  double optical_depth = 0;
  /// World arc length at which half of the opacity is reached; infinite where the ray stays clear.
  double half_opacity_depth = std::numeric_limits<double>::infinity();
  /// World length of the ray that is in two tetrahedra at once: there the data have two values, and
  /// no integral is right.
  double overlap = 0;
};

/// Rays of render_reference through what a scene shows, without its camera. Copies share what is
/// made for them.
class ReferenceRays {
 public:
  /// Throws Error where check_data() does.
  explicit ReferenceRays(const Scene& scene);

  /// From `origin` (the ray begins there) along `direction` (world space, any length but 0). Throws
  /// Error for a direction of length 0. Safe to call from any thread.
  ReferencePixel operator()(const Vec3<double>& origin, const Vec3<double>& direction) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

/// One ray of render_reference, from `origin` (the ray begins there) along `direction` (world
/// space, any length but 0). Throws Error for a direction of length 0.
ReferencePixel reference_ray(const Volume& volume, const TransferFunction& transfer_function,
                             const Vec3<double>& origin, const Vec3<double>& direction);
/// The same through several channels. Throws Error, too, where the function sees another number of
/// them.
ReferencePixel reference_ray(const Channels& channels,
                             const MultivariateTransferFunction& transfer_function,
                             const Vec3<double>& origin, const Vec3<double>& direction);
/// The same through what the scene shows; ReferenceRays are faster where there are many. Throws
/// Error, too, where check_data() does.
ReferencePixel reference_ray(const Scene& scene, const Vec3<double>& origin,
                             const Vec3<double>& direction);

}  // namespace pellucid
