// SPDX-License-Identifier: Apache-2.0
#include "settings.h"

#include <vtkColorTransferFunction.h>
#include <vtkContourValues.h>
#include <vtkDiscretizableColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkUnstructuredGridVolumeMapper.h>
#include <vtkVersionMacros.h>
#include <vtkVolumeMapper.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cstddef>

namespace pellucid::plugin {
namespace {

static_assert(static_cast<int>(Blend::slice) == vtkVolumeMapper::SLICE_BLEND &&
              static_cast<int>(Blend::additive) == vtkVolumeMapper::ADDITIVE_BLEND &&
              static_cast<int>(Blend::maximum) ==
                  vtkUnstructuredGridVolumeMapper::MAXIMUM_INTENSITY_BLEND);

/// Returns whether this VTK's opacities jump where the sharpness is above 0.99.
bool opacities_jump() {
  static const bool jump = [] {
    vtkNew<vtkPiecewiseFunction> sharp;
    sharp->AddPoint(0, 0, 0.5, 1);
    sharp->AddPoint(1, 1, 0.5, 1);
    return sharp->GetValue(0.25) == 0;
  }();
  return jump;
}

/// Returns VTK's colors from one place to another, as its mappers take them: GetColor() of a
/// discretized function, as ParaView's are, has steps.
std::vector<Rgb<double>> colors_between(vtkColorTransferFunction& function, double first,
                                        double last, int count) {
  std::vector<double> numbers(3 * static_cast<std::size_t>(count));
  function.GetTable(first, last, count, numbers.data());
  std::vector<Rgb<double>> colors;
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    colors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  }
  return colors;
}

std::vector<Rgb<double>> way_of_vtk(const Rgb<double>& from, const Rgb<double>& to, int count) {
  vtkNew<vtkColorTransferFunction> way;
  way->SetColorSpaceToLabCIEDE2000();
  way->AddRGBPoint(0, from.r, from.g, from.b);
  way->AddRGBPoint(1, to.r, to.g, to.b);
  return colors_between(*way, 0, 1, count);
}

Rgb<double> rgb_of(const double c[3]) {
  return {c[0], c[1], c[2]};
}

Plane plane_of(vtkPlane& plane) {
  const double *const origin = plane.GetOrigin(), *const normal = plane.GetNormal();
  return {{origin[0], origin[1], origin[2]}, {normal[0], normal[1], normal[2]}};
}

std::vector<Plane> planes_of(vtkPlaneCollection* collection) {
  std::vector<Plane> planes;
  for (int i = 0; collection != nullptr && i < collection->GetNumberOfItems(); ++i) {
    planes.push_back(plane_of(*collection->GetItem(i)));
  }
  return planes;
}

ComponentSettings component_of(vtkVolumeProperty& property, int c) {
  ComponentSettings made;
  made.opacity = settings_of(*property.GetScalarOpacity(c));
  made.is_grey = property.GetColorChannels(c) == 1;
  made.color = made.is_grey ? settings_of(*property.GetGrayTransferFunction(c))
                            : settings_of(*property.GetRGBTransferFunction(c));
  if (property.GetDisableGradientOpacity(c) == 0 && property.HasGradientOpacity(c)) {
    made.gradient_opacity = settings_of(*property.GetGradientOpacity(c));
  }
  made.unit_distance = property.GetScalarOpacityUnitDistance(c);
  made.weight = property.GetComponentWeight(c);
  if (property.GetShade(c) != 0) {
    made.reflection = {property.GetAmbient(c), property.GetDiffuse(c), property.GetSpecular(c),
                       property.GetSpecularPower(c)};
  }
  return made;
}

}  // namespace

FunctionSettings settings_of(vtkPiecewiseFunction& function) {
  FunctionSettings made;
  for (int i = 0; i < function.GetSize(); ++i) {
    double n[4];
    if (function.GetNodeValue(i, n) < 0) continue;
    made.shape.nodes.push_back({n[0], {n[1], n[1], n[1]}, n[2], n[3]});
  }
  made.shape.is_logarithmic = function.GetUseLogScale();
  made.shape.jumps = opacities_jump();
  made.shape.is_clamped = function.GetClamping() != 0;
  made.own = [&function](double first, double, int) -> std::vector<Rgb<double>> {
    const double value = function.GetValue(first);
    return {{value, value, value}};
  };
  return made;
}

FunctionSettings settings_of(vtkColorTransferFunction& function) {
  FunctionSettings made;
  made.shape.is_color = true;
  for (int i = 0; i < function.GetSize(); ++i) {
    double n[6];
    if (function.GetNodeValue(i, n) < 0) continue;
    made.shape.nodes.push_back({n[0], {n[1], n[2], n[3]}, n[4], n[5]});
  }
  made.shape.space = function.GetColorSpace();
  made.shape.wraps_hue = function.GetHSVWrap() != 0;
  made.shape.is_logarithmic = function.GetScale() == VTK_CTF_LOG10;
  made.shape.is_clamped = function.GetClamping() != 0;
  if (function.GetUseBelowRangeColor() != 0) {
    made.shape.below = rgb_of(function.GetBelowRangeColor());
  }
  if (function.GetUseAboveRangeColor() != 0) {
    made.shape.above = rgb_of(function.GetAboveRangeColor());
  }
  made.own = [&function](double first, double last, int count) {
    return colors_between(function, first, last, count);
  };
  made.way = way_of_vtk;
  made.is_indexed = function.GetIndexedLookup() != 0;
  auto* const steps = vtkDiscretizableColorTransferFunction::SafeDownCast(&function);
  if (steps != nullptr && steps->GetDiscretize() != 0) made.steps = steps->GetNumberOfValues();
  return made;
}

PropertySettings settings_of(vtkVolumeProperty& property, int components) {
  PropertySettings made;
  for (int c = 0; c < std::min(components, VTK_MAX_VRCOMP); ++c) {
    made.components.push_back(component_of(property, c));
  }
  made.is_independent = property.GetIndependentComponents() != 0;
  made.is_linear = property.GetInterpolationType() == VTK_LINEAR_INTERPOLATION;
  made.has_two_variables = property.GetTransferFunctionMode() == vtkVolumeProperty::TF_2D;
  vtkContourValues* const contours = property.GetIsoSurfaceValues();
  for (int i = 0; i < contours->GetNumberOfContours(); ++i) {
    made.isosurfaces.push_back(contours->GetValue(i));
  }
  if (auto* const plane = vtkPlane::SafeDownCast(property.GetSliceFunction())) {
    made.slice = plane_of(*plane);
  }
  for (const int label : property.GetLabelMapLabels()) {
    LabelSettings& look = made.labels.emplace_back();
    look.label = label;
    if (auto* const color = property.GetLabelColor(label)) look.color = settings_of(*color);
    if (auto* const opacity = property.GetLabelScalarOpacity(label)) {
      look.opacity = settings_of(*opacity);
    }
    look.has_gradient_opacity = property.GetLabelGradientOpacity(label) != nullptr;
  }
  made.has_phong_highlights = VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0);
  return made;
}

/// Returns whether normals are those of opacities; VTK before 9.2 has none.
template <class Mapper>
bool has_normals_of_opacity(Mapper& mapper) {
  if constexpr (requires { mapper.GetComputeNormalFromOpacity(); }) {
    return mapper.GetComputeNormalFromOpacity();
  } else {
    return false;
  }
}

MapperSettings settings_of(vtkVolumeMapper& mapper) {
  MapperSettings made;
  made.blend = static_cast<Blend>(mapper.GetBlendMode());
  made.clipping = planes_of(mapper.GetClippingPlanes());
  if (mapper.GetCropping() != 0) {
    made.cropping.emplace();
    made.cropping->flags = mapper.GetCroppingRegionFlags();
    mapper.GetCroppingRegionPlanes(made.cropping->planes.data());
  }
  std::copy_n(mapper.GetAverageIPScalarRange(), 2, made.average_range.begin());
  made.has_normals_of_opacity = has_normals_of_opacity(mapper);
  made.fills_empty_functions = vtkFixedPointVolumeRayCastMapper::SafeDownCast(&mapper) == nullptr;
  return made;
}

MapperSettings settings_of(vtkUnstructuredGridVolumeMapper& mapper) {
  MapperSettings made;
  made.blend = static_cast<Blend>(mapper.GetBlendMode());
  made.clipping = planes_of(mapper.GetClippingPlanes());
  return made;
}

Matrix elements_of(vtkMatrix4x4& matrix) {
  Matrix elements;
  std::copy_n(matrix.GetData(), 16, elements.begin());
  return elements;
}

}  // namespace pellucid::plugin
