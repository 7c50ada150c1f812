// SPDX-License-Identifier: Apache-2.0
#include "grid_layers.h"

#include <vtkColorTransferFunction.h>
#include <vtkContourValues.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "cropping.h"
#include "pellucid/scene/error.h"
#include "view.h"

namespace pellucid::plugin {
namespace {

/// One volume on its way to layers.
class GridTranslator {
 public:
  GridTranslator(vtkVolumeMapper& mapper, vtkDataSet* data, vtkVolume& volume, const Mask& mask,
                 double tolerance, bool has_ambient_light, KeptOfGrids& kept, Notes& notes)
      : mapper_(mapper),
        data_(data),
        volume_(volume),
        property_(*volume.GetProperty()),
        mask_(mask),
        tolerance_(tolerance),
        has_ambient_light_(has_ambient_light),
        kept_(kept),
        notes_(notes) {}

  std::vector<Layer> layers();

 private:
  std::optional<LayerProjection> projection() const;
  double scale();
  LookRecipe recipe_of(int component, const Volume& data);
  Layer component_layer(int component);
  std::shared_ptr<const LabelMask> label_mask(const LookRecipe& base, int component);
  void add_surfaces(Layer& layer, const Curve& opacities, const Curve& colors);
  void add_slice(Layer& layer, const Curve& opacities);
  std::vector<Layer> cropped(const std::vector<Layer>& layers);

  vtkVolumeMapper& mapper_;
  vtkDataSet* const data_;
  vtkVolume& volume_;
  vtkVolumeProperty& property_;
  const Mask& mask_;
  const double tolerance_;
  const bool has_ambient_light_;
  KeptOfGrids& kept_;
  Notes& notes_;
  vtkDataArray* array_ = nullptr;
  int of_cells_ = 0;
  Affine<double> world_from_data_;
  std::size_t layers_ = 1;  ///< how many there will be
};

std::optional<LayerProjection> GridTranslator::projection() const {
  switch (mapper_.GetBlendMode()) {
    case vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND:
      return LayerProjection::maximum;
    case vtkVolumeMapper::MINIMUM_INTENSITY_BLEND:
      return LayerProjection::minimum;
    case vtkVolumeMapper::AVERAGE_INTENSITY_BLEND:
      return LayerProjection::mean;
    case vtkVolumeMapper::ADDITIVE_BLEND:
      throw Error(
          "additive blending: VTK's sum depends on the length of its steps; take average "
          "(SetBlendModeToAverageIntensity())");
    default:
      return std::nullopt;
  }
}

std::vector<Layer> GridTranslator::layers() {
  if (data_ == nullptr) return {};
  array_ =
      vtkAbstractMapper::GetScalars(data_, mapper_.GetScalarMode(), mapper_.GetArrayAccessMode(),
                                    mapper_.GetArrayId(), mapper_.GetArrayName(), of_cells_);
  if (array_ == nullptr) {
    throw Error(std::string(data_->GetClassName()) +
                ": has no values to show; give it scalars, or select one of its arrays");
  }
  if (property_.GetInterpolationType() != VTK_LINEAR_INTERPOLATION) {
    throw Error("the property shows the nearest value; call SetInterpolationTypeToLinear()");
  }
  world_from_data_ = affine_of(*volume_.GetMatrix(), "volume");
  const int components = array_->GetNumberOfComponents();
  if (components > VTK_MAX_VRCOMP) {
    throw Error("the array has " + std::to_string(components) +
                " components; VTK shows up to 4, extract some");
  }
  if (components > 1 && property_.GetIndependentComponents() == 0) {
    throw Error(
        "dependent components: colors of one component and opacities of another are no "
        "function of one value; extract one (vtkImageExtractComponents)");
  }
  if (property_.GetTransferFunctionMode() == vtkVolumeProperty::TF_2D) {
    throw Error(
        "functions of two variables (SetTransferFunction2D) are not read; take "
        "SetTransferFunctionModeTo1D()");
  }
  std::vector<int> shown;
  for (int c = 0; c < components; ++c) {
    if (components == 1 || property_.GetComponentWeight(c) > 0) shown.push_back(c);
  }
  layers_ = shown.size();
  if (mapper_.GetCropping() != 0) layers_ *= boxes_of(mapper_.GetCroppingRegionFlags()).size();
  std::vector<Layer> made;
  for (const int component : shown) made.push_back(component_layer(component));
  if (made.size() > 1) notes_.add("components mix as particles do; VTK adds their colors");
  return cropped(made);
}

/// VTK's mappers measure the unit distance in the volume's own world, before its matrix.
double GridTranslator::scale() {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (const Vec3<double>& column : world_from_data_.matrix.column) {
    const double length = std::sqrt(dot(column, column));
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  if (longest > 1.000001 * shortest) {
    notes_.add("a volume that is scaled unevenly has opacities by the mean of its scales");
  }
  return std::cbrt(std::abs(determinant(world_from_data_.matrix)));
}

LookRecipe GridTranslator::recipe_of(int component, const Volume& data) {
  const std::optional<LayerProjection> shown = projection();
  OpacityMeaning meaning = OpacityMeaning::per_unit_distance;
  if (shown) meaning = OpacityMeaning::projected;
  if (shown == LayerProjection::mean) meaning = OpacityMeaning::averaged;
  // The errors of layers' functions add, and double beside other layers.
  const double share = layers_ > 1 ? 0.5 / static_cast<double>(layers_) : 1;
  LookRecipe recipe = look_recipe(property_, component, meaning, share * tolerance_);
  if (!shown) recipe.unit_distance *= scale();
  if (meaning == OpacityMeaning::averaged) {
    recipe.range = {data.statistics().minimum, data.statistics().maximum};
    const double* const range = mapper_.GetAverageIPScalarRange();
    if (range[0] > recipe.range[0] || range[1] < recipe.range[1]) {
      notes_.add("averages are of all values: AverageIPScalarRange is left out");
    }
  }
  if (array_->GetNumberOfComponents() > 1) {
    recipe.weight = property_.GetComponentWeight(component);
  }
  return recipe;
}

Layer GridTranslator::component_layer(int component) {
  Layer layer;
  layer.transform = world_from_data_;
  layer.clips = clips_of(mapper_.GetClippingPlanes());
  layer.projection = projection();
  const auto data = kept_.volumes.find(*data_, *array_, of_cells_ != 0, component);
  LookRecipe recipe = recipe_of(component, *data);
  const int mode = mapper_.GetBlendMode();
  const bool is_surface =
      mode == vtkVolumeMapper::ISOSURFACE_BLEND || mode == vtkVolumeMapper::SLICE_BLEND;
  if (is_surface) {
    // The medium is clear.
    for (JoinedPoint& point : recipe.points) point.a = 0;
  }
  const auto function = kept_.functions.find(recipe, function_of);
  layer.content = VolumeContent{data, function, label_mask(recipe, component)};
  if (layer.projection) {
    if (property_.GetShade(component) != 0) notes_.add("projections have no light");
    return layer;
  }
  layer.shading = shading_of(property_, component);
  if (layer.shading && !has_ambient_light_) layer.shading->ambient = 0;
  if (const Curve curve = gradient_curve(property_, component); !curve.empty() && !is_surface) {
    layer.gradient_opacity = kept_.gradients.find(curve, gradient_opacity_of);
    notes_.add("gradient opacities multiply the extinction here, in VTK the opacity of a sample");
  }
  if (is_surface) {
    const Curve opacities = curve_of(*property_.GetScalarOpacity(component));
    if (mode == vtkVolumeMapper::ISOSURFACE_BLEND) {
      add_surfaces(layer, opacities, color_curve(property_, component));
    } else {
      add_slice(layer, opacities);
    }
  }
  return layer;
}

std::shared_ptr<const LabelMask> GridTranslator::label_mask(const LookRecipe& base, int component) {
  if (mask_.labels == nullptr) return nullptr;
  vtkDataArray* const labels = mask_.labels->GetPointData()->GetScalars();
  if (labels == nullptr) throw Error("mask: has no labels");
  KeptOfGrids::MaskRecipe recipe{kept_.labels.find(*mask_.labels, *labels, of_cells_ != 0, 0), {}};
  LookRecipe look = base;
  if (mask_.is_binary) {
    for (JoinedPoint& point : look.points) point.a = 0;
    recipe.second.emplace_back(0, kept_.functions.find(look, function_of));
  } else {
    for (const int label : property_.GetLabelMapLabels()) {
      vtkColorTransferFunction* const color = property_.GetLabelColor(label);
      vtkPiecewiseFunction* const opacity = property_.GetLabelScalarOpacity(label);
      if (property_.GetLabelGradientOpacity(label) != nullptr) {
        notes_.add("gradient opacities of labels are left out");
      }
      const Curve own = color_curve(property_, component);
      look.points = joined(opacity != nullptr ? curve_of(*opacity)
                                              : curve_of(*property_.GetScalarOpacity(component)),
                           color != nullptr ? blended(own, curve_of(*color), mask_.blend) : own);
      if (look.meaning == OpacityMeaning::per_unit_distance &&
          mapper_.GetBlendMode() != vtkVolumeMapper::COMPOSITE_BLEND) {
        continue;  // surfaces
      }
      recipe.second.emplace_back(label, kept_.functions.find(look, function_of));
    }
  }
  return kept_.masks.find(recipe, [](const KeptOfGrids::MaskRecipe& made) {
    std::vector<LabelMask::Choice> choices;
    for (const auto& [label, function] : made.second) choices.push_back({label, function});
    return LabelMask(std::make_shared<const LabelVolume>(made.first), std::move(choices));
  });
}

void GridTranslator::add_surfaces(Layer& layer, const Curve& opacities, const Curve& colors) {
  vtkContourValues* const values = property_.GetIsoSurfaceValues();
  for (int i = 0; i < values->GetNumberOfContours(); ++i) {
    const double value = values->GetValue(i);
    Isosurface surface;
    surface.value = value;
    surface.opacity = std::clamp(value_at(opacities, value).r, 0.0, 1.0);
    surface.color = value_at(colors, value);
    layer.isosurfaces.push_back(surface);
  }
}

void GridTranslator::add_slice(Layer& layer, const Curve& opacities) {
  auto* const plane = vtkPlane::SafeDownCast(property_.GetSliceFunction());
  if (plane == nullptr) throw Error("slice: the property has no vtkPlane; call SetSliceFunction()");
  double origin[3], normal[3];
  plane->GetOrigin(origin);
  plane->GetNormal(normal);
  const ClipPlane placed = placed_plane({origin[0], origin[1], origin[2]},
                                        {normal[0], normal[1], normal[2]}, world_from_data_);
  Slice slice;
  slice.point = placed.point;
  slice.normal = placed.normal;
  slice.opacity = 0;
  for (const CurvePoint& point : opacities) slice.opacity = std::max(slice.opacity, point.y.r);
  slice.opacity = std::clamp(slice.opacity, 0.0, 1.0);
  if (std::ranges::any_of(opacities, [&](const CurvePoint& p) { return p.y.r < slice.opacity; })) {
    notes_.add("a slice has one opacity, the largest of its function");
  }
  layer.slices.push_back(slice);
}

std::vector<Layer> GridTranslator::cropped(const std::vector<Layer>& layers) {
  if (mapper_.GetCropping() == 0) return layers;
  const std::vector<CroppedBox> boxes = boxes_of(mapper_.GetCroppingRegionFlags());
  double planes[6];
  mapper_.GetCroppingRegionPlanes(planes);
  std::vector<Layer> made;
  for (const Layer& layer : layers) {
    if (layer.projection && boxes.size() > 1) {
      throw Error(
          "cropping: a projection of several boxes is not one number per ray; take "
          "SetCroppingRegionFlagsToSubVolume()");
    }
    for (const CroppedBox& box : boxes) {
      made.push_back(layer);
      for (const Clip& clip : clips_of(box, planes, world_from_data_)) {
        made.back().clips.push_back(clip);
      }
    }
  }
  return made;
}

}  // namespace

void KeptOfGrids::keep_used() {
  volumes.keep_used();
  labels.keep_used();
  functions.keep_used();
  gradients.keep_used();
  masks.keep_used();
}

std::vector<Layer> layers_of(vtkVolumeMapper& mapper, vtkDataSet* data, vtkVolume& volume,
                             const Mask& mask, double tolerance, bool has_ambient_light,
                             KeptOfGrids& kept, Notes& notes) {
  return GridTranslator(mapper, data, volume, mask, tolerance, has_ambient_light, kept, notes)
      .layers();
}

}  // namespace pellucid::plugin
