// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/error/grade.h"
#include "pellucid/error/precision.h"
#include "pellucid/render/camera.h"
#include "pellucid/scene/background.h"
#include "pellucid/scene/clip.h"
#include "pellucid/scene/image.h"
#include "pellucid/scene/layer.h"

namespace pellucid {

enum class Projection { perspective, orthographic };

/// Camera of a picture, in world space.
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

/// Directions of a picture in world space: of length 1 and at right angles.
struct CameraAxes {
  Vec3<double> right, up;  ///< in the picture
  Vec3<double> forward;    ///< from the camera to what it looks at
};
/// Returns the axes of a camera. Throws Error if a number is not finite, the position equals the
/// focal point, or up is parallel to the view direction.
CameraAxes camera_axes(const Camera& camera);

/// Checks the camera and returns the frame that makes rays. Throws Error as camera_axes() does, and
/// if the angle or scale is out of range, or a size is not in [1, 65536].
CameraFrame<double> make_camera_frame(const Camera& camera, ImageSize size);

/// Method by which rays are integrated. `exact` computes the integral of the reconstructed data.
/// The other methods are there for comparison; docs/explanation/theory.md names their sources.
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
/// Names of the methods as in scene files.
inline constexpr const char* method_names[] = {
    "exact",         "rectangle", "taylor",   "midpoint",    "trapezoid", "simpson", "linear",
    "preintegrated", "kniss",     "gaussian", "homogeneous", "average",   "partial"};
/// Returns the name of a method as in scene files.
std::string_view method_name(Method method) noexcept;
/// Returns the method of this name, or none.
std::optional<Method> method_from_name(std::string_view name) noexcept;

/// Returns whether a method takes the tetrahedra of meshes for its segments, where a scene shows
/// nothing else; else it goes in steps.
bool takes_cells(Method method) noexcept;

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

/// Method and accuracy of the integration of a scene.
struct Integration {
  Method method = Method::exact;
  Precision precision = Precision::automatic;
  /// Step of the sampling methods, in voxels of the finest layer that is there:
  /// Volume::voxel_size(), of a mesh voxel_of() (scene/layer.h).
  double step = 0.5;
  /// Largest error of a pixel of the exact method, in each channel of premultiplied linear RGBA.
  /// render() throws Error if it is outside of the limits above.
  double tolerance = default_tolerance;
  Grade grade = Grade::estimated;
  /// Tolerance as a share of the picture's largest channel, in (0, 1]. The program `pellucid`
  /// renders to find the tolerance of that; make_scene() and render() use `tolerance` alone.
  std::optional<double> relative_tolerance{};

  bool operator==(const Integration&) const = default;
};
/// Returns the tolerance within the limits that is nearest to `wanted`. Throws Error if `wanted` is
/// not a positive number. Programs in which a person asks for a tolerance use it, and say where it
/// differs; nothing else changes a tolerance that is out of range, but refuses it.
double nearest_tolerance(double wanted);

/// Settings of a picture beside its layers and its camera: those of a Scene and those that a file
/// has (SceneDescription).
struct SceneSettings {
  std::vector<Clip> clips;  ///< for all layers; what all of them keep is shown
  std::vector<Light> lights = std::vector<Light>(1);  ///< for all layers that have a shading
  ImageSize size;
  /// A pixel is the mean of samples × samples rays through the centres of its equal parts.
  int samples = 1;
  Integration integration;
  std::optional<Background> background;  ///< none: the image stays transparent
};

/// Picture to render: data, camera and accuracy. Where layers overlap, their extinctions add, and
/// so do extinction · color: a mixture of particles (Max 1995). The order of the layers does not
/// matter, except among projected ones (Layer::projection).
struct Scene : SceneSettings {
  Scene() = default;
  /// Makes a scene of one layer, seen by default_camera() of visible_corners(). Throws Error unless
  /// the layer passes check_layer(), and if a size is not in [1, 65536].
  explicit Scene(Layer layer, ImageSize wanted = {});

  std::vector<Layer> layers;
  Camera camera;
  /// A picture of geometry among the data, for example of a host program: as large as `size`, with
  /// a depth per pixel (Image::depth, a distance from the ray's origin; infinite where there is
  /// nothing). Rays end there, and its pixels are behind what they gather. May be null.
  std::shared_ptr<const Image> backdrop{};
};

/// Returns whether the scene's method has the tetrahedra of meshes for its segments: takes_cells()
/// of the method, and all visible layers that are not projected are meshes.
bool takes_cells(const Scene& scene) noexcept;

/// Throws Error unless there is a layer and every layer passes check_layer().
void check_data(const Scene& scene);
/// Returns the corners of a box around the data: of a single visible layer its world_corners(), of
/// several a box along the world's axes; of all layers if none is visible. The scene must have
/// passed check_data().
std::array<Vec3<double>, 8> world_corners(const Scene& scene) noexcept;
/// Returns the same around what absorbs (visible_corners() of the layers).
std::array<Vec3<double>, 8> visible_corners(const Scene& scene, const ParallelFor& parallel = {});
/// Returns the largest color component of the visible layers' functions and surfaces, in the light
/// of the scene. The scene must have passed check_data().
double largest_color(const Scene& scene) noexcept;
/// Returns the largest color component that may be seen behind a part of a layer: of the background
/// and of the backdrop, and if several layers are visible also of their functions. The scene must
/// have passed check_data().
double brightest_behind(const Scene& scene) noexcept;
/// Returns an upper bound on the error of a pixel because the visible layers' functions approximate
/// others. Errors of layers add; beside other layers they double, because the change of the
/// extinction is seen in a layer's own color, not in that of the mixture.
double approximation_error(const Scene& scene);
/// Returns the scene's only layer; null if there are none or several.
const Layer* only_layer(const Scene& scene) noexcept;
/// Returns the content of that kind of the scene's only layer; null if there is none.
template <class Content>
const Content* only_content(const Scene& scene) noexcept {
  const Layer* const layer = only_layer(scene);
  return layer != nullptr ? std::get_if<Content>(&layer->content) : nullptr;
}

/// Throws Error if the number of samples per pixel, the tolerance of the exact method, or the step
/// of another method is outside of its limits, or the backdrop has another size, no depth, or
/// numbers out of range.
void check_integration(const Scene& scene);
/// Throws Error if the method does not support the scene's data or transfer function: methods other
/// than exact need a single layer of a grid or a mesh, without clips, projection and backdrop. The
/// scene must have passed check_data().
void check_method(const Scene& scene);
/// Throws Error unless a pixel has one value: exactly one visible layer is projected, and samples
/// is 1.
void check_values(const Scene& scene);

}  // namespace pellucid
