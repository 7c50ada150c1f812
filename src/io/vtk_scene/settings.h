// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/geometry/vec3.h"
#include "transfer_functions/import_shaped.h"

/// VTK's scenes by their numbers, without VTK. The plug-ins read the numbers off VTK's objects in
/// C++, the Python package off those of Python; all that is made of them is made here.
namespace pellucid::vtk_scene {

/// The elements of a vtkMatrix4x4, row by row.
using Matrix = std::array<double, 16>;

/// A vtkPlane.
struct Plane {
  Vec3<double> origin{}, normal{0, 0, 1};
};

/// A vtkPiecewiseFunction or a vtkColorTransferFunction.
struct FunctionSettings {
  imported::ShapedFunction shape{};  ///< with all of its nodes, as they are
  imported::SampleFunction own{};    ///< VTK's own values: opacities three times, or colors
  imported::SampleWay way{};         ///< VTK's ways of CIEDE2000; colors alone have them
  bool is_indexed = false;           ///< colors alone are
  std::int64_t steps = 0;            ///< number of different colors; 0: they have no steps
};

/// Reflection of light by a component.
struct ReflectionSettings {
  double ambient = 0.1, diffuse = 0.7, specular = 0.2, power = 10;
};

/// The part of a vtkVolumeProperty that is about one component.
struct ComponentSettings {
  FunctionSettings opacity;
  bool is_grey = false;
  FunctionSettings color;                              ///< opacities where it is grey
  std::optional<FunctionSettings> gradient_opacity{};  ///< none: it is disabled, or not there
  double unit_distance = 1, weight = 1;
  std::optional<ReflectionSettings> reflection{};  ///< none: not shaded
};

/// The look of a label of a mask.
struct LabelSettings {
  int label = 0;
  std::optional<FunctionSettings> color{}, opacity{};
  bool has_gradient_opacity = false;
};

/// A vtkVolumeProperty.
struct PropertySettings {
  std::vector<ComponentSettings> components;  ///< as many as the array that is shown has
  bool is_independent = true, is_linear = true;
  bool has_two_variables = false;  ///< functions of value and gradient
  std::vector<double> isosurfaces{};
  std::optional<Plane> slice{};
  std::vector<LabelSettings> labels{};
  /// True since VTK 9.2, whose highlights are (r·v)^power.
  bool has_phong_highlights = false;
};

/// Blend modes of vtkVolumeMapper, by its numbers. Of vtkUnstructuredGridVolumeMapper the first two
/// are the same.
enum class Blend { composite, maximum, minimum, average, additive, isosurface, slice };

/// Cropping of a vtkVolumeMapper.
struct CroppingSettings {
  int flags = 0;                   ///< regions that are shown, of 27: bit x + 3 y + 9 z
  std::array<double, 6> planes{};  ///< xmin, xmax, ymin, ... in the world of the data
};

/// A vtkVolumeMapper, or a vtkUnstructuredGridVolumeMapper.
struct MapperSettings {
  Blend blend = Blend::composite;
  std::vector<Plane> clipping{};  ///< normals point to the kept side
  std::optional<CroppingSettings> cropping{};
  std::array<double, 2> average_range{};  ///< AverageIPScalarRange
  bool has_normals_of_opacity = false;    ///< ComputeNormalFromOpacity, since VTK 9.2
  /// True: puts a ramp over the range of the data into functions without nodes. The fixed-point
  /// mapper leaves them as they are.
  bool fills_empty_functions = true;
};

}  // namespace pellucid::vtk_scene
