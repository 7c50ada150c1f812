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
#include <array>
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
  double longest_ray(const Volume& data) const;
  Layer placed_layer();
  Layer component_layer(int component);
  void refuse_dependent_components() const;
  double color_scale() const;
  bool shows_nearest(int component);
  LabelContent nearest_content(const std::shared_ptr<const Volume>& data, const LookRecipe& recipe);
  Layer dependent_layer();
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

LookRecipe GridTranslator::recipe_of(int component, const Volume& data) {
  const std::optional<LayerProjection> shown = projection();
  OpacityMeaning meaning = OpacityMeaning::per_unit_distance;
  if (shown) meaning = OpacityMeaning::projected;
  if (shown == LayerProjection::mean) meaning = OpacityMeaning::averaged;
  const bool sums = mapper_.GetBlendMode() == vtkVolumeMapper::ADDITIVE_BLEND;
  if (sums) meaning = OpacityMeaning::summed;
  // The errors of layers' functions add, and double beside other layers.
  const double share = layers_ > 1 ? 0.5 / static_cast<double>(layers_) : 1;
  LookRecipe recipe =
      look_recipe(property_, component, meaning, share * tolerance_, data.voxel_size(), notes_);
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

void GridTranslator::refuse_dependent_components() const {
  const int components = array_->GetNumberOfComponents();
  if (components == 3) {
    throw Error("dependent components: the array has 3, but VTK shows 2 or 4; add opacities");
  }
  if (mapper_.GetBlendMode() != vtkVolumeMapper::COMPOSITE_BLEND) {
    throw Error(
        "dependent components: only SetBlendModeToComposite() shows the colors of some and the "
        "opacities of another");
  }
  if (mask_.labels != nullptr) {
    throw Error("dependent components: have no masks; make opacities 0 in place of one");
  }
}

/// Of the values of components that are colors: what becomes 1.
double GridTranslator::color_scale() const {
  switch (array_->GetDataType()) {
    case VTK_UNSIGNED_CHAR:
      return std::numeric_limits<unsigned char>::max();
    case VTK_UNSIGNED_SHORT:
      return std::numeric_limits<unsigned short>::max();
    case VTK_FLOAT:
    case VTK_DOUBLE:
      return 1;
    default:
      throw Error(std::string("dependent components: colors are ") + array_->GetDataTypeAsString() +
                  "; give unsigned char, from 0 to 255");
  }
}

/// The last component has the opacity. The first of two has the color, of four the first three are
/// red, green and blue.
Layer GridTranslator::dependent_layer() {
  refuse_dependent_components();
  Layer layer = placed_layer();
  const int components = array_->GetNumberOfComponents();
  std::vector<std::shared_ptr<const Volume>> data;
  for (int c = 0; c < components; ++c) {
    data.push_back(kept_.volumes.find(*data_, *array_, of_cells_ != 0, c));
  }
  DependentRecipe recipe{recipe_of(0, *data.back()), {}};
  recipe.opacity.weight = 1;
  if (components == 2) {
    recipe.colors.push_back(color_curve(property_, 0, notes_));
  } else {
    const double one = color_scale();
    for (const Rgb<double>& color : {Rgb<double>{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}) {
      recipe.colors.push_back(Curve{{0, {}}, {one, color}});
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
  if (!gradient_curve(property_, 0, notes_).empty()) {
    notes_.add("gradient opacities of dependent components are left out");
  }
  return layer;
}

Layer GridTranslator::component_layer(int component) {
  Layer layer = placed_layer();
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
  if (shows_nearest(component)) {
    layer.content = nearest_content(data, recipe);
    return layer;
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
  if (const Curve curve = gradient_curve(property_, component, notes_);
      !curve.empty() && !is_surface) {
    layer.gradient_opacity = kept_.gradients.find(curve, gradient_opacity_of);
    notes_.add("gradient opacities multiply the extinction here, in VTK the opacity of a sample");
  }
  if (is_surface) {
    const Curve opacities = curve_of(*property_.GetScalarOpacity(component), notes_);
    if (mode == vtkVolumeMapper::ISOSURFACE_BLEND) {
      add_surfaces(layer, opacities, color_curve(property_, component, notes_));
    } else {
      add_slice(layer, opacities);
    }
  }
  return layer;
}

/// Whether the property asks for it, and nothing else that needs a gradient or one number of a ray.
bool GridTranslator::shows_nearest(int component) {
  if (property_.GetInterpolationType() == VTK_LINEAR_INTERPOLATION) return false;
  if (mapper_.GetBlendMode() == vtkVolumeMapper::COMPOSITE_BLEND && mask_.labels == nullptr &&
      property_.GetShade(component) == 0 && gradient_curve(property_, component, notes_).empty()) {
    return true;
  }
  notes_.add(
      "nearest values are shown without light, gradient opacity and masks, by compositing; here "
      "the data are trilinear (SetInterpolationTypeToLinear())");
  return false;
}

LabelContent GridTranslator::nearest_content(const std::shared_ptr<const Volume>& data,
                                             const LookRecipe& recipe) {
  const auto nearest = kept_.nearest.find(data, [](const auto& of) { return nearest_values(*of); });
  const auto table = kept_.label_tables.find({recipe, nearest}, [](const auto& made) {
    return label_table(made.first, made.second->values);
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
      const Curve own = color_curve(property_, component, notes_);
      look.points = joined(
          curve_of(opacity != nullptr ? *opacity : *property_.GetScalarOpacity(component), notes_),
          color != nullptr ? blended(own, curve_of(*color, notes_), mask_.blend) : own);
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
    const auto is_there = [&](const Isosurface& other) { return other.value == value; };
    if (!std::isfinite(value)) {
      notes_.add("isosurfaces at values that are no numbers are left out");
      continue;
    }
    if (std::ranges::any_of(layer.isosurfaces, is_there)) continue;
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

NearestValues nearest_values(const Volume& volume) {
  constexpr std::size_t most = std::size_t{1} << 24;
  std::vector<double> values, all;
  std::visit([&](const auto& data) { all.assign(data.begin(), data.end()); }, volume.data());
  values = all;
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() > most) {
    throw Error("nearest values: there are " + std::to_string(values.size()) +
                " different ones; call SetInterpolationTypeToLinear()");
  }
  DataArray<float> labels(all.size());
  std::size_t i = 0;
  for (float& label : labels.writable()) {
    const double value = all[i++];
    label = std::isnan(value)
                ? std::numeric_limits<float>::quiet_NaN()
                : static_cast<float>(std::ranges::lower_bound(values, value) - values.begin());
  }
  return {std::make_shared<const LabelVolume>(
              std::make_shared<const Volume>(volume.description(), std::move(labels))),
          std::move(values)};
}

void KeptOfGrids::keep_used() {
  volumes.keep_used();
  labels.keep_used();
  channels.keep_used();
  functions.keep_used();
  dependent.keep_used();
  nearest.keep_used();
  label_tables.keep_used();
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
