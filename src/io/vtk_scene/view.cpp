// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>

#include "pellucid/math/constants.h"
#include "pellucid/scene/error.h"

namespace pellucid::vtk_scene {
namespace {

/// Largest shift of the window of a camera, in pixels.
constexpr int largest_shift = 16384;
/// Largest number of pixels of the picture of which a camera's window is a part: it is kept whole.
constexpr double largest_picture = 1e8;

/// Returns twice what a window's center is away from the middle, in whole pixels: the picture of
/// which the window is a part is larger by as much. Where parts of a window begin and end between
/// pixels, VTK rounds them to pixels, too.
int pixels_off(double center, int side, Notes& notes) {
  const double pixels = center * side;
  const double whole = std::round(pixels);
  if (!(std::abs(whole) <= 2 * largest_shift)) {
    throw Error("camera: its WindowCenter moves the picture by " + std::to_string(pixels / 2) +
                " pixels; set one that moves it by up to " + std::to_string(largest_shift));
  }
  if (std::abs(pixels - whole) > 1e-3) {
    notes.add("the camera's WindowCenter is taken to the nearest half of a pixel");
  }
  return static_cast<int>(whole);
}

/// Frustum of a projection matrix, which maps view coordinates to those from -1 to 1.
struct Frustum {
  double half_height = 0;     ///< at distance 1, or anywhere if rays are parallel
  double center[2] = {0, 0};  ///< as a camera's WindowCenter
  Depths depths;
};

/// Throws Error for a projection by which pixels, which are `aspect` times as many across as up,
/// are not square, or which is none of a pinhole or of parallel rays along the view direction.
Frustum frustum_of(const CameraSettings& camera) {
  const double aspect = camera.aspect;
  const auto p = [&](std::size_t row, std::size_t column) {
    return camera.projection[4 * row + column];
  };
  Frustum made;
  made.depths.is_parallel = p(3, 2) == 0;
  const double divisor = made.depths.is_parallel ? p(3, 3) : -p(3, 2);
  const double across = p(0, 0) / divisor, up = p(1, 1) / divisor;
  // What a lens without shear leaves 0; c is the column of the window's center.
  const std::size_t c = made.depths.is_parallel ? 3 : 2, other = 5 - c;
  double rest = 0;
  for (const double zero : {p(0, 1), p(1, 0), p(2, 0), p(2, 1), p(3, 0), p(3, 1), p(0, other),
                            p(1, other), made.depths.is_parallel ? 0 : p(3, 3)}) {
    rest = std::max(rest, std::abs(zero));
  }
  if (!(divisor > 0) || !(across > 0) || !(up > 0) || !(rest <= 1e-9 * divisor)) {
    throw Error("camera: its projection is none of a pinhole or of parallel rays; take a frustum");
  }
  if (!(std::abs(across * aspect - up) <= 1e-6 * up)) {
    throw Error("camera: by its projection pixels are not square; take one of the aspect ratio " +
                std::to_string(aspect));
  }
  made.half_height = 1 / up;
  const double sign = made.depths.is_parallel ? -1 : 1;
  made.center[0] = sign * p(0, c) / divisor;
  made.center[1] = sign * p(1, c) / divisor;
  const double slope = p(2, 2) / divisor, constant = p(2, 3) / divisor;
  const auto distance = [&](double z) {
    if (made.depths.is_parallel) return (constant - z) / slope;
    return slope + z == 0 ? std::numeric_limits<double>::infinity() : constant / (slope + z);
  };
  made.depths.near = distance(-1);
  made.depths.far = distance(1);
  if (!made.depths.is_parallel && !(made.depths.near > 0)) {
    throw Error("camera: its projection begins behind the camera; take a frustum in front of it");
  }
  if (!(made.depths.near < made.depths.far)) {
    throw Error("camera: its projection shows nothing from near to far; take a frustum");
  }
  return made;
}

void refuse_others(const ViewSettings& view) {
  const CameraSettings& camera = view.camera;
  if (camera.shear[0] != 0 || camera.shear[1] != 0) {
    throw Error("camera: its ViewShear is not 0; set it to 0 0 1");
  }
  if (camera.is_off_axis) {
    throw Error("camera: its projection is off-axis by a screen; set UseOffAxisProjectionOff()");
  }
  if (camera.has_view_transform) {
    throw Error("camera: has a transform of the view; move the camera instead");
  }
  for (std::size_t i = 0; camera.model && i < 16; ++i) {
    if ((*camera.model)[i] != (i % 5 == 0 ? 1 : 0)) {
      throw Error("camera: has a transform of the model; move the volumes instead");
    }
  }
  if (view.is_stereo) throw Error("window: shows two eyes; call StereoRenderOff()");
  if (view.peels_volumes) {
    throw Error("renderer: peels volumes; call UseDepthPeelingForVolumesOff()");
  }
  if (view.pixel_aspect[0] != view.pixel_aspect[1]) {
    throw Error("renderer: its pixels are not square; set PixelAspect 1 1");
  }
}

/// Returns a head light as the GPU mapper has it: alone it is at the camera, also of parallel rays;
/// beside others it shines along the camera's axis.
std::variant<HeadLight, DirectionalLight, PointLight> head_light(const CameraSettings& camera,
                                                                 bool is_alone, bool is_lit,
                                                                 Notes& notes) {
  if (!is_alone) return DirectionalLight{camera.direction};
  if (!camera.is_parallel) return HeadLight{};
  if (is_lit) {
    notes.add(
        "VTK sees its head light from where a ray enters the data, here it is seen from each "
        "point");
  }
  return PointLight{camera.position};
}

}  // namespace

double Depths::along_view(double depth) const noexcept {
  if (is_parallel) return near + depth * (far - near);
  if (std::isinf(far)) return near / (1 - depth);
  return near * far / (far - depth * (far - near));
}

View view_of(const ViewSettings& settings, Notes& notes) {
  refuse_others(settings);
  const CameraSettings& camera = settings.camera;
  View view;
  view.width = settings.width;
  view.height = settings.height;
  if (view.width < 1 || view.height < 1) throw Error("renderer: has no size; add it to a window");
  const Frustum frustum = frustum_of(camera);
  const int across = pixels_off(frustum.center[0], view.width, notes);
  const int up = pixels_off(frustum.center[1], view.height, notes);
  view.size = {view.width + std::abs(across), view.height + std::abs(up)};
  if (1.0 * view.size.width * view.size.height > largest_picture) {
    throw Error("camera: its WindowCenter makes it a part of a picture of " +
                std::to_string(view.size.width) + " x " + std::to_string(view.size.height) +
                " pixels; take fewer tiles");
  }
  view.column = std::max(across, 0);
  view.row = std::max(-up, 0);

  const double half = frustum.half_height * view.size.height / view.height;
  view.depths = frustum.depths;
  view.camera.projection =
      view.depths.is_parallel ? Projection::orthographic : Projection::perspective;
  view.camera.position = camera.position;
  view.camera.focal_point = camera.focal_point;
  view.camera.up = camera.up;
  if (view.depths.is_parallel) {
    view.camera.parallel_scale = half;
  } else {
    view.camera.vertical_angle = std::atan(half) * 360 / pi<double>;
  }
  return view;
}

std::vector<Light> lights_of(const RendererLights& given, const CameraSettings& camera, bool is_lit,
                             Notes& notes) {
  std::vector<Light> lights;
  const bool is_alone = given.shining.size() <= 1;
  for (const LightSettings& light : given.shining) {
    if (std::max({light.ambient.r, light.ambient.g, light.ambient.b}) > 0 &&
        !has_ambient_light(given)) {
      notes.add("the ambient color of lights is left out");
    }
    Light made;
    const double intensity = std::max(light.intensity, 0.0);
    const auto part = [&](double c) { return std::max(intensity * c, 0.0); };
    made.color = {part(light.color.r), part(light.color.g), part(light.color.b)};
    if (light.is_head) {
      made.kind = head_light(camera, is_alone, is_lit, notes);
    } else if (light.is_positional) {
      if (light.attenuation != std::array<double, 3>{1, 0, 0} || light.cone_angle < 90) {
        notes.add("a light has a cone or an attenuation, which is left out");
      }
      made.kind = PointLight{light.position};
    } else {
      made.kind = DirectionalLight{light.focal_point - light.position};
    }
    try {
      check_light(made, "light");
      lights.push_back(made);
    } catch (const Error& error) {
      notes.add(std::string(error.what()) + "; it is left out");
    }
  }
  if (is_lit && !given.are_two_sided) {
    notes.add("both sides reflect light here, whatever TwoSidedLighting says");
  }
  // VTK makes a head light of its own if none shines.
  if (given.shining.empty() && given.are_automatic) {
    lights.push_back({head_light(camera, true, is_lit, notes), {1, 1, 1}});
  }
  return lights;
}

bool has_ambient_light(const RendererLights& lights) {
  const auto& shining = lights.shining;
  return shining.empty() ||
         (shining.size() == 1 && shining[0].is_head && shining[0].intensity == 1);
}

std::vector<Clip> depth_clips(const View& view, const std::array<double, 6>& bounds) {
  const Vec3<double> position = view.camera.position;
  const Vec3<double> forward = make_camera_frame(view.camera, view.size).forward;
  const auto [near, far, is_parallel] = view.depths;
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const Vec3<double> point{bounds[corner & 1U], bounds[2 + (corner >> 1U & 1U)],
                             bounds[4 + (corner >> 2U)]};
    const double depth = dot(point - position, forward);
    first = std::min(first, depth);
    last = std::max(last, depth);
  }
  std::vector<Clip> clips;
  if (first < near) clips.push_back({ClipPlane{position + forward * near, forward}});
  if (last > far) clips.push_back({ClipPlane{position + forward * far, -forward}});
  return clips;
}

}  // namespace pellucid::vtk_scene
