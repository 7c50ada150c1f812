// SPDX-License-Identifier: Apache-2.0
#include "grid_layers.h"

#include <vtkColorTransferFunction.h>
#include <vtkContourValues.h>
#include <vtkDataArray.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "cropping.h"
#include "dependent_components.h"
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
        notes_(notes),
        reader_(tolerance, kept.curves, notes) {}

  std::vector<Layer> layers();

 private:
  std::optional<LayerProjection> projection() const;
  double scale();
  RampRange ramp_range(int component);
  LookRecipe recipe_of(int component, const Volume& data, const LookRamps& ramps);
  double longest_ray(const Volume& data) const;
  Layer placed_layer();
  Layer component_layer(int component);
  bool shows_nearest(int component);
  LabelContent nearest_content(const std::shared_ptr<const Volume>& data, const LookRecipe& recipe,
                               int component);
  Layer dependent_layer();
  std::shared_ptr<const LabelMask> label_mask(const LookRecipe& base, int component);
  void add_surfaces(Layer& layer, int component);
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
  FunctionReader reader_;
  vtkDataArray* array_ = nullptr;
  int of_cells_ = 0;
  Affine<double> world_from_data_;
  std::vector<Clip> own_clips_;  ///< around the cells that are no ghosts
  std::size_t layers_ = 1;       ///< how many there will be
};

std::optional<LayerProjection> GridTranslator::projection() const {
  switch (mapper_.GetBlendMode()) {
    case vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND:
      return LayerProjection::maximum;
    case vtkVolumeMapper::MINIMUM_INTENSITY_BLEND:
      return LayerProjection::minimum;
    case vtkVolumeMapper::AVERAGE_INTENSITY_BLEND:
      return LayerProjection::mean;
    default:
      return std::nullopt;
  }
}

/// VTK before 9.2 has normals of the values alone.
template <class Mapper>
void say_normals_of_opacity_are_left_out(Mapper& mapper, vtkVolumeProperty& property,
                                         Notes& notes) {
  if constexpr (requires { mapper.GetComputeNormalFromOpacity(); }) {
    if (mapper.GetComputeNormalFromOpacity() && property.GetShade() != 0) {
      notes.add("light is by the gradient of the values: ComputeNormalFromOpacity is left out");
    }
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
  world_from_data_ = affine_of(*volume_.GetMatrix(), "volume");
  const auto own = clips_at_ghosts(*data_, world_from_data_, kept_.own_cells);
  if (!own) return {};
  own_clips_ = *own;
  const int components = array_->GetNumberOfComponents();
  if (components > VTK_MAX_VRCOMP) {
    throw Error("the array has " + std::to_string(components) +
                " components; VTK shows up to 4, extract some");
  }
  if (property_.GetTransferFunctionMode() == vtkVolumeProperty::TF_2D) {
    throw Error(
        "functions of two variables (SetTransferFunction2D) are not read; take "
        "SetTransferFunctionModeTo1D()");
  }
  say_normals_of_opacity_are_left_out(mapper_, property_, notes_);
  std::vector<int> shown;
  for (int c = 0; c < components; ++c) {
    if (components == 1 || property_.GetComponentWeight(c) > 0) shown.push_back(c);
  }
  const bool is_dependent = components > 1 && property_.GetIndependentComponents() == 0;
  layers_ = is_dependent ? 1 : shown.size();
  if (mapper_.GetCropping() != 0) layers_ *= boxes_of(mapper_.GetCroppingRegionFlags()).size();
  std::vector<Layer> made;
  if (is_dependent) return cropped({dependent_layer()});
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

/// The fixed-point mapper leaves functions without nodes as they are.
RampRange GridTranslator::ramp_range(int component) {
  if (vtkFixedPointVolumeRayCastMapper::SafeDownCast(&mapper_) != nullptr) return std::nullopt;
  std::array<double, 2> range{};
  array_->GetFiniteRange(range.data(), component);
  if (!(range[0] <= range[1])) return std::nullopt;
  return range;
}

LookRecipe GridTranslator::recipe_of(int component, const Volume& data, const LookRamps& ramps) {
  const std::optional<LayerProjection> shown = projection();
  OpacityMeaning meaning = OpacityMeaning::per_unit_distance;
  if (shown) meaning = OpacityMeaning::projected;
  if (shown == LayerProjection::mean) meaning = OpacityMeaning::averaged;
  const bool sums = mapper_.GetBlendMode() == vtkVolumeMapper::ADDITIVE_BLEND;
  if (sums) meaning = OpacityMeaning::summed;
  // The errors of layers' functions add, and double beside other layers.
  const double share = layers_ > 1 ? 0.5 / static_cast<double>(layers_) : 1;
  reader_ = FunctionReader(share * tolerance_, kept_.curves, notes_);
  LookRecipe recipe = look_recipe(property_, component, meaning, share * tolerance_,
                                  data.voxel_size(), ramps, reader_, notes_);
  if (!shown) recipe.unit_distance *= scale();
  if (meaning == OpacityMeaning::averaged) {
    recipe.range = {data.statistics().minimum, data.statistics().maximum};
    const double* const range = mapper_.GetAverageIPScalarRange();
    if (range[0] > recipe.range[0] || range[1] < recipe.range[1]) {
      notes_.add("averages are of all values: AverageIPScalarRange is left out");
    }
  }
  if (sums) {
    recipe.range = {data.statistics().minimum, data.statistics().maximum};
    recipe.length = longest_ray(data);
    recipe.tolerance = sum_tolerance(tolerance_) / static_cast<double>(layers_);
  }
  if (array_->GetNumberOfComponents() > 1) {
    recipe.weight = property_.GetComponentWeight(component);
  }
  return recipe;
}

/// In the scene's world.
double GridTranslator::longest_ray(const Volume& data) const {
  const std::array<Vec3<double>, 8> corners = data.world_corners();
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    longest = std::max(longest, length(world_from_data_.vector(corners[7 - i] - corners[i])));
  }
  return longest;
}

Layer GridTranslator::placed_layer() {
  Layer layer;
  layer.transform = world_from_data_;
  layer.clips = clips_of(mapper_.GetClippingPlanes(), notes_);
  layer.clips.insert(layer.clips.end(), own_clips_.begin(), own_clips_.end());
  return layer;
}

/// The last component has the opacity. The first of two has the color, of four the first three are
/// red, green and blue.
Layer GridTranslator::dependent_layer() {
  refuse_dependent_components(mapper_, *array_, mask_.labels != nullptr);
  Layer layer = placed_layer();
  const int components = array_->GetNumberOfComponents();
  std::vector<std::shared_ptr<const Volume>> data;
  for (int c = 0; c < components; ++c) {
    data.push_back(kept_.volumes.find(*data_, *array_, of_cells_ != 0, c));
  }
  const LookRamps ramps{ramp_range(components - 1), ramp_range(0)};
  DependentRecipe recipe{recipe_of(0, *data.back(), ramps), {}};
  recipe.opacity.weight = 1;
  if (components == 2) {
    recipe.colors.push_back(reader_.colors(property_, 0, ramps.color));
  } else {
    const double one = largest_color_value(*array_);
    for (const Rgb<double>& color : {Rgb<double>{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}) {
      recipe.colors.push_back({Curve{{0, {}}, {one, color}}});
    }
  }
  for (JoinedPoint& point : recipe.opacity.points) point.b = {};
  const auto channels = kept_.channels.find(data, [](const auto& volumes) {
    std::vector<Channel> list;
    for (const auto& volume : volumes) list.push_back({std::to_string(list.size()), "", volume});
    return Channels(std::move(list));
  });
  layer.content = ChannelsContent{channels, kept_.dependent.find(recipe, dependent_function)};
  if (property_.GetInterpolationType() != VTK_LINEAR_INTERPOLATION) {
    notes_.add("dependent components are trilinear (SetInterpolationTypeToLinear())");
  }
  layer.shading = shading_of(property_, 0, notes_);
  if (layer.shading && !has_ambient_light_) layer.shading->ambient = 0;
  if (has_gradient_opacity(property_, 0)) {
    notes_.add("gradient opacities of dependent components are left out");
  }
  return layer;
}

Layer GridTranslator::component_layer(int component) {
  Layer layer = placed_layer();
  layer.projection = projection();
  const auto data = kept_.volumes.find(*data_, *array_, of_cells_ != 0, component);
  const RampRange ramp = ramp_range(component);
  LookRecipe recipe = recipe_of(component, *data, {ramp, ramp});
  const int mode = mapper_.GetBlendMode();
  const bool is_surface =
      mode == vtkVolumeMapper::ISOSURFACE_BLEND || mode == vtkVolumeMapper::SLICE_BLEND;
  if (is_surface) {
    // The medium is clear.
    for (JoinedPoint& point : recipe.points) point.a = 0;
    recipe.opacity_deviation = 0;
  }
  if (shows_nearest(component)) {
    layer.content = nearest_content(data, recipe, component);
    return layer;
  }
  const bool has_gradients = has_gradient_opacity(property_, component) && !is_surface &&
                             mode == vtkVolumeMapper::COMPOSITE_BLEND;
  FittedCurve gradients;
  if (has_gradients) {
    gradients = gradient_curve(property_, component, ramp, reader_);
    // A factor's ratio is one of the extinction.
    recipe.opacity_deviation += gradients.deviation;
  }
  const auto function = kept_.functions.find(recipe, function_of);
  layer.content = VolumeContent{data, function, label_mask(recipe, component)};
  if (layer.projection) {
    if (property_.GetShade(component) != 0) notes_.add("projections have no light");
    return layer;
  }
  if (mode == vtkVolumeMapper::ADDITIVE_BLEND) {
    if (property_.GetShade(component) != 0) notes_.add("sums have no light");
    return layer;
  }
  layer.shading = shading_of(property_, component, notes_);
  if (layer.shading && !has_ambient_light_) layer.shading->ambient = 0;
  if (has_gradients) {
    layer.gradient_opacity = kept_.gradients.find(gradients.points, gradient_opacity_of);
    notes_.add("gradient opacities multiply the extinction here, in VTK the opacity of a sample");
  }
  if (is_surface) {
    if (mode == vtkVolumeMapper::ISOSURFACE_BLEND) {
      add_surfaces(layer, component);
    } else {
      add_slice(layer, reader_.opacities(*property_.GetScalarOpacity(component), 1, ramp).points);
    }
  }
  return layer;
}

/// Returns whether the property asks for it, and nothing else that needs a gradient or one number
/// of a ray.
bool GridTranslator::shows_nearest(int component) {
  if (property_.GetInterpolationType() == VTK_LINEAR_INTERPOLATION) return false;
  if (mapper_.GetBlendMode() == vtkVolumeMapper::COMPOSITE_BLEND && mask_.labels == nullptr &&
      property_.GetShade(component) == 0 && !has_gradient_opacity(property_, component)) {
    return true;
  }
  notes_.add(
      "nearest values are shown without light, gradient opacity and masks, by compositing; here "
      "the data are trilinear (SetInterpolationTypeToLinear())");
  return false;
}

LabelContent GridTranslator::nearest_content(const std::shared_ptr<const Volume>& data,
                                             const LookRecipe& recipe, int component) {
  const auto nearest = kept_.nearest.find(data, [](const auto& of) { return nearest_values(*of); });
  std::vector<ValueLook> looks =
      looks_of(nearest->values, property_, component, ramp_range(component));
  const auto table = kept_.label_tables.find({recipe, std::move(looks)}, [](const auto& made) {
    return label_table(made.first, made.second);
  });
  return {nearest->labels, table};
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
      const RampRange ramp = ramp_range(component);
      const FittedCurve own = reader_.colors(property_, component, ramp);
      const FittedCurve colors =
          color != nullptr ? blended(own, reader_.colors(*color, {}), mask_.blend) : own;
      const FittedCurve opacities =
          opacity != nullptr ? reader_.opacities(*opacity, 1, {})
                             : reader_.opacities(*property_.GetScalarOpacity(component), 1, ramp);
      look.points = joined(opacities.points, colors.points);
      look.opacity_deviation = opacities.deviation;
      look.color_deviation = colors.deviation;
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

void GridTranslator::add_surfaces(Layer& layer, int component) {
  const RampRange ramp = ramp_range(component);
  vtkContourValues* const values = property_.GetIsoSurfaceValues();
  for (int i = 0; i < values->GetNumberOfContours(); ++i) {
    const double value = values->GetValue(i);
    const auto is_there = [&](const Isosurface& other) { return other.value == value; };
    if (!std::isfinite(value)) {
      notes_.add("isosurfaces at values that are no numbers are left out");
      continue;
    }
    if (std::ranges::any_of(layer.isosurfaces, is_there)) continue;
    Isosurface surface;
    surface.value = value;
    surface.opacity = opacity_at(*property_.GetScalarOpacity(component), ramp, value);
    surface.color = color_at(property_, component, ramp, value);
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
  channels.keep_used();
  functions.keep_used();
  dependent.keep_used();
  nearest.keep_used();
  label_tables.keep_used();
  curves.keep_used();
  gradients.keep_used();
  masks.keep_used();
  own_cells.keep_used();
}

std::vector<Layer> layers_of(vtkVolumeMapper& mapper, vtkDataSet* data, vtkVolume& volume,
                             const Mask& mask, double tolerance, bool has_ambient_light,
                             KeptOfGrids& kept, Notes& notes) {
  return GridTranslator(mapper, data, volume, mask, tolerance, has_ambient_light, kept, notes)
      .layers();
}

}  // namespace pellucid::plugin
