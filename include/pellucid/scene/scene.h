// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "pellucid/error/grade.h"
#include "pellucid/error/precision.h"
#include "pellucid/render/camera.h"
#include "pellucid/scene/channels.h"
#include "pellucid/scene/mesh_channels.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/scene/transfer_function.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

enum class Projection { perspective, orthographic };

/// Where the picture is taken from, in world space.
struct Camera {
  Projection projection = Projection::perspective;
  Vec3<double> position{0, 0, 1};
  Vec3<double> focal_point{0, 0, 0};
  Vec3<double> up{0, 1, 0};    ///< not parallel to the view direction
  double vertical_angle = 30;  ///< degrees, in (0, 180); perspective
  double parallel_scale = 1;   ///< half of the image's height in world units; orthographic
};

struct ImageSize {
  int width = 512, height = 512;
};

/// Checks the camera and returns the frame that makes rays. Throws Error if the position equals the
/// focal point, up is parallel to the view direction, the angle or scale is out of range, or a size
/// is not in [1, 65536].
CameraFrame<double> make_camera_frame(const Camera& camera, ImageSize size);

/// How rays are integrated. `exact` computes the integral of the reconstructed data. The other
/// methods are there for comparison; docs/explanation/theory.md names their sources.
///
/// - Through a grid all of them but homogeneous, average and partial march at a fixed step;
///   preintegrated needs a single volume, kniss and gaussian need channels.
/// - Through a mesh homogeneous, average, partial and linear, and for Gaussians kniss and gaussian,
///   compute one segment per tetrahedron.
enum class Method {
  exact,
  rectangle,
  taylor,
  midpoint,
  trapezoid,
  simpson,
  linear,
  preintegrated,
  kniss,
  gaussian,
  homogeneous,
  average,
  partial
};
/// Returns the name of a method as in scene files.
std::string_view method_name(Method method) noexcept;
/// Returns the method of this name, or none.
std::optional<Method> method_from_name(std::string_view name) noexcept;

/// Limits of Integration::step. Below the smaller one a frame takes days, and the samples of a ray
/// through a large volume cannot be told apart.
inline constexpr double smallest_step = 1e-4;
inline constexpr double largest_step = 1e6;
/// Upper limit of Scene::samples.
inline constexpr int largest_samples = 64;

/// Limits of Integration::tolerance. Images hold binary32, whose rounding error next to 1 is 6e-8.
inline constexpr double smallest_tolerance = 1e-7;
inline constexpr double largest_tolerance = 1;
/// Half of a step of 8 bits.
inline constexpr double default_tolerance = 1.0 / 512;

/// How a scene is integrated, and how accurately.
struct Integration {
  Method method = Method::exact;
  Precision precision = Precision::automatic;
  double step = 0.5;  ///< of the marching methods, in voxels (Volume::voxel_size)
  /// Largest error of a pixel of the exact method, in each channel of premultiplied linear RGBA.
  /// render() throws Error if it is outside of the limits above.
  double tolerance = default_tolerance;
  Grade grade = Grade::estimated;

  /// Sets the tolerance to `wanted`, clamped to the limits, and returns it. Throws Error if
  /// `wanted` is not a positive number.
  double set_tolerance(double wanted);
};

/// A volume with its transfer function, several channels with a multivariate one, or a mesh with
/// either, as seen by a camera.
struct Scene {
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const TransferFunction> transfer_function;
  /// Replaces `volume` and `transfer_function`.
  std::shared_ptr<const Channels> channels;
  std::shared_ptr<const MultivariateTransferFunction> multivariate;
  /// Replaces `volume` or `channels`.
  std::shared_ptr<const MeshChannels> mesh;
  Camera camera;
  ImageSize size;
  /// A pixel is the mean of samples × samples rays through the centres of its equal parts.
  int samples = 1;
  Integration integration;
  std::optional<Rgb<double>> background;  ///< linear; none: the image stays transparent
};

/// Throws Error unless the scene has exactly one of: a volume with a transfer function, channels
/// with a multivariate one, a mesh with either. Also throws if the function expects another number
/// of channels.
void check_data(const Scene& scene);
/// Returns the volume whose grid the rays cross. The scene must have passed check_data() and have
/// no mesh.
const Volume& grid_volume(const Scene& scene) noexcept;
/// Returns the corners of a box around the data: the grid's own box, or for a mesh a box along the
/// world's axes. The scene must have passed check_data().
std::array<Vec3<double>, 8> world_corners(const Scene& scene) noexcept;
/// Returns the largest color component of the transfer function. The scene must have passed
/// check_data().
double largest_color(const Scene& scene) noexcept;

/// Throws Error if the number of samples per pixel, the tolerance of the exact method, or the step
/// of another method is outside of its limits.
void check_integration(const Scene& scene);
/// Throws Error if the method does not support the scene's data or transfer function. The scene
/// must have passed check_data().
void check_method(const Scene& scene);

}  // namespace pellucid
