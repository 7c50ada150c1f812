// SPDX-License-Identifier: Apache-2.0
#include "grid_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "cropping.h"
#include "dependent_components.h"
#include "pellucid/scene/error.h"
#include "placement.h"

namespace pellucid::vtk_scene {
namespace {

/// Largest number of components that VTK shows.
constexpr int max_components = 4;

/// One volume on its way to layers.
class GridTranslator {
 public:
  GridTranslator(const GridVolume& volume, double tolerance, bool has_ambient_light,
                 KeptLooks& kept, Notes& notes)
      : volume_(volume),
        data_(volume.data),
        mapper_(volume.mapper),
        property_(volume.property),
        tolerance_(tolerance),
        has_ambient_light_(has_ambient_light),
        kept_(kept),
        notes_(notes),
        reader_(tolerance, kept.curves, notes) {}

  std::vector<TableLayer> layers();

 private:
  const ComponentSettings& look_of(int component) const {
    return property_.components.at(static_cast<std::size_t>(component));
  }
  std::optional<LayerProjection> projection() const;
  double scale();
  RampRange ramp_range(int component);
  LookRecipe recipe_of(int component, const Volume& data, const LookRamps& ramps);
  double longest_ray(const Volume& data) const;
  Layer placed_layer();
  TableLayer component_layer(int component);
  bool shows_nearest(int component);
  LabelContent nearest_content(const std::shared_ptr<const Volume>& data, const LookRecipe& recipe,
                               int component);
  Layer dependent_layer();
  std::shared_ptr<const LabelMask> label_mask(const LookRecipe& base, int component);
  void add_surfaces(Layer& layer, int component);
  void add_slice(Layer& layer, const Curve& opacities);
  std::vector<TableLayer> cropped(const std::vector<TableLayer>& layers);

  const GridVolume& volume_;
  const GridData& data_;
  const MapperSettings& mapper_;
  const PropertySettings& property_;
  const double tolerance_;
  const bool has_ambient_light_;
  KeptLooks& kept_;
  Notes& notes_;
  FunctionReader reader_;
  Affine<double> world_from_data_;
  std::vector<Clip> own_clips_;  ///< around the cells that are no ghosts
  std::size_t layers_ = 1;       ///< number of those that there will be
};

std::optional<LayerProjection> GridTranslator::projection() const {
  switch (mapper_.blend) {
    case Blend::maximum:
      return LayerProjection::maximum;
    case Blend::minimum:
      return LayerProjection::minimum;
    case Blend::average:
      return LayerProjection::mean;
    default:
      return std::nullopt;
  }
}

std::vector<TableLayer> GridTranslator::layers() {
  const int components = data_.components;
  if (components < 1) {
    throw Error(data_.class_name +
                ": has no values to show; give it scalars, or select one of its arrays");
  }
  world_from_data_ = affine_of(volume_.matrix, "volume");
  if (data_.ghosts) {
    const auto own = clips_at_ghosts(*data_.ghosts, world_from_data_, data_.class_name);
    if (!own) return {};
    own_clips_ = *own;
  }
  if (components > max_components) {
    throw Error("the array has " + std::to_string(components) +
                " components; VTK shows up to 4, extract some");
  }
  if (property_.has_two_variables) {
    throw Error(
        "functions of two variables (SetTransferFunction2D) are not read; take "
        "SetTransferFunctionModeTo1D()");
  }
  if (mapper_.has_normals_of_opacity && look_of(0).reflection) {
    notes_.add("light is by the gradient of the values: ComputeNormalFromOpacity is left out");
  }
  std::vector<int> shown;
  for (int c = 0; c < components; ++c) {
    if (components == 1 || look_of(c).weight > 0) shown.push_back(c);
  }
  const bool is_dependent = components > 1 && !property_.is_independent;
  layers_ = is_dependent ? 1 : shown.size();
  if (mapper_.cropping) layers_ *= boxes_of(mapper_.cropping->flags).size();
  if (is_dependent) return cropped({{dependent_layer()}});
  std::vector<TableLayer> made;
  made.reserve(shown.size());
  for (const int component : shown) made.push_back(component_layer(component));
  if (made.size() > 1) notes_.add("components mix as particles do; VTK adds their colors");
  return cropped(made);
}

/// Returns the length of the volume's own unit in the world: VTK's mappers measure the unit
/// distance before the volume's matrix.
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

RampRange GridTranslator::ramp_range(int component) {
  if (!mapper_.fills_empty_functions) return std::nullopt;
  const std::array<double, 2> range = data_.ranges.at(static_cast<std::size_t>(component));
  if (!(range[0] <= range[1])) return std::nullopt;
  return range;
}

LookRecipe GridTranslator::recipe_of(int component, const Volume& data, const LookRamps& ramps) {
  const std::optional<LayerProjection> shown = projection();
  OpacityMeaning meaning = OpacityMeaning::per_unit_distance;
  if (shown) meaning = OpacityMeaning::projected;
  if (shown == LayerProjection::mean) meaning = OpacityMeaning::averaged;
  const bool sums = mapper_.blend == Blend::additive;
  if (sums) meaning = OpacityMeaning::summed;
  const double share = function_share(layers_);
  reader_ = FunctionReader(share * tolerance_, kept_.curves, notes_);
  LookRecipe recipe = look_recipe(look_of(component), meaning, share * tolerance_,
                                  data.voxel_size(), ramps, reader_, notes_);
  if (!shown) recipe.unit_distance *= scale();
  if (meaning == OpacityMeaning::averaged) {
    recipe.range = {data.statistics().minimum, data.statistics().maximum};
    const std::array<double, 2>& range = mapper_.average_range;
    if (range[0] > recipe.range[0] || range[1] < recipe.range[1]) {
      notes_.add("averages are of all values: AverageIPScalarRange is left out");
    }
  }
  if (sums) {
    recipe.range = {data.statistics().minimum, data.statistics().maximum};
    recipe.length = longest_ray(data);
    recipe.tolerance = sum_tolerance(tolerance_) / static_cast<double>(layers_);
  }
  if (data_.components > 1) recipe.weight = look_of(component).weight;
  return recipe;
}

/// Returns the length of the longest ray, in the scene's world.
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
  layer.clips = clips_of(mapper_.clipping, notes_);
  layer.clips.insert(layer.clips.end(), own_clips_.begin(), own_clips_.end());
  return layer;
}

/// Returns the layer: the last component has the opacity, the first of two the color; the first
/// three of four are red, green and blue.
Layer GridTranslator::dependent_layer() {
  refuse_dependent_components(volume_);
  Layer layer = placed_layer();
  const int components = data_.components;
  std::vector<std::shared_ptr<const Volume>> data;
  data.reserve(static_cast<std::size_t>(components));
  for (int c = 0; c < components; ++c) data.push_back(data_.volume(c));
  const LookRamps ramps{ramp_range(components - 1), ramp_range(0)};
  DependentRecipe recipe{recipe_of(0, *data.back(), ramps), {}};
  recipe.opacity.weight = 1;
  if (components == 2) {
    recipe.colors.push_back(reader_.colors(look_of(0), ramps.color));
  } else {
    const double one = largest_color_value(data_);
    for (const Rgb<double>& color : {Rgb<double>{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}) {
      recipe.colors.push_back({Curve{{0, {}}, {one, color}}});
    }
  }
  for (JoinedPoint& point : recipe.opacity.points) point.b = {};
  const auto channels = kept_.channels.find(data, [](const auto& volumes) {
    std::vector<Channel> list;
    list.reserve(volumes.size());
    for (const auto& volume : volumes) list.push_back({std::to_string(list.size()), "", volume});
    return Channels(std::move(list));
  });
  layer.content = ChannelsContent{channels, kept_.dependent.find(recipe, dependent_function)};
  if (!property_.is_linear) {
    notes_.add("dependent components are trilinear (SetInterpolationTypeToLinear())");
  }
  layer.shading = shading_of(property_, 0, notes_);
  if (layer.shading && !has_ambient_light_) layer.shading->ambient = 0;
  if (look_of(0).gradient_opacity) {
    notes_.add("gradient opacities of dependent components are left out");
  }
  return layer;
}

TableLayer GridTranslator::component_layer(int component) {
  TableLayer made{placed_layer()};
  Layer& layer = made.layer;
  layer.projection = projection();
  const ComponentSettings& look = look_of(component);
  const auto data = data_.volume(component);
  const RampRange ramp = ramp_range(component);
  LookRecipe recipe = recipe_of(component, *data, {ramp, ramp});
  const bool is_surface = mapper_.blend == Blend::isosurface || mapper_.blend == Blend::slice;
  if (is_surface) {
    // The medium is clear.
    for (JoinedPoint& point : recipe.points) point.a = 0;
    recipe.opacity_deviation = 0;
  }
  if (shows_nearest(component)) {
    layer.content = nearest_content(data, recipe, component);
    return made;
  }
  const bool has_gradients = look.gradient_opacity && mapper_.blend == Blend::composite;
  FittedCurve gradients;
  if (has_gradients) {
    gradients = gradient_curve(*look.gradient_opacity, ramp, reader_);
    // A factor's ratio is one of the extinction.
    recipe.opacity_deviation += gradients.deviation;
  }
  made.table = opacity_table_of(recipe);
  layer.content =
      VolumeContent{data, kept_.functions.find(recipe, function_of), label_mask(recipe, component)};
  if (layer.projection) {
    if (look.reflection) notes_.add("projections have no light");
    return made;
  }
  if (mapper_.blend == Blend::additive) {
    if (look.reflection) notes_.add("sums have no light");
    return made;
  }
  layer.shading = shading_of(property_, static_cast<std::size_t>(component), notes_);
  if (layer.shading && !has_ambient_light_) layer.shading->ambient = 0;
  if (has_gradients) {
    layer.gradient_opacity = kept_.gradients.find(gradients.points, gradient_opacity_of);
    notes_.add("gradient opacities multiply the extinction here, in VTK the opacity of a sample");
  }
  if (mapper_.blend == Blend::isosurface) add_surfaces(layer, component);
  if (mapper_.blend == Blend::slice) {
    add_slice(layer, reader_.opacities(look.opacity, 1, ramp).points);
  }
  return made;
}

/// Returns whether the property asks for it, and nothing else that needs a gradient or one number
/// of a ray.
bool GridTranslator::shows_nearest(int component) {
  if (property_.is_linear) return false;
  if (mapper_.blend == Blend::composite && !volume_.mask.labels && !look_of(component).reflection &&
      !look_of(component).gradient_opacity) {
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
      looks_of(nearest->values, look_of(component), ramp_range(component), reader_);
  const auto table = kept_.label_tables.find({recipe, std::move(looks)}, [](const auto& made) {
    return label_table(made.first, made.second);
  });
  return {nearest->labels, table};
}

std::shared_ptr<const LabelMask> GridTranslator::label_mask(const LookRecipe& base, int component) {
  const Mask& mask = volume_.mask;
  if (!mask.labels) return nullptr;
  KeptLooks::MaskRecipe recipe{mask.labels, {}};
  LookRecipe look = base;
  if (mask.is_binary) {
    for (JoinedPoint& point : look.points) point.a = 0;
    recipe.second.emplace_back(0, kept_.functions.find(look, function_of));
  } else {
    const RampRange ramp = ramp_range(component);
    for (const LabelSettings& label : property_.labels) {
      if (label.has_gradient_opacity) notes_.add("gradient opacities of labels are left out");
      const FittedCurve own = reader_.colors(look_of(component), ramp);
      const FittedCurve colors =
          label.color ? blended(own, reader_.colors(*label.color, {}), mask.blend) : own;
      const FittedCurve opacities = label.opacity
                                        ? reader_.opacities(*label.opacity, 1, {})
                                        : reader_.opacities(look_of(component).opacity, 1, ramp);
      look.points = joined(opacities.points, colors.points);
      look.opacity_deviation = opacities.deviation;
      look.color_deviation = colors.deviation;
      if (look.meaning == OpacityMeaning::per_unit_distance && mapper_.blend != Blend::composite) {
        continue;  // surfaces
      }
      recipe.second.emplace_back(label.label, kept_.functions.find(look, function_of));
    }
  }
  return kept_.masks.find(recipe, [](const KeptLooks::MaskRecipe& made) {
    std::vector<LabelMask::Choice> choices;
    for (const auto& [label, function] : made.second) choices.push_back({label, function});
    return LabelMask(std::make_shared<const LabelVolume>(made.first), std::move(choices));
  });
}

void GridTranslator::add_surfaces(Layer& layer, int component) {
  const RampRange ramp = ramp_range(component);
  for (const double value : property_.isosurfaces) {
    const auto is_there = [&](const Isosurface& other) { return other.value == value; };
    if (!std::isfinite(value)) {
      notes_.add("isosurfaces at values that are no numbers are left out");
      continue;
    }
    if (std::ranges::any_of(layer.isosurfaces, is_there)) continue;
    Isosurface surface;
    surface.value = value;
    surface.opacity = reader_.opacity_at(look_of(component).opacity, ramp, value);
    surface.color = reader_.color_at(look_of(component), ramp, value);
    layer.isosurfaces.push_back(surface);
  }
}

void GridTranslator::add_slice(Layer& layer, const Curve& opacities) {
  if (!property_.slice) {
    throw Error("slice: the property has no vtkPlane; call SetSliceFunction()");
  }
  const ClipPlane placed = placed_plane(*property_.slice, world_from_data_);
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

std::vector<TableLayer> GridTranslator::cropped(const std::vector<TableLayer>& layers) {
  if (!mapper_.cropping) return layers;
  const std::vector<CroppedBox> boxes = boxes_of(mapper_.cropping->flags);
  std::vector<TableLayer> made;
  for (const TableLayer& each : layers) {
    if (each.layer.projection && boxes.size() > 1) {
      throw Error(
          "cropping: a projection of several boxes is not one number per ray; take "
          "SetCroppingRegionFlagsToSubVolume()");
    }
    for (const CroppedBox& box : boxes) {
      made.push_back(each);
      for (const Clip& clip : clips_of(box, mapper_.cropping->planes, world_from_data_)) {
        made.back().layer.clips.push_back(clip);
      }
    }
  }
  return made;
}

}  // namespace

void KeptLooks::keep_used() {
  channels.keep_used();
  functions.keep_used();
  dependent.keep_used();
  nearest.keep_used();
  label_tables.keep_used();
  curves.keep_used();
  gradients.keep_used();
  masks.keep_used();
}

std::vector<TableLayer> layers_of(const GridVolume& volume, double tolerance,
                                  bool has_ambient_light, KeptLooks& kept, Notes& notes) {
  return GridTranslator(volume, tolerance, has_ambient_light, kept, notes).layers();
}

}  // namespace pellucid::vtk_scene
