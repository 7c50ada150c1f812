// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "layer_functions.h"
#include "meshes/load_mesh_step.h"
#include "pellucid/io/film.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/label_table.h"
#include "pellucid/io/remake_scene.h"
#include "pellucid/io/scene_json.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/presets.h"
#include "scene_json_change.h"
#include "scene_json_parts.h"

namespace pellucid {
namespace {

/// Channels that are made of a scene's one field if a term names them.
constexpr std::array made_of_field{DerivedSource::Kind::gradient_magnitude,
                                   DerivedSource::Kind::second_derivative};

bool names(const MultivariateDescription& function, std::string_view channel) {
  const auto in = [&](const auto& list) {
    return std::find(list.begin(), list.end(), channel) != list.end();
  };
  return in(function.channels) ||
         std::any_of(function.gaussians.begin(), function.gaussians.end(),
                     [&](const auto& gaussian) { return in(gaussian.channels); }) ||
         std::any_of(function.tables.begin(), function.tables.end(),
                     [&](const auto& table) { return table.channel == channel; }) ||
         (function.factor && function.factor->channel == channel);
}

/// Tolerance and background of the scene, to which opacity tables are fitted.
struct FitTarget {
  double tolerance;
  std::optional<Background> background;
};

/// Returns the function of a volume or a mesh.
template <class Data>
TransferFunction function_of(const std::optional<TransferFunctionDescription>& description,
                             const FitTarget& target, const Data& data,
                             std::optional<LayerProjection> projection = {}) {
  if (!description) {
    return projection ? projection_transfer_function(data, *projection)
                      : default_transfer_function(data);
  }
  if (const auto* preset = std::get_if<PresetDescription>(&*description)) {
    return make_preset(preset->name, data, preset->range);
  }
  return make_transfer_function(*description, target.tolerance, target.background);
}

/// Returns the function of a layer of one variable. Without a function between surfaces it is
/// transparent; slices without colors take its own.
template <class Data>
TransferFunction medium_function(const LayerDescription& description, const FitTarget& target,
                                 const Data& data) {
  if (const auto& range = description.function_change.range;
      range && description.transfer_function) {
    // A range says where a preset lies, whatever the units of the data.
    if (const auto* preset = std::get_if<PresetDescription>(&*description.transfer_function)) {
      return make_preset(preset->name, data, value_range(*range, data));
    }
  }
  if (description.transfer_function || !description.shows_surfaces()) {
    return function_of(description.transfer_function, target, data, description.projection);
  }
  const auto has_no_colors = [](const Slice& slice) {
    return !slice.colors && !slice.written_colors;
  };
  if (std::ranges::any_of(description.slices, has_no_colors)) return grey_colors(data);
  return TransferFunction({{0, 0, {0, 0, 0}}});
}

/// Returns a transparent function of several variables.
std::shared_ptr<const MultivariateTransferFunction> transparent_function(std::size_t channels) {
  return std::make_shared<const MultivariateTransferFunction>(
      static_cast<int>(channels), std::vector<GaussianPrimitive>(),
      std::vector<ChannelTransferFunction>{{0, TransferFunction({{0, 0, {0, 0, 0}}})}});
}

/// Returns the content of a loaded layer; null if there is no layer or it has other content.
template <class Content>
const Content* content_of(const Layer* loaded) {
  return loaded != nullptr ? std::get_if<Content>(&loaded->content) : nullptr;
}

/// Returns the field of a loaded layer; null if it has none.
std::shared_ptr<const Volume> kept_field(const Layer* loaded) {
  if (loaded == nullptr) return nullptr;
  for (const Channel& channel : loaded_channels(*loaded)) {
    if (channel.name == field_channel) return channel.volume;
  }
  return nullptr;
}

/// Returns the channels of a loaded layer if they have the names of `sources`, else reads those
/// that it lacks.
std::shared_ptr<const Channels> channels_from(const std::vector<ChannelSource>& sources,
                                              const Layer* loaded, const ParallelFor& parallel) {
  const auto* const content = content_of<ChannelsContent>(loaded);
  if (content != nullptr &&
      std::ranges::equal(*content->channels, sources, {}, &Channel::name, &ChannelSource::name)) {
    return content->channels;
  }
  return std::make_shared<const Channels>(load_channels(
      sources, parallel, loaded != nullptr ? loaded_channels(*loaded) : std::vector<Channel>()));
}

ChannelsContent load_channels_content(const LayerDescription& description,
                                      const std::vector<ChannelSource>& sources,
                                      const Layer* loaded, const ParallelFor& parallel) {
  const MultivariateDescription* const function = scene_json::multivariate_of(description);
  const bool transparent = !description.transfer_function && description.shows_surfaces();
  if (function == nullptr && !transparent) {
    throw Error(description.transfer_function
                    ? "scene: points in one variable are the function of a field, but here are "
                      "channels; give them as one of the \"tables\" with its \"channel\""
                    : "scene: channels need a transfer function; give "
                      "\"gaussians\" or \"tables\" ('pellucid suggest' makes a first one)");
  }
  ChannelsContent content;
  content.transfer_function = transparent ? transparent_function(sources.size())
                                          : make_multivariate(*function, channel_names(sources),
                                                              known_channels(description));
  content.channels = channels_from(sources, loaded, parallel);
  return content;
}

/// Returns the look of a volume or a mesh.
template <class Data>
Look chosen_look(const Data& data, const LayerDescription& description) {
  const WantedLook& wanted = *description.look;
  Look look = choose_look(data, wanted.name, description.function_change);
  const bool lacks_function = look.as_labels || !look.isosurfaces.empty();
  if (!wanted.name.empty() || !wanted.has_function || !lacks_function) return look;
  look = choose_look(data, "haze", description.function_change);
  look.reason = "a function to save";
  return look;
}

/// Loads a mesh, whose function is of one variable or of several. `before`: another step in time.
/// `look` becomes the layer's look, if it takes one.
MeshContent load_mesh_content(const LayerDescription& description, const FitTarget& target,
                              const Layer* loaded, const Layer* before, const ParallelFor& parallel,
                              MeshSource& mesh_used, std::optional<Look>& look) {
  MeshContent content;
  const std::vector<std::string> names = function_channels(description);
  if (const MultivariateDescription* const function = scene_json::multivariate_of(description)) {
    content.transfer_function = make_multivariate(*function, names, names);
  } else if (names.size() > 1 && !description.transfer_function && description.shows_surfaces()) {
    content.transfer_function = transparent_function(names.size());
  } else if (names.size() > 1) {
    throw Error(
        "scene: several arrays of a mesh need a function of them all; give \"gaussians\" or "
        "\"tables\", or leave one array");
  }
  mesh_used = *description.mesh;
  if (const auto* const kept = content_of<MeshContent>(loaded)) {
    content.mesh = kept->mesh;
  } else {
    const auto* const step = content_of<MeshContent>(before);
    LoadedMesh mesh =
        load_mesh_step(*description.mesh, step != nullptr ? step->mesh.get() : nullptr, parallel);
    content.mesh = std::move(mesh.mesh);
    mesh_used.channels = std::move(mesh.channels);
  }
  if (takes_look(description)) {
    look = chosen_look(*content.mesh, description);
    content.transfer_function = std::make_shared<const TransferFunction>(look->transfer_function);
  } else if (content.multivariate() == nullptr) {
    content.transfer_function = std::make_shared<const TransferFunction>(
        medium_function(description, target, *content.mesh));
  }
  return content;
}

/// Loads a volume. `look` becomes the layer's look, if it takes one.
VolumeContent load_volume_content(const LayerDescription& description, const FitTarget& target,
                                  const Layer* loaded, std::optional<Look>& look) {
  VolumeContent content;
  const auto* const kept = content_of<VolumeContent>(loaded);
  content.volume = kept_field(loaded);
  if (!content.volume) {
    content.volume = std::make_shared<const Volume>(load_field(description.field));
  }
  if (takes_look(description)) {
    look = chosen_look(*content.volume, description);
    content.transfer_function = std::make_shared<const TransferFunction>(look->transfer_function);
    return content;
  }
  content.transfer_function = std::make_shared<const TransferFunction>(
      medium_function(description, target, *content.volume));
  if (!description.mask) return content;
  auto labels = kept != nullptr && kept->mask
                    ? kept->mask->shared_labels()
                    : std::make_shared<const LabelVolume>(
                          std::make_shared<const Volume>(load_field(description.mask->field)));
  std::vector<LabelMask::Choice> choices;
  for (const MaskSource::Choice& choice : description.mask->choices) {
    choices.push_back(
        {choice.label, std::make_shared<const TransferFunction>(function_of(
                           std::optional(choice.transfer_function), target, *content.volume))});
  }
  content.mask = std::make_shared<const LabelMask>(std::move(labels), std::move(choices));
  return content;
}

LabelContent load_label_content(const LabelSource& source, const Layer* loaded) {
  LabelContent content;
  const auto* const kept = content_of<LabelContent>(loaded);
  content.labels = kept != nullptr ? kept->labels
                                   : std::make_shared<const LabelVolume>(
                                         std::make_shared<const Volume>(load_field(source.field)));
  std::vector<LabelStyle> styles = source.styles;
  if (!source.table.empty()) {
    const double extinction =
        source.extinction.value_or(default_label_extinction(content.labels->volume()));
    for (LabelStyle& style : read_label_table(source.table, extinction)) {
      const auto is_same = [&](const LabelStyle& own) { return own.label == style.label; };
      if (std::ranges::none_of(source.styles, is_same)) styles.push_back(std::move(style));
    }
  }
  content.table = std::make_shared<const LabelTable>(
      styles.empty() ? default_label_table(*content.labels, source.extinction)
                     : LabelTable(std::move(styles)));
  return content;
}

/// Returns the colors of a surface as written, which are a preset or an opacity table; null: grey
/// over the range of the data.
template <class Data>
TransferFunction made_colors(const TransferFunctionDescription* written, const Data& data) {
  if (written == nullptr) return grey_colors(data);
  const auto* const table = std::get_if<OpacityTable>(written);
  if (table == nullptr) return function_of(*written, FitTarget{}, data);
  std::vector<TransferFunction::Point> points;
  for (const OpacityPoint& point : table->points) points.push_back({point.value, 0, point.color});
  return {std::move(points), 0.0, table->color_deviation};
}

/// Calls visit(channel, what) with each channel that a layer's light and surfaces look at. It may
/// change them; `what` names the place in messages.
template <class Visit>
void visit_channels(Layer& layer, const Visit& visit) {
  if (layer.shading) visit(layer.shading->channel, "shading");
  if (const GradientOpacity* const opacity = layer.gradient_opacity.get()) {
    ChannelRef channel = opacity->channel();
    visit(channel, "gradient opacity");
    if (channel.index() != opacity->channel().index() ||
        channel.name() != opacity->channel().name()) {
      layer.gradient_opacity = std::make_shared<const GradientOpacity>(
          opacity->points(), opacity->unit(), std::move(channel));
    }
  }
  for (Isosurface& surface : layer.isosurfaces) {
    visit(surface.channel, "an isosurface");
    visit(surface.color_channel, "an isosurface");
  }
  for (Slice& slice : layer.slices) visit(slice.channel, "a slice");
}

void check_index(int index, const char* what, const std::vector<std::string>& names) {
  if (index >= 0 && index < static_cast<int>(names.size())) return;
  throw Error(std::string("scene: ") + what + " looks at channel " + std::to_string(index) +
              ", but there are " + std::to_string(names.size()) + ", counted from 0");
}

/// Finds the channels of the light and the surfaces of a layer that has its data, and makes the
/// colors of its surfaces.
class LookLoader {
 public:
  LookLoader(const LayerDescription& description, Layer& layer)
      : layer_(layer), names_(function_channels(description)) {
    if (names_.empty()) names_.emplace_back(field_channel);
  }

  void operator()() const {
    visit_channels(layer_, [&](ChannelRef& channel, const char* what) { resolve(channel, what); });
    for (Isosurface& surface : layer_.isosurfaces) {
      if (surface.written_colors) make_colors(surface, surface.color_channel);
    }
    // Those of one variable have the colors of its function.
    const bool of_one = is_of_one_variable();
    for (Slice& slice : layer_.slices) {
      if (slice.written_colors || (!slice.colors && !of_one)) make_colors(slice, slice.channel);
    }
  }

 private:
  void resolve(ChannelRef& channel, const char* what) const {
    if (channel.name().empty()) return check_index(channel, what, names_);
    const auto found = std::ranges::find(names_, channel.name());
    if (found != names_.end()) return channel.resolve(static_cast<int>(found - names_.begin()));
    std::string list;
    for (const std::string& name : names_) list += (list.empty() ? "" : ", ") + name;
    throw Error(std::string("scene: ") + what + " looks at a channel \"" + channel.name() +
                "\", which is not there; there are: " + list);
  }

  bool is_of_one_variable() const {
    const auto* const mesh = std::get_if<MeshContent>(&layer_.content);
    return std::holds_alternative<VolumeContent>(layer_.content) ||
           (mesh != nullptr && mesh->univariate() != nullptr);
  }

  /// Makes the colors of a surface or a slice. A preset is made for good; an opacity table stays as
  /// it is written.
  template <class Surface>
  void make_colors(Surface& surface, int channel) const {
    const auto make = [&](const auto& data) {
      surface.colors =
          std::make_shared<const TransferFunction>(made_colors(surface.written_colors.get(), data));
    };
    if (const auto* volume = std::get_if<VolumeContent>(&layer_.content)) {
      make(*volume->volume);
    } else if (const auto* channels = std::get_if<ChannelsContent>(&layer_.content)) {
      make(*(*channels->channels)[channel].volume);
    } else if (const auto* mesh = std::get_if<MeshContent>(&layer_.content)) {
      make(channel == 0 ? *mesh->mesh
                        : MeshChannels(mesh->mesh->shared_mesh(), {(*mesh->mesh)[channel]}));
    }
    if (surface.written_colors && !std::holds_alternative<OpacityTable>(*surface.written_colors)) {
      surface.written_colors.reset();
    }
  }

  Layer& layer_;
  std::vector<std::string> names_;
};

/// Takes the data of `loaded` unless it is null, and what stays of `before`, the layer at another
/// time, unless that is.
Layer load_layer(const LayerDescription& description, const FitTarget& target, const Layer* loaded,
                 const Layer* before, const ParallelFor& parallel, MeshSource& mesh_used) {
  Layer layer = static_cast<const Layer&>(description);
  std::optional<Look> look;
  if (description.labels) {
    layer.content = load_label_content(*description.labels, loaded);
  } else if (description.mesh) {
    layer.content =
        load_mesh_content(description, target, loaded, before, parallel, mesh_used, look);
  } else if (const auto sources = layer_channels(description); !sources.empty()) {
    layer.content = load_channels_content(description, sources, loaded, parallel);
  } else {
    layer.content = load_volume_content(description, target, loaded, look);
  }
  if (!look) change_function(description, layer);
  LookLoader(description, layer)();
  if (look) {
    const WantedLook& wanted_look = *description.look;
    if (wanted_look.chosen) wanted_look.chosen(*look);
    if (wanted_look.keeps_shading) look->shading = layer.shading;
    put_look(*std::move(look), layer);
  }
  return layer;
}

}  // namespace

bool takes_look(const LayerDescription& description) {
  return description.look && !description.transfer_function && !description.projection &&
         !description.mask && !description.shows_surfaces();
}

Look look_of(const Volume& volume, const LayerDescription& description) {
  return chosen_look(volume, description);
}

Look look_of(const MeshChannels& mesh, const LayerDescription& description) {
  return chosen_look(mesh, description);
}

TransferFunction function_on(const Volume& volume, const LayerDescription& description) {
  return medium_function(description, FitTarget{}, volume);
}
TransferFunction function_on(const MeshChannels& mesh, const LayerDescription& description) {
  return medium_function(description, FitTarget{}, mesh);
}

std::vector<ChannelSource> layer_channels(const LayerDescription& description) {
  if (description.mesh || description.labels) return {};
  if (!description.channels.empty()) return description.channels;
  const MultivariateDescription* const function = scene_json::multivariate_of(description);
  if (function == nullptr) return {};
  std::vector<ChannelSource> channels{{std::string(field_channel), "", description.field}};
  for (const auto kind : made_of_field) {
    const std::string name(derived_name(kind));
    if (!names(*function, name)) continue;
    channels.push_back({name, "", DerivedSource{kind, std::string(field_channel), 0}});
  }
  return channels;
}

std::vector<std::string> function_channels(const LayerDescription& description) {
  return description.mesh ? channel_names(*description.mesh)
                          : channel_names(layer_channels(description));
}

std::vector<std::string> known_channels(const LayerDescription& description) {
  if (description.mesh) return channel_names(*description.mesh);
  if (!description.channels.empty()) return channel_names(description.channels);
  std::vector<std::string> names{std::string(field_channel)};
  for (const auto kind : made_of_field) names.emplace_back(derived_name(kind));
  return names;
}

void name_channels(LayerDescription& layer) {
  std::vector<std::string> names;
  visit_channels(layer, [&](ChannelRef& channel, const char* what) {
    if (!channel.name().empty() || channel.index() == 0) return;
    if (names.empty()) names = function_channels(layer);
    const int index = channel.index();
    check_index(index, what, names);
    channel = names[static_cast<std::size_t>(index)];
    channel.resolve(index);
  });
}

Scene make_scene(const SceneDescription& description, const ParallelFor& parallel,
                 std::vector<MeshSource>* meshes_used) {
  return remake_scene(description, std::vector<std::optional<Layer>>(description.layers.size()),
                      parallel, meshes_used);
}

Scene remake_scene(const SceneDescription& description,
                   const std::vector<std::optional<Layer>>& loaded, const ParallelFor& parallel,
                   std::vector<MeshSource>* meshes_used, std::span<const Layer> before) {
  const auto& film = description.animation;
  if (description.time || (film && film->moves_data())) {
    SceneDescription at_time = description;
    at_time.animation.reset();
    if (!at_time.time) set_first_time(*film, at_time);
    resolve_time(at_time);
    return remake_scene(at_time, loaded, parallel, meshes_used, before);
  }
  Scene scene;
  static_cast<SceneSettings&>(scene) = description;
  const FitTarget target{description.integration.tolerance, description.background};
  std::vector<MeshSource> meshes(description.layers.size());
  for (std::size_t i = 0; i < description.layers.size(); ++i) {
    const Layer* const kept = loaded[i] ? &*loaded[i] : nullptr;
    scene.layers.push_back(load_layer(description.layers[i], target, kept,
                                      i < before.size() ? &before[i] : nullptr, parallel,
                                      meshes[i]));
  }
  if (meshes_used != nullptr) *meshes_used = std::move(meshes);
  scene.camera = description.camera
                     ? *description.camera
                     : default_camera(visible_corners(scene, parallel), description.size);
  if (!description.backdrop.empty()) {
    scene.backdrop = std::make_shared<const Image>(read_exr(description.backdrop));
  }
  fit_opacity_tables(description, scene);
  return scene;
}

std::vector<Channel> loaded_channels(const Layer& layer) {
  if (const auto* const channels = std::get_if<ChannelsContent>(&layer.content)) {
    return {channels->channels->begin(), channels->channels->end()};
  }
  const auto* const field = std::get_if<VolumeContent>(&layer.content);
  if (field == nullptr) return {};
  return {{std::string(field_channel), "", field->volume}};
}

Layer remake_layer(const SceneDescription& description, std::size_t layer, const Layer& loaded,
                   const ParallelFor& parallel) {
  MeshSource mesh;
  return load_layer(description.layers[layer],
                    {description.integration.tolerance, description.background}, &loaded, nullptr,
                    parallel, mesh);
}

}  // namespace pellucid
