// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>

#include "pellucid/cpu/render.h"

namespace pellucid {

/// Renders the same scene by quadrature in double to 1e-12, cell by cell. Slow. It uses adaptive
/// Gauß-Kronrod (Boost.Math); with a multivariate transfer function it uses Gauß-Legendre with 20
/// nodes on parts that are halved until no Gaussian can be missed between them
/// (src/reference/mixture/multivariate_ray.cpp).
///
/// A scene with shading, gradient opacity, isosurfaces or slices is integrated to 1e-12 per part of
/// a ray: parts end where the light has a kink, and are halved until the halves agree with the
/// whole (src/reference/light/lit_gatherer.h).
///
/// It shares no kernel with the fast path: ray-plane sorting, search of tetrahedra (each is
/// intersected on its own), interpolation, gradients, transfer-function look-up, crossings, light
/// and quadrature are its own, and so are the extremes and means of projections. Only RenderOptions
/// and the result are shared with cpu/, and voxel_of() and flat_gradient() with scene/.
///
/// Method, precision, step, tolerance and grade of the scene are ignored, but refused if render()
/// refuses them. A pixel is the mean of its samples. Throws whatever pellucid::render() throws.
RenderResult render_reference(const Scene& scene, const RenderOptions& options = {});

/// The result of one ray, in double. The ray ends where the transparency falls below 1e-16; the
/// optical depth is that of the part in front.
struct ReferencePixel {
  Rgb<double> radiance{};  ///< premultiplied
  double opacity = 0;
  double optical_depth = 0;
  /// Distance from the origin, in world units, at which half of the opacity is reached; infinite
  /// for a transparent ray.
  double half_opacity_depth = std::numeric_limits<double>::infinity();
  /// Value of the last projected layer (Layer::projection); NaN without one.
  double value = std::numeric_limits<double>::quiet_NaN();
  /// Length of the ray, in world units, inside two tetrahedra at once. The data have two values
  /// there, and no integral is correct.
  double overlap = 0;
};

/// Traces rays of render_reference() through the data of a scene, without its camera. Copies share
/// the precomputed data.
class ReferenceRays {
 public:
  /// Throws Error if check_data() does.
  explicit ReferenceRays(const Scene& scene);

  /// Traces a ray that begins at `origin` along `direction` (world space, any length but 0), up to
  /// the distance `end`, in world units. Ignores the pixels of a backdrop. Throws Error if the
  /// direction has length 0, or `end` is finite and the scene has no backdrop. Safe to call from
  /// any thread.
  ReferencePixel operator()(const Vec3<double>& origin, const Vec3<double>& direction,
                            double end = std::numeric_limits<double>::infinity()) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

/// Traces one ray of render_reference() that begins at `origin` along `direction` (world space, any
/// length but 0). Throws Error if the direction has length 0.
ReferencePixel reference_ray(const Volume& volume, const TransferFunction& transfer_function,
                             const Vec3<double>& origin, const Vec3<double>& direction);
/// Traces the same ray through several channels. Also throws Error if the function expects another
/// number of channels.
ReferencePixel reference_ray(const Channels& channels,
                             const MultivariateTransferFunction& transfer_function,
                             const Vec3<double>& origin, const Vec3<double>& direction);
/// Traces the same ray through the data of a scene; use ReferenceRays for many rays. Also throws
/// Error if check_data() does.
ReferencePixel reference_ray(const Scene& scene, const Vec3<double>& origin,
                             const Vec3<double>& direction);

}  // namespace pellucid
