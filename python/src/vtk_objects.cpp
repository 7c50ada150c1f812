// SPDX-License-Identifier: Apache-2.0
#include "vtk_objects.h"

#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace pellucid::python {

using namespace vtk_scene;  // NOLINT(google-build-using-namespace): what is filled in here

namespace {

/// VTK's numbers of a scale, an interpolation, a mode of functions and a mode of rendering.
constexpr int log10_scale = 1, linear_interpolation = 1, one_variable = 0, ray_cast = 1;

Vec3<double> vec3_of(const py::object& numbers) {
  const auto [x, y, z] = py::cast<std::array<double, 3>>(numbers);
  return {x, y, z};
}

Rgb<double> rgb_of(const py::object& numbers) {
  const auto [r, g, b] = py::cast<std::array<double, 3>>(numbers);
  return {r, g, b};
}

py::list zeros(int count) {
  py::list numbers;
  for (int i = 0; i < count; ++i) numbers.append(0.0);
  return numbers;
}

std::vector<std::vector<double>> nodes_of(const VtkObject& function, int count) {
  std::vector<std::vector<double>> nodes;
  for (int i = 0; i < function.get<int>("GetSize"); ++i) {
    const py::list node = zeros(count);
    if (function.get<int>("GetNodeValue", i, node) < 0) continue;
    nodes.push_back(py::cast<std::vector<double>>(node));
  }
  return nodes;
}

/// Returns whether this VTK's opacities jump where the sharpness is above 0.99.
bool opacities_jump(const VtkObject& function) {
  const VtkObject sharp = function.object("NewInstance");
  sharp("AddPoint", 0, 0, 0.5, 1);
  sharp("AddPoint", 1, 1, 0.5, 1);
  return sharp.get<double>("GetValue", 0.25) == 0;
}

/// Returns VTK's colors as its mappers take them: GetColor() of a discretized function has steps.
std::vector<Rgb<double>> colors_between(const VtkObject& function, double first, double last,
                                        int count) {
  const py::list table = zeros(3 * count);
  function("GetTable", first, last, count, table);
  const auto numbers = py::cast<std::vector<double>>(table);
  std::vector<Rgb<double>> colors;
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    colors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  }
  return colors;
}

Plane plane_of(const VtkObject& plane) {
  return {plane.vector("GetOrigin"), plane.vector("GetNormal")};
}

std::vector<VtkObject> items_of(const VtkObject& collection) {
  std::vector<VtkObject> items;
  for (int i = 0; i < collection.get<int>("GetNumberOfItems"); ++i) {
    items.push_back(collection.object("GetItemAsObject", i));
  }
  return items;
}

ComponentSettings component_of(const VtkObject& property, int c) {
  ComponentSettings made;
  made.opacity = opacities_of(property.object("GetScalarOpacity", c));
  made.is_grey = property.get<int>("GetColorChannels", c) == 1;
  made.color = made.is_grey ? opacities_of(property.object("GetGrayTransferFunction", c))
                            : colors_of(property.object("GetRGBTransferFunction", c));
  if (!property.get<bool>("GetDisableGradientOpacity", c) &&
      property.get<bool>("HasGradientOpacity", c)) {
    made.gradient_opacity = opacities_of(property.object("GetGradientOpacity", c));
  }
  made.unit_distance = property.get<double>("GetScalarOpacityUnitDistance", c);
  made.weight = property.get<double>("GetComponentWeight", c);
  if (property.get<bool>("GetShade", c)) {
    made.reflection = {property.get<double>("GetAmbient", c), property.get<double>("GetDiffuse", c),
                       property.get<double>("GetSpecular", c),
                       property.get<double>("GetSpecularPower", c)};
  }
  return made;
}

bool is_since_9_2() {
  const VtkObject version(py::module_::import("vtkmodules.vtkCommonCore").attr("vtkVersion"));
  return std::pair(version.get<int>("GetVTKMajorVersion"),
                   version.get<int>("GetVTKMinorVersion")) >= std::pair(9, 2);
}

CameraSettings camera_settings_of(const VtkObject& camera, double aspect) {
  CameraSettings made;
  made.position = camera.vector("GetPosition");
  made.focal_point = camera.vector("GetFocalPoint");
  made.up = camera.vector("GetViewUp");
  made.direction = camera.vector("GetDirectionOfProjection");
  made.is_parallel = camera.get<bool>("GetParallelProjection");
  made.aspect = aspect;
  made.projection = elements_of(camera.object("GetProjectionTransformMatrix", aspect, -1, 1));
  const Vec3<double> shear = camera.vector("GetViewShear");
  made.shear = {shear.x, shear.y};
  made.is_off_axis = camera.get<bool>("GetUseOffAxisProjection");
  made.has_view_transform = camera.object("GetUserViewTransform").is_there() ||
                            camera.object("GetUserTransform").is_there();
  if (const VtkObject model = camera.object("GetModelTransformMatrix"); model.is_there()) {
    made.model = elements_of(model);
  }
  return made;
}

LightSettings light_settings_of(const VtkObject& light) {
  LightSettings made;
  made.is_head = light.get<bool>("LightTypeIsHeadlight");
  made.is_positional = light.get<bool>("GetPositional");
  made.position = light.vector("GetTransformedPosition");
  made.focal_point = light.vector("GetTransformedFocalPoint");
  made.color = light.color("GetDiffuseColor");
  made.ambient = light.color("GetAmbientColor");
  made.intensity = light.get<double>("GetIntensity");
  made.attenuation = light.get<std::array<double, 3>>("GetAttenuationValues");
  made.cone_angle = light.get<double>("GetConeAngle");
  return made;
}

}  // namespace

Vec3<double> VtkObject::vector(const char* method) const {
  return vec3_of((*this)(method));
}

Rgb<double> VtkObject::color(const char* method) const {
  return rgb_of((*this)(method));
}

Matrix elements_of(const VtkObject& matrix) {
  Matrix elements;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    elements[i] = matrix.get<double>("GetElement", i / 4, i % 4);
  }
  return elements;
}

FunctionSettings opacities_of(const VtkObject& function) {
  FunctionSettings made;
  for (const auto& n : nodes_of(function, 4)) {
    made.shape.nodes.push_back({n[0], {n[1], n[1], n[1]}, n[2], n[3]});
  }
  made.shape.is_logarithmic = function.get<bool>("GetUseLogScale");
  made.shape.jumps = opacities_jump(function);
  made.shape.is_clamped = function.get<bool>("GetClamping");
  made.own = [function](double first, double, int) -> std::vector<Rgb<double>> {
    const auto value = function.get<double>("GetValue", first);
    return {{value, value, value}};
  };
  return made;
}

FunctionSettings colors_of(const VtkObject& function) {
  FunctionSettings made;
  made.shape.is_color = true;
  for (const auto& n : nodes_of(function, 6)) {
    made.shape.nodes.push_back({n[0], {n[1], n[2], n[3]}, n[4], n[5]});
  }
  made.shape.space = function.get<int>("GetColorSpace");
  made.shape.wraps_hue = function.get<bool>("GetHSVWrap");
  made.shape.is_logarithmic = function.get<int>("GetScale") == log10_scale;
  made.shape.is_clamped = function.get<bool>("GetClamping");
  if (function.get<bool>("GetUseBelowRangeColor")) {
    made.shape.below = function.color("GetBelowRangeColor");
  }
  if (function.get<bool>("GetUseAboveRangeColor")) {
    made.shape.above = function.color("GetAboveRangeColor");
  }
  made.own = [function](double first, double last, int count) {
    return colors_between(function, first, last, count);
  };
  made.way = [function](const Rgb<double>& from, const Rgb<double>& to, int count) {
    const VtkObject way = function.object("NewInstance");
    way("SetColorSpaceToLabCIEDE2000");
    way("AddRGBPoint", 0, from.r, from.g, from.b);
    way("AddRGBPoint", 1, to.r, to.g, to.b);
    return colors_between(way, 0, 1, count);
  };
  made.is_indexed = function.get<bool>("GetIndexedLookup");
  if (function.is_a("vtkDiscretizableColorTransferFunction") &&
      function.get<bool>("GetDiscretize")) {
    made.steps = function.get<std::int64_t>("GetNumberOfValues");
  }
  return made;
}

PropertySettings property_of(const VtkObject& property, const std::vector<int>& components,
                             const std::vector<int>& labels) {
  PropertySettings made;
  for (const int c : components) made.components.push_back(component_of(property, c));
  made.is_independent = property.get<bool>("GetIndependentComponents");
  made.is_linear = property.get<int>("GetInterpolationType") == linear_interpolation;
  made.has_two_variables = property.get<int>("GetTransferFunctionMode") != one_variable;
  const VtkObject contours = property.object("GetIsoSurfaceValues");
  for (int i = 0; i < contours.get<int>("GetNumberOfContours"); ++i) {
    made.isosurfaces.push_back(contours.get<double>("GetValue", i));
  }
  const VtkObject slice = property.object("GetSliceFunction");
  if (slice.is_there() && slice.is_a("vtkPlane")) made.slice = plane_of(slice);
  for (const int label : labels) {
    const VtkObject color = property.object("GetLabelColor", label);
    const VtkObject opacity = property.object("GetLabelScalarOpacity", label);
    const bool has_gradients = property.object("GetLabelGradientOpacity", label).is_there();
    if (!color.is_there() && !opacity.is_there() && !has_gradients) continue;
    LabelSettings& look = made.labels.emplace_back();
    look.label = label;
    if (color.is_there()) look.color = colors_of(color);
    if (opacity.is_there()) look.opacity = opacities_of(opacity);
    look.has_gradient_opacity = has_gradients;
  }
  made.has_phong_highlights = is_since_9_2();
  return made;
}

MapperSettings mapper_of(const VtkObject& mapper) {
  MapperSettings made;
  made.blend = static_cast<Blend>(mapper.get<int>("GetBlendMode"));
  if (const VtkObject planes = mapper.object("GetClippingPlanes"); planes.is_there()) {
    for (const VtkObject& plane : items_of(planes)) made.clipping.push_back(plane_of(plane));
  }
  if (!mapper.has("GetCropping")) return made;  // of unstructured grids
  if (mapper.get<bool>("GetCropping")) {
    made.cropping = CroppingSettings{mapper.get<int>("GetCroppingRegionFlags"),
                                     mapper.get<std::array<double, 6>>("GetCroppingRegionPlanes")};
  }
  made.average_range = mapper.get<std::array<double, 2>>("GetAverageIPScalarRange");
  made.has_normals_of_opacity =
      mapper.has("GetComputeNormalFromOpacity") && mapper.get<bool>("GetComputeNormalFromOpacity");
  made.fills_empty_functions = !mapper.is_a("vtkFixedPointVolumeRayCastMapper") &&
                               !(mapper.is_a("vtkSmartVolumeMapper") &&
                                 mapper.get<int>("GetRequestedRenderMode") == ray_cast);
  return made;
}

ViewSettings view_settings_of(const VtkObject& renderer) {
  ViewSettings made;
  const auto [width, height] = renderer.get<std::array<int, 2>>("GetSize");
  made.width = width;
  made.height = height;
  made.camera = camera_settings_of(renderer.object("GetActiveCamera"),
                                   renderer.get<double>("GetTiledAspectRatio"));
  made.pixel_aspect = renderer.get<std::array<double, 2>>("GetPixelAspect");
  const VtkObject window = renderer.object("GetRenderWindow");
  made.is_stereo = window.is_there() && window.get<bool>("GetStereoRender");
  made.peels_volumes = renderer.get<bool>("GetUseDepthPeeling") &&
                       renderer.get<bool>("GetUseDepthPeelingForVolumes");
  return made;
}

RendererLights lights_of(const VtkObject& renderer) {
  RendererLights made;
  for (const VtkObject& light : items_of(renderer.object("GetLights"))) {
    if (light.get<bool>("GetSwitch")) made.shining.push_back(light_settings_of(light));
  }
  made.are_two_sided = renderer.get<bool>("GetTwoSidedLighting");
  made.are_automatic = renderer.get<bool>("GetAutomaticLightCreation");
  return made;
}

}  // namespace pellucid::python
