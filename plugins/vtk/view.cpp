// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkLightCollection.h>
#include <vtkMatrix4x4.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>

#include "pellucid/math/constants.h"
#include "pellucid/scene/error.h"

namespace pellucid::plugin {
namespace {

/// Largest shift of the window of a camera, in pixels.
constexpr int largest_shift = 16384;
/// Largest number of pixels of the picture of which a camera's window is a part: it is kept whole.
constexpr double largest_picture = 1e8;

Vec3<double> vector_of(const double v[3]) {
  return {v[0], v[1], v[2]};
}

/// Twice what a window's center is away from the middle, in whole pixels: what the picture of which
/// the window is a part is larger by. Where parts of a window begin and end between pixels, VTK
/// rounds them to pixels, too.
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
Frustum frustum_of(vtkCamera& camera, double aspect) {
  const vtkMatrix4x4& matrix = *camera.GetProjectionTransformMatrix(aspect, -1, 1);
  const auto p = [&](int row, int column) { return matrix.GetElement(row, column); };
  Frustum made;
  made.depths.is_parallel = p(3, 2) == 0;
  const double divisor = made.depths.is_parallel ? p(3, 3) : -p(3, 2);
  const double across = p(0, 0) / divisor, up = p(1, 1) / divisor;
  // What a lens without shear leaves 0; c is the column of the window's center.
  const int c = made.depths.is_parallel ? 3 : 2, other = 5 - c;
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

void refuse_others(vtkRenderer& renderer, vtkCamera& camera) {
  double shear[3];
  camera.GetViewShear(shear);
  if (shear[0] != 0 || shear[1] != 0) {
    throw Error("camera: its ViewShear is not 0; set it to 0 0 1");
  }
  if (camera.GetUseOffAxisProjection() != 0) {
    throw Error("camera: its projection is off-axis by a screen; set UseOffAxisProjectionOff()");
  }
  if (camera.GetUserViewTransform() != nullptr || camera.GetUserTransform() != nullptr) {
    throw Error("camera: has a transform of the view; move the camera instead");
  }
  vtkMatrix4x4* const model = camera.GetModelTransformMatrix();
  for (int i = 0; model != nullptr && i < 16; ++i) {
    if (model->GetElement(i / 4, i % 4) != (i % 5 == 0 ? 1 : 0)) {
      throw Error("camera: has a transform of the model; move the volumes instead");
    }
  }
  vtkRenderWindow* const window = renderer.GetRenderWindow();
  if (window != nullptr && window->GetStereoRender() != 0) {
    throw Error("window: shows two eyes; call StereoRenderOff()");
  }
  if (renderer.GetUseDepthPeeling() != 0 && renderer.GetUseDepthPeelingForVolumes()) {
    throw Error("renderer: peels volumes; call UseDepthPeelingForVolumesOff()");
  }
  double pixel[2];
  renderer.GetPixelAspect(pixel);
  if (pixel[0] != pixel[1]) throw Error("renderer: its pixels are not square; set PixelAspect 1 1");
}

/// Returns a head light as the GPU mapper has it: alone it is at the camera, also of parallel rays;
/// beside others it shines along the camera's axis.
std::variant<HeadLight, DirectionalLight, PointLight> head_light(vtkCamera& camera, int shining,
                                                                 bool is_lit, Notes& notes) {
  if (shining > 1) return DirectionalLight{vector_of(camera.GetDirectionOfProjection())};
  if (camera.GetParallelProjection() == 0) return HeadLight{};
  if (is_lit) {
    notes.add(
        "VTK sees its head light from where a ray enters the data, here it is seen from each "
        "point");
  }
  return PointLight{vector_of(camera.GetPosition())};
}

}  // namespace

double Depths::along_view(double depth) const noexcept {
  if (is_parallel) return near + depth * (far - near);
  if (std::isinf(far)) return near / (1 - depth);
  return near * far / (far - depth * (far - near));
}

View view_of(vtkRenderer& renderer, Notes& notes) {
  vtkCamera& camera = *renderer.GetActiveCamera();
  refuse_others(renderer, camera);
  View view;
  renderer.GetTiledSizeAndOrigin(&view.width, &view.height, &view.left, &view.bottom);
  if (view.width < 1 || view.height < 1) throw Error("renderer: has no size");
  const Frustum frustum = frustum_of(camera, renderer.GetTiledAspectRatio());
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
  view.camera.position = vector_of(camera.GetPosition());
  view.camera.focal_point = vector_of(camera.GetFocalPoint());
  view.camera.up = vector_of(camera.GetViewUp());
  if (view.depths.is_parallel) {
    view.camera.parallel_scale = half;
  } else {
    view.camera.vertical_angle = std::atan(half) * 360 / pi<double>;
  }
  return view;
}

std::vector<Light> lights_of(vtkRenderer& renderer, bool is_lit, Notes& notes) {
  std::vector<Light> lights;
  vtkLightCollection* const all = renderer.GetLights();
  int shining = 0;
  for (int i = 0; i < all->GetNumberOfItems(); ++i) {
    shining += vtkLight::SafeDownCast(all->GetItemAsObject(i))->GetSwitch() != 0 ? 1 : 0;
  }
  const std::variant<HeadLight, DirectionalLight, PointLight> head =
      head_light(*renderer.GetActiveCamera(), shining, is_lit, notes);
  for (int i = 0; i < all->GetNumberOfItems(); ++i) {
    vtkLight& light = *vtkLight::SafeDownCast(all->GetItemAsObject(i));
    if (light.GetSwitch() == 0) continue;
    const double* const color = light.GetDiffuseColor();
    const double* const ambient = light.GetAmbientColor();
    if ((ambient[0] > 0 || ambient[1] > 0 || ambient[2] > 0) && !has_ambient_light(renderer)) {
      notes.add("the ambient color of lights is left out");
    }
    Light made;
    const double intensity = std::max(light.GetIntensity(), 0.0);
    const auto part = [&](int c) { return std::max(intensity * color[c], 0.0); };
    made.color = {part(0), part(1), part(2)};
    if (light.LightTypeIsHeadlight() != 0) {
      made.kind = head;
    } else if (light.GetPositional() != 0) {
      const double* const fade = light.GetAttenuationValues();
      if (fade[0] != 1 || fade[1] != 0 || fade[2] != 0 || light.GetConeAngle() < 90) {
        notes.add("a light has a cone or an attenuation, which is left out");
      }
      made.kind = PointLight{vector_of(light.GetTransformedPosition())};
    } else {
      double from[3], to[3];
      light.GetTransformedPosition(from);
      light.GetTransformedFocalPoint(to);
      made.kind = DirectionalLight{vector_of(to) - vector_of(from)};
    }
    try {
      check_light(made, "light");
      lights.push_back(made);
    } catch (const Error& error) {
      notes.add(std::string(error.what()) + "; it is left out");
    }
  }
  if (is_lit && renderer.GetTwoSidedLighting() == 0) {
    notes.add("both sides reflect light here, whatever TwoSidedLighting says");
  }
  // VTK makes a head light of its own if none shines.
  if (lights.empty() && renderer.GetAutomaticLightCreation() != 0) {
    lights.push_back({head, {1, 1, 1}});
  }
  return lights;
}

bool has_ambient_light(vtkRenderer& renderer) {
  vtkLightCollection* const all = renderer.GetLights();
  int on = 0;
  bool plain = true;
  for (int i = 0; i < all->GetNumberOfItems(); ++i) {
    vtkLight& light = *vtkLight::SafeDownCast(all->GetItemAsObject(i));
    if (light.GetSwitch() == 0) continue;
    ++on;
    plain = plain && light.LightTypeIsHeadlight() != 0 && light.GetIntensity() == 1;
  }
  return on == 0 || (on == 1 && plain);
}

Affine<double> affine_of(vtkMatrix4x4& matrix, const char* what) {
  Affine<double> affine;
  for (int c = 0; c < 3; ++c) {
    affine.matrix.column[c] = {matrix.GetElement(0, c), matrix.GetElement(1, c),
                               matrix.GetElement(2, c)};
  }
  affine.translation = {matrix.GetElement(0, 3), matrix.GetElement(1, 3), matrix.GetElement(2, 3)};
  for (int c = 0; c < 4; ++c) {
    if (matrix.GetElement(3, c) != (c == 3 ? 1 : 0)) {
      throw Error(std::string(what) +
                  ": its matrix is not affine; take one whose last row is "
                  "0 0 0 1");
    }
  }
  if (!(std::abs(determinant(affine.matrix)) > 0)) {
    throw Error(std::string(what) + ": its matrix is singular; take one that can be inverted");
  }
  return affine;
}

std::shared_ptr<const Image> geometry_of(vtkRenderer& renderer, const View& view) {
  vtkRenderWindow* const window = renderer.GetRenderWindow();
  if (window == nullptr) throw Error("renderer: has no window");
  std::vector<float> depths(static_cast<std::size_t>(view.width) *
                            static_cast<std::size_t>(view.height));
  if (window->GetZbufferData(view.left, view.bottom, view.left + view.width - 1,
                             view.bottom + view.height - 1, depths.data()) != VTK_OK) {
    throw Error("window: its depths cannot be read");
  }
  const auto nothing = [](float depth) { return !(depth < 1); };
  if (!view.is_cut() && std::ranges::all_of(depths, nothing)) return nullptr;

  auto image = std::make_shared<Image>();
  image->width = view.size.width;
  image->height = view.size.height;
  const auto count =
      static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height);
  image->pixels.assign(count, {0, 0, 0, 0});
  image->depth.assign(count, 0.0F);
  const CameraFrame<double> frame = make_camera_frame(view.camera, view.size);
  for (int y = 0; y < view.height; ++y) {
    const float* const line =
        depths.data() + static_cast<std::ptrdiff_t>(view.height - 1 - y) * view.width;
    for (int x = 0; x < view.width; ++x) {
      const int column = view.column + x, row = view.row + y;
      float& end =
          image->depth[static_cast<std::size_t>(row) * static_cast<std::size_t>(image->width) +
                       static_cast<std::size_t>(column)];
      if (nothing(line[x])) {
        end = std::numeric_limits<float>::infinity();
        continue;
      }
      const double slope = dot(frame.ray(column, row).direction, frame.forward);
      end = static_cast<float>(view.depths.along_view(double{line[x]}) / slope);
    }
  }
  return image;
}

std::vector<Clip> depth_clips(const View& view, const double bounds[6]) {
  const Vec3<double> position = view.camera.position;
  const Vec3<double> forward = make_camera_frame(view.camera, view.size).forward;
  const auto [near, far, is_parallel] = view.depths;
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3<double> point{bounds[corner & 1], bounds[2 + (corner >> 1 & 1)],
                             bounds[4 + (corner >> 2)]};
    const double depth = dot(point - position, forward);
    first = std::min(first, depth);
    last = std::max(last, depth);
  }
  std::vector<Clip> clips;
  if (first < near) clips.push_back({ClipPlane{position + forward * near, forward}});
  if (last > far) clips.push_back({ClipPlane{position + forward * far, -forward}});
  return clips;
}

}  // namespace pellucid::plugin
