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

/// Of the window of a camera, in pixels.
constexpr int largest_shift = 16384;
/// Of the picture that a window of a camera is a part of: it is kept whole.
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

double tangent_of_half(double degrees) {
  return std::tan(degrees * pi<double> / 360);
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
  if (camera.GetUseExplicitProjectionTransformMatrix() || camera.GetUseExplicitAspectRatio()) {
    throw Error(
        "camera: has an explicit projection or aspect ratio; set "
        "UseExplicitProjectionTransformMatrixOff() and UseExplicitAspectRatioOff()");
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

/// A head light as the GPU mapper has it: alone it is at the camera, also of parallel rays; beside
/// others it shines along the camera's axis.
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

/// Where a depth of the window's buffer is, along the view direction from the camera.
double along_view(vtkCamera& camera, double depth) {
  double near, far;
  camera.GetClippingRange(near, far);
  if (camera.GetParallelProjection() != 0) return near + depth * (far - near);
  return near * far / (far - depth * (far - near));
}

}  // namespace

View view_of(vtkRenderer& renderer, Notes& notes) {
  vtkCamera& camera = *renderer.GetActiveCamera();
  refuse_others(renderer, camera);
  View view;
  renderer.GetTiledSizeAndOrigin(&view.width, &view.height, &view.left, &view.bottom);
  if (view.width < 1 || view.height < 1) throw Error("renderer: has no size");
  double center[2];
  camera.GetWindowCenter(center);
  const int across = pixels_off(center[0], view.width, notes);
  const int up = pixels_off(center[1], view.height, notes);
  view.size = {view.width + std::abs(across), view.height + std::abs(up)};
  if (1.0 * view.size.width * view.size.height > largest_picture) {
    throw Error("camera: its WindowCenter makes it a part of a picture of " +
                std::to_string(view.size.width) + " x " + std::to_string(view.size.height) +
                " pixels; take fewer tiles");
  }
  view.column = std::max(across, 0);
  view.row = std::max(-up, 0);

  double tangent = tangent_of_half(camera.GetViewAngle());
  if (camera.GetUseHorizontalViewAngle() != 0) tangent *= double(view.height) / view.width;
  const double larger = double(view.size.height) / view.height;
  view.camera.projection =
      camera.GetParallelProjection() != 0 ? Projection::orthographic : Projection::perspective;
  view.camera.position = vector_of(camera.GetPosition());
  view.camera.focal_point = vector_of(camera.GetFocalPoint());
  view.camera.up = vector_of(camera.GetViewUp());
  view.camera.vertical_angle = std::atan(tangent * larger) * 360 / pi<double>;
  view.camera.parallel_scale = camera.GetParallelScale() * larger;
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
  vtkCamera& camera = *renderer.GetActiveCamera();
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
      end = static_cast<float>(along_view(camera, double{line[x]}) / slope);
    }
  }
  return image;
}

std::vector<Clip> depth_clips(vtkRenderer& renderer, const double bounds[6]) {
  vtkCamera& camera = *renderer.GetActiveCamera();
  const Vec3<double> position = vector_of(camera.GetPosition());
  const Vec3<double> forward = vector_of(camera.GetDirectionOfProjection());
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3<double> point{bounds[corner & 1], bounds[2 + (corner >> 1 & 1)],
                             bounds[4 + (corner >> 2)]};
    const double depth = dot(point - position, forward);
    first = std::min(first, depth);
    last = std::max(last, depth);
  }
  double near, far;
  camera.GetClippingRange(near, far);
  std::vector<Clip> clips;
  if (first < near) clips.push_back({ClipPlane{position + forward * near, forward}});
  if (last > far) clips.push_back({ClipPlane{position + forward * far, -forward}});
  return clips;
}

}  // namespace pellucid::plugin
