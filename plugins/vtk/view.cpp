// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkLightCollection.h>
#include <vtkMatrix4x4.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <limits>

#include "pellucid/scene/error.h"

namespace pellucid::plugin {
namespace {

Vec3<double> vector_of(const double v[3]) {
  return {v[0], v[1], v[2]};
}

CameraSettings settings_of(vtkCamera& camera, double aspect) {
  CameraSettings made;
  made.position = vector_of(camera.GetPosition());
  made.focal_point = vector_of(camera.GetFocalPoint());
  made.up = vector_of(camera.GetViewUp());
  made.direction = vector_of(camera.GetDirectionOfProjection());
  made.is_parallel = camera.GetParallelProjection() != 0;
  made.aspect = aspect;
  made.projection = elements_of(*camera.GetProjectionTransformMatrix(aspect, -1, 1));
  const double* const shear = camera.GetViewShear();
  made.shear = {shear[0], shear[1]};
  made.is_off_axis = camera.GetUseOffAxisProjection() != 0;
  made.has_view_transform =
      camera.GetUserViewTransform() != nullptr || camera.GetUserTransform() != nullptr;
  if (vtkMatrix4x4* const model = camera.GetModelTransformMatrix()) {
    made.model = elements_of(*model);
  }
  return made;
}

LightSettings settings_of(vtkLight& light) {
  LightSettings made;
  made.is_head = light.LightTypeIsHeadlight() != 0;
  made.is_positional = light.GetPositional() != 0;
  double place[3];
  light.GetTransformedPosition(place);
  made.position = vector_of(place);
  light.GetTransformedFocalPoint(place);
  made.focal_point = vector_of(place);
  const double *const color = light.GetDiffuseColor(), *const ambient = light.GetAmbientColor();
  made.color = {color[0], color[1], color[2]};
  made.ambient = {ambient[0], ambient[1], ambient[2]};
  made.intensity = light.GetIntensity();
  std::copy_n(light.GetAttenuationValues(), 3, made.attenuation.begin());
  made.cone_angle = light.GetConeAngle();
  return made;
}

RendererLights settings_of(vtkRenderer& renderer) {
  RendererLights made;
  vtkLightCollection* const all = renderer.GetLights();
  for (int i = 0; i < all->GetNumberOfItems(); ++i) {
    vtkLight& light = *vtkLight::SafeDownCast(all->GetItemAsObject(i));
    if (light.GetSwitch() != 0) made.shining.push_back(settings_of(light));
  }
  made.are_two_sided = renderer.GetTwoSidedLighting() != 0;
  made.are_automatic = renderer.GetAutomaticLightCreation() != 0;
  return made;
}

}  // namespace

WindowView view_of(vtkRenderer& renderer, Notes& notes) {
  ViewSettings settings;
  int left = 0, bottom = 0;
  renderer.GetTiledSizeAndOrigin(&settings.width, &settings.height, &left, &bottom);
  settings.camera = settings_of(*renderer.GetActiveCamera(), renderer.GetTiledAspectRatio());
  renderer.GetPixelAspect(settings.pixel_aspect.data());
  vtkRenderWindow* const window = renderer.GetRenderWindow();
  settings.is_stereo = window != nullptr && window->GetStereoRender() != 0;
  settings.peels_volumes =
      renderer.GetUseDepthPeeling() != 0 && renderer.GetUseDepthPeelingForVolumes();
  return {vtk_scene::view_of(settings, notes), left, bottom};
}

std::vector<Light> lights_of(vtkRenderer& renderer, bool is_lit, Notes& notes) {
  return vtk_scene::lights_of(settings_of(renderer), settings_of(*renderer.GetActiveCamera(), 1),
                              is_lit, notes);
}

bool has_ambient_light(vtkRenderer& renderer) {
  return vtk_scene::has_ambient_light(settings_of(renderer));
}

std::shared_ptr<const Image> geometry_of(vtkRenderer& renderer, const WindowView& view) {
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

}  // namespace pellucid::plugin
