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

/// Checks the camera and builds the frame that makes rays. Throws Error (position equal to the
/// focal point, up parallel to the view, angle or scale out of range, sizes not in [1, 65536]).
CameraFrame<double> make_camera_frame(const Camera& camera, ImageSize size);

/// exact: the integral of the reconstructed data. The others are here for comparison,
/// docs/explanation/theory.md says which text gives each its name. Through a grid they march at a
/// fixed step, all but homogeneous, average and partial; preintegrated is for one volume, kniss and
/// gaussian are for channels. Through a mesh they make one segment of each tetrahedron:
/// homogeneous, average, partial and linear, and for Gaussians kniss and gaussian.
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
std::string_view method_name(Method method) noexcept;
std::optional<Method> method_from_name(std::string_view name) noexcept;

/// Limits of Integration::step. Below the smaller one a frame would take days, and in a large
/// volume the samples of a ray could no longer be told apart.
inline constexpr double smallest_step = 1e-4;
inline constexpr double largest_step = 1e6;
/// Limit of Scene::samples.
inline constexpr int largest_samples = 64;

/// Limits of Integration::tolerance. Images hold binary32, whose rounding next to 1 is 6e-8.
inline constexpr double smallest_tolerance = 1e-7;
inline constexpr double largest_tolerance = 1;
/// Half a step of 8 bits and better.
inline constexpr double default_tolerance = 1.0 / 512;

struct Integration {
  Method method = Method::exact;
  Precision precision = Precision::automatic;
  double step = 0.5;  ///< of the methods that march, in voxels (Volume::voxel_size)
  /// How far a pixel of the exact method may be from the integral, in each channel of premultiplied
  /// linear RGBA. render() throws Error where it is beyond the limits above.
  double tolerance = default_tolerance;
  Grade grade = Grade::estimated;

  /// Takes the tolerance nearest to `wanted` that is within the limits, and returns it. Throws
  /// Error where `wanted` is not a positive number.
  double set_tolerance(double wanted);
};

/// One volume with its transfer function, or several variables with a function of them all, seen by
/// a camera. Of a mesh: its channels with either function.
struct Scene {
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const TransferFunction> transfer_function;
  /// In place of the two above.
  std::shared_ptr<const Channels> channels;
  std::shared_ptr<const MultivariateTransferFunction> multivariate;
  /// In place of `volume` or `channels`.
  std::shared_ptr<const MeshChannels> mesh;
  Camera camera;
  ImageSize size;
  /// A pixel is the mean of samples × samples rays through the centres of its equal parts.
  int samples = 1;
  Integration integration;
  std::optional<Rgb<double>> background;  ///< linear; none: the image stays transparent
};

/// Throws Error where neither a volume with a transfer function nor channels with a multivariate
/// one nor a mesh with either are there, or more than these, or the function sees another number of
/// channels.
void check_data(const Scene& scene);
/// The volume whose grid the rays cross. Of a scene that check_data() accepts, as all below, and
/// that has no mesh.
const Volume& grid_volume(const Scene& scene) noexcept;
/// The corners of a box around the data: that of the grid, or one along the world's axes of a mesh.
std::array<Vec3<double>, 8> world_corners(const Scene& scene) noexcept;
/// Largest color component of the transfer function.
double largest_color(const Scene& scene) noexcept;

/// Throws Error where the samples of a pixel are beyond their limits, or what the method goes by
/// is: the tolerance of the exact one, the step of the others.
void check_integration(const Scene& scene);
/// Throws Error for a method that is not for such data or such a function. Of a scene that
/// check_data() accepts.
void check_method(const Scene& scene);

}  // namespace pellucid
