// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arguments/overwriting.h"
#include "arguments/parse.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/io/film.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/remake_scene.h"
#include "pellucid/scene/labels.h"
#include "pellucid/scene/view_camera.h"
#include "render.h"
#include "view/suggestions.h"

namespace pellucid::cli {

namespace {

/// Reads --background into the description.
void set_background(const std::string& text, SceneDescription& description) {
  description.is_transparent = text == "transparent";
  description.background.reset();
  if (description.is_transparent) return;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    description.background = parse_color("--background", text);
  } else {
    description.background = Background{parse_color("--background", text.substr(0, colon)),
                                        parse_color("--background", text.substr(colon + 1))};
  }
}

/// Throws UsageError where an argument is given that speaks of an error, as no error is known.
void refuse_error_arguments(const RenderArguments& arguments, const std::string& why) {
  const std::pair<const char*, bool> given[] = {{"--tolerance", arguments.tolerance.has_value()},
                                                {"--grade", !arguments.grade.empty()},
                                                {"--error-map", !arguments.error_map.empty()},
                                                {"--strict", arguments.strict}};
  for (const auto& [argument, is_given] : given) {
    if (is_given) throw UsageError(fmt::format("{}: {}", argument, why));
  }
}

std::vector<NamedFile> output_files(const RenderArguments& arguments) {
  std::vector<NamedFile> files;
  for (const std::string& path : arguments.outputs) files.push_back({"-o", path});
  for (const std::string& path : arguments.figure.files) files.push_back({"--figure", path});
  const NamedFile others[] = {{"--depth", arguments.depth_picture},
                              {"--error-map", arguments.error_map},
                              {"--values", arguments.values},
                              {"--save-tf", arguments.save_tf},
                              {"--save-scene", arguments.save_scene}};
  for (const NamedFile& file : others) {
    if (!file.path.empty()) files.push_back(file);
  }
  return files;
}

}  // namespace

bool RenderArguments::is_scene() const {
  return extension_of(input) == ".json" && !is_volume_json(input);
}

std::string source_text(const RenderArguments& arguments) {
  std::string text = arguments.input;
  if (!arguments.mesh.q.empty()) text += ", " + arguments.mesh.q;
  for (const auto* list : {&arguments.channels, &arguments.layers, &arguments.labels}) {
    for (const std::string& more : *list) text += (text.empty() ? "" : ", ") + more;
  }
  return text;
}

void check_arguments(const RenderArguments& arguments) {
  if (arguments.input.empty() && arguments.channels.empty() && arguments.layers.empty() &&
      arguments.labels.empty()) {
    throw UsageError("no input; give INPUT, --channel or --labels (see 'pellucid render --help')");
  }
  if (!arguments.renders() && !arguments.print_tf && arguments.save_tf.empty() &&
      arguments.save_scene.empty()) {
    throw UsageError(
        "nothing to write; give -o FILE.png or FILE.exr (see 'pellucid render --help')");
  }
  if (!arguments.balance.empty() && !arguments.ranks) {
    throw UsageError("--balance: is of the parts of --ranks; give that too, or drop it");
  }
  for (const auto& [name, given] :
       {std::pair{"--azimuth", arguments.azimuth}, std::pair{"--elevation", arguments.elevation}}) {
    if (given && !(std::abs(*given) <= 360)) {
      throw UsageError(fmt::format("{} {}: expected degrees from -360 to 360", name, *given));
    }
  }
  if (arguments.zoom && !(*arguments.zoom >= 1e-3 && *arguments.zoom <= 1e3)) {
    throw UsageError(
        fmt::format("--zoom {}: expected a factor from 0.001 to 1000", *arguments.zoom));
  }
  if (arguments.json && !arguments.renders()) {
    throw UsageError("--json reports on a rendering; give -o FILE.png or FILE.exr");
  }
  if (arguments.reference) {
    refuse_error_arguments(arguments,
                           "--reference always integrates to 1e-12 and reports no error; drop one "
                           "of the two ('pellucid compare' measures how much pictures differ)");
  }
  check_color_bar(arguments);
  check_figures(arguments);
  if (arguments.strict && !arguments.renders()) {
    throw UsageError("--strict judges a rendering; give -o FILE.png or FILE.exr");
  }
  std::vector<NamedFile> pictures;
  for (const std::string& path : arguments.outputs) pictures.push_back({"-o", path});
  if (!arguments.error_map.empty()) pictures.push_back({"--error-map", arguments.error_map});
  for (const NamedFile& picture : pictures) {
    const std::string extension = extension_of(picture.path);
    if (extension != ".png" && extension != ".exr") {
      throw UsageError(fmt::format("{} {}: expected a name that ends in .png or .exr",
                                   picture.argument, picture.path));
    }
  }
  if (!arguments.depth_picture.empty() && extension_of(arguments.depth_picture) != ".png") {
    throw UsageError(
        fmt::format("--depth {}: expected a name that ends in .png (an .exr of -o has "
                    "the depth in its channel Z)",
                    arguments.depth_picture));
  }
  if (const std::string extension = extension_of(arguments.values);
      !arguments.values.empty() && extension != ".npy" && extension != ".exr") {
    throw UsageError(
        fmt::format("--values {}: expected a name that ends in .npy or .exr", arguments.values));
  }
  const std::vector<NamedFile> outputs = output_files(arguments);
  const NamedFile inputs[] = {{"INPUT", arguments.input},
                              {"--solution", arguments.mesh.q},
                              {"--tf", arguments.transfer_function},
                              {"--camera", arguments.camera}};
  refuse_overwriting(outputs, inputs);
  for (const NamedFile& output : outputs) check_writable(output.path);
}

namespace {

void set_integration(const RenderArguments& arguments, Integration& integration) {
  if (!arguments.method.empty()) integration.method = *method_from_name(arguments.method);
  if (!arguments.precision.empty()) {
    integration.precision = arguments.precision == "double"  ? Precision::float64
                            : arguments.precision == "float" ? Precision::float32
                                                             : Precision::automatic;
  }
  if (integration.method != Method::exact) {
    refuse_error_arguments(
        arguments, fmt::format("the error of method {} is not known; use --method exact, or drop "
                               "it and measure with 'pellucid compare'",
                               method_name(integration.method)));
  }
  if (!arguments.grade.empty()) {
    integration.grade = arguments.grade == "proved" ? Grade::proved : Grade::estimated;
  }
  if (!arguments.step) return;
  if (integration.method == Method::exact) {
    throw UsageError(
        "--step: the exact method has no step; drop it or choose a sampling --method, as midpoint");
  }
  // The rendering refuses it as well, but a scene may be saved without one.
  if (!(*arguments.step >= smallest_step && *arguments.step <= largest_step)) {
    throw UsageError(fmt::format("--step {}: expected a length in voxels, from {} to {}",
                                 *arguments.step, smallest_step, largest_step));
  }
  integration.step = *arguments.step;
}

/// Calls parse(); a text of the command line that does not read is a wrong argument.
template <class Parse>
auto parse_argument(const char* argument, Parse&& parse) {
  try {
    return parse();
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    throw UsageError(fmt::format("{}: {}", argument, error.what()));
  }
}

/// Adds channels behind those of the input, or alone.
void add_channels(const RenderArguments& arguments, LayerDescription& description) {
  if (arguments.channels.empty()) return;
  if (description.mesh) {
    throw UsageError("--channel: the channels of a mesh are its arrays; give --array NAME=ARRAY");
  }
  if (!arguments.input.empty()) description.channels = layer_channels(description);
  if (description.channels.empty() && !arguments.input.empty()) {
    description.channels = {{std::string(field_channel), "", description.field}};
  }
  parse_argument("--channel", [&] {
    for (const std::string& text : arguments.channels) {
      description.channels.push_back(channel_source(text, arguments.volume));
    }
    refuse_options_without_files(description.channels, arguments.volume);
    check_channel_sources(description.channels);
    return 0;
  });
}

MultivariateDescription gaussians(const RenderArguments& arguments) {
  MultivariateDescription function;
  for (const std::string& text : arguments.gaussians) {
    function.gaussians.push_back(
        parse_argument("--gaussian", [&] { return parse_gaussian(text); }));
  }
  return function;
}

/// Sets the volume. One array is the field, unless it is given a name as a channel; several are
/// channels.
void set_volume(const RenderArguments& arguments, LayerDescription& description) {
  arguments.mesh.refuse_q("a volume");
  FieldSource field = field_source(arguments.input, arguments.volume);
  if (!field.builtin.empty()) arguments.mesh.refuse("a built-in field");
  arguments.mesh.set_time(field.options);
  std::vector<MeshArrayChoice> choices;
  for (const std::string& text : arguments.mesh.arrays) {
    choices.push_back(parse_argument("--array", [&] { return parse_mesh_array(text); }));
  }
  const bool named =
      choices.size() == 1 && arguments.mesh.arrays.front().starts_with(choices.front().name + "=");
  if (choices.empty()) {
    description.field = field;
    return;
  }
  for (const MeshArrayChoice& choice : choices) {
    ChannelSource channel{choice.name, "", field};
    ReadOptions& options = std::get<FieldSource>(channel.source).options;
    options.array = choice.array;
    if (choice.component) options.component = choice.component;
    description.channels.push_back(std::move(channel));
  }
  if (choices.size() > 1 || named) {
    parse_argument("--array", [&] {
      check_channel_sources(description.channels);
      return 0;
    });
    return;
  }
  description.field = std::get<FieldSource>(description.channels.front().source);
  description.channels.clear();
}

/// Throws UsageError where an argument is about the one layer of a scene that has several.
void refuse_options_of_one_layer(const RenderArguments& arguments,
                                 const SceneDescription& description) {
  if (description.layers.size() == 1) return;
  const std::pair<const char*, bool> given[] = {{"--tf", !arguments.transfer_function.empty()},
                                                {"--preset", !arguments.preset.empty()},
                                                {"--gaussian", !arguments.gaussians.empty()},
                                                {"--colormap", !arguments.colors.colormap.empty()},
                                                {"--range", !arguments.colors.range.empty()},
                                                {"--opacity", arguments.colors.opacity.has_value()},
                                                {"--channel", !arguments.channels.empty()},
                                                {"--projection", !arguments.projection.empty()},
                                                {"--iso", !arguments.light.isosurfaces.empty()},
                                                {"--slice", !arguments.light.slices.empty()},
                                                {"--shading", !arguments.light.shading.empty()},
                                                {"--print-tf", arguments.print_tf},
                                                {"--save-tf", !arguments.save_tf.empty()}};
  for (const auto& [argument, is_given] : given) {
    if (!is_given) continue;
    throw UsageError(fmt::format("{}: the scene has {} layers; edit the layer in the scene",
                                 argument, description.layers.size()));
  }
}

/// Returns the first option that gives a function; empty: none is given.
std::string option_of_function(const RenderArguments& arguments) {
  if (!arguments.transfer_function.empty()) return "--tf";
  if (!arguments.preset.empty()) return "--preset";
  return arguments.gaussians.empty() ? "" : "--gaussian";
}

/// Returns the first option that says how INPUT is shown; empty: none is given.
std::string option_of_input(const RenderArguments& arguments) {
  if (std::string function = option_of_function(arguments); !function.empty()) return function;
  if (!arguments.projection.empty()) return "--projection";
  const std::string option = arguments.colors.option_of_a_layer();
  return option.empty() ? arguments.light.option_of_a_layer() : option;
}

/// Throws UsageError where an argument is about INPUT, but there are added layers alone.
void refuse_options_of_input(const RenderArguments& arguments) {
  if (const std::string option = option_of_input(arguments); !option.empty()) {
    throw UsageError(option + ": is for INPUT; give one, or write it into a layer of a scene");
  }
  if (const std::string look = lower_case(arguments.look);
      !look.empty() && look != "labels" && arguments.layers.empty()) {
    throw UsageError(
        fmt::format("--look {}: is for INPUT; labels have a look of their own; drop "
                    "it, or give INPUT",
                    arguments.look));
  }
  constexpr const char* added = "files of --layer and --labels";
  arguments.volume.refuse(added);
  arguments.import.refuse(added);
}

/// Throws UsageError where an argument gives a function to labels of a scene.
void refuse_function_of_labels(const RenderArguments& arguments, const LayerDescription& layer) {
  const std::string option = option_of_function(arguments);
  if (!layer.labels || option.empty()) return;
  throw UsageError(option + ": labels have colors of their own; give a table of them");
}

/// Adds the layers of --layer and --labels, and the clips of --clip.
void add_layers(const RenderArguments& arguments, SceneDescription& description) {
  const VolumeOptions no_options;
  for (const std::string& file : arguments.layers) {
    LayerDescription layer;
    layer.name = std::filesystem::path(file).filename().string();
    parse_argument("--layer", [&] {
      if (is_mesh(file, {})) {
        layer.mesh = mesh_source(file, {});
      } else {
        layer.field = field_source(file, no_options);
      }
      return 0;
    });
    description.layers.push_back(std::move(layer));
  }
  if (arguments.label_tables.size() > arguments.labels.size()) {
    throw UsageError("--label-table: is of a segmentation; give one more --labels, or drop it");
  }
  auto table = arguments.label_tables.begin();
  for (const std::string& file : arguments.labels) {
    LayerDescription layer;
    layer.name = std::filesystem::path(file).filename().string();
    parse_argument("--labels", [&] {
      layer.labels = LabelSource{field_source(file, no_options), {}, {}, {}};
      if (table != arguments.label_tables.end()) layer.labels->table = *table++;
      return 0;
    });
    description.layers.push_back(std::move(layer));
  }
  for (const std::string& text : arguments.clips) {
    description.clips.push_back(parse_clip("--clip", text));
  }
}

/// Puts --time and --time-between into a scene of other data than the one INPUT, which all have
/// their step at that time.
void set_time_of_all(const RenderArguments& arguments, SceneDescription& description) {
  const MeshOptions& given = arguments.mesh;
  if (description.layers.size() == 1 && !arguments.is_scene() && !arguments.input.empty()) return;
  if (!given.time && given.time_between.empty()) return;
  if (given.time) description.time = given.time;
  const bool has_time = description.time.has_value() || given.has_times;
  const TimeBetween between = between_steps(given.time_between, has_time);
  const auto set = [&](auto& options) {
    if (!arguments.is_scene()) options.time.reset();
    if (!given.time_between.empty()) options.time_between = between;
  };
  for (LayerDescription& layer : description.layers) {
    visit_sources(layer, [&](FieldSource& field) { set(field.options); });
    if (layer.mesh) set(layer.mesh->options);
  }
}

SceneDescription describe(const RenderArguments& arguments,
                          std::vector<std::string>& import_notes) {
  SceneDescription description;
  LayerDescription layer;
  const std::filesystem::path input = arguments.input;
  if (arguments.is_scene()) {
    arguments.volume.refuse("a scene; write it into the scene's field");
    arguments.mesh.refuse_but_times("a scene; write it into the scene's mesh");
    description = parse_scene(read_text_file(input), arguments.input, input.parent_path());
    layer = description.layers.front();
  } else if (is_mesh(arguments.input, arguments.mesh)) {
    arguments.volume.refuse("a mesh");
    layer.mesh = mesh_source(arguments.input, arguments.mesh);
  } else if (!arguments.input.empty()) {
    set_volume(arguments, layer);
    set_own_colors(arguments, layer, import_notes);
  } else {
    arguments.mesh.refuse_but_times("channels of volumes");
  }
  if (arguments.has_only_added_layers()) {
    refuse_options_of_input(arguments);
    description.layers.clear();
  } else {
    refuse_options_of_one_layer(arguments, description);
    refuse_function_of_labels(arguments, layer);
  }
  if (!arguments.gaussians.empty()) layer.transfer_function = gaussians(arguments);
  add_channels(arguments, layer);
  if (!arguments.projection.empty()) {
    layer.projection = *projection_from_name(arguments.projection);
  }
  if (!description.layers.empty()) {
    description.layers.front() = layer;
    set_transfer_function(arguments, description, import_notes);
    arguments.colors.apply(description.layers.front());
    arguments.light.apply(description.layers.front());
  }
  arguments.light.apply(description);
  add_layers(arguments, description);
  set_time_of_all(arguments, description);
  if (!arguments.camera.empty()) {
    description.camera = parse_camera(read_text_file(arguments.camera), arguments.camera);
  }
  if (!arguments.size.empty()) description.size = parse_size("--size", arguments.size);
  if (!arguments.background.empty()) {
    set_background(arguments.background, description);
  }
  if (!arguments.backdrop.empty()) {
    description.backdrop = arguments.backdrop;
    if (arguments.size.empty() && !arguments.is_scene()) {
      const Image image = read_exr(arguments.backdrop);
      description.size = {image.width, image.height};
    }
  }
  if (arguments.samples) description.samples = *arguments.samples;
  set_integration(arguments, description.integration);
  const bool only_meshes = std::ranges::all_of(
      description.layers, [](const LayerDescription& one) { return one.mesh.has_value(); });
  if (arguments.step && only_meshes && takes_cells(description.integration.method)) {
    throw UsageError(
        fmt::format("--step: the method {} goes from tetrahedron to tetrahedron, "
                    "without steps; drop it, or take midpoint",
                    method_name(description.integration.method)));
  }
  return description;
}

std::vector<NamedFile> data_files(const LayerDescription& description) {
  if (description.mesh) return cli::data_files(*description.mesh);
  if (description.labels) {
    return {{"labels", description.labels->field.file.string()},
            {"table", description.labels->table.string()}};
  }
  std::vector<NamedFile> files{{"volume", description.field.file.string()}};
  if (description.mask) files.push_back({"mask", description.mask->field.file.string()});
  for (const ChannelSource& channel : description.channels) {
    if (const auto* field = std::get_if<FieldSource>(&channel.source)) {
      files.push_back({"channel " + channel.name, field->file.string()});
    }
  }
  return files;
}

std::vector<NamedFile> data_files(const SceneDescription& description) {
  std::vector<NamedFile> files;
  for (const LayerDescription& layer : description.layers) {
    for (NamedFile& file : data_files(layer)) files.push_back(std::move(file));
  }
  if (!description.backdrop.empty()) {
    files.push_back({"--backdrop", description.backdrop.string()});
  }
  return files;
}

}  // namespace

void visit_fields_of_files(const Layer& layer, const LayerDescription& description,
                           std::size_t index, std::size_t layers,
                           const std::function<void(const std::string&, const Volume&)>& visit) {
  const std::string prefix = layers == 1 ? ""
                             : description.name.empty()
                                 ? "layer " + std::to_string(index + 1) + ", "
                                 : description.name + ", ";
  const auto is_file = [](const FieldSource& field) { return field.builtin.empty(); };
  if (const auto* volume = std::get_if<VolumeContent>(&layer.content)) {
    if (is_file(description.field)) visit(prefix + std::string(field_channel), *volume->volume);
    return;
  }
  const auto* channels = std::get_if<ChannelsContent>(&layer.content);
  if (channels == nullptr) return;
  const std::vector<ChannelSource> sources = layer_channels(description);
  for (const Channel& channel : *channels->channels) {
    const auto source = std::ranges::find(sources, channel.name, &ChannelSource::name);
    if (source == sources.end()) continue;
    const auto* field = std::get_if<FieldSource>(&source->source);
    if (field != nullptr && is_file(*field)) visit(prefix + channel.name, *channel.volume);
  }
}

void set_scene_tolerance(PreparedScene& prepared, double tolerance) {
  SceneDescription& description = prepared.description;
  Scene& scene = prepared.scene;
  prepared.tolerance_asked = tolerance;
  scene.integration.tolerance = nearest_tolerance(tolerance);
  // With the tolerance that was used, a saved scene gives this picture.
  description.integration.tolerance = scene.integration.tolerance;
  description.integration.relative_tolerance.reset();
  fit_opacity_tables(description, scene);
}

namespace {

/// Has the data of a layer read in part. Throws UsageError, also later where the part is outside.
void set_crop(const IndexBox& box, LayerDescription& layer) {
  if (layer.mesh) throw UsageError("--crop: is of grids; a mesh is not cut");
  visit_sources(layer, [&](FieldSource& field) {
    if (!field.builtin.empty()) throw UsageError("--crop: is of files, not of a built-in field");
    field.options.part = [box](const Volume::Description& whole) {
      for (std::size_t a = 0; a < 3; ++a) {
        if (box.first[a] + box.count[a] <= whole.dimensions[a]) continue;
        throw UsageError(fmt::format("--crop: ends at {} along {}, but {} has {} values there",
                                     box.first[a] + box.count[a], "xyz"[a], whole.name,
                                     whole.dimensions[a]));
      }
      return box;
    };
  });
}

}  // namespace

namespace {

/// Returns the steps that a time chooses from; none: no time is asked for.
std::optional<SceneTimes> times_of(const RenderArguments& arguments,
                                   const SceneDescription& description) {
  if (description.time) return SceneTimes(description);
  if (arguments.is_scene() || description.layers.empty()) return std::nullopt;
  SceneDescription bare = description;
  LayerDescription& layer = bare.layers.front();
  std::optional<double>& time = layer.mesh ? layer.mesh->options.time : layer.field.options.time;
  if (!time) return std::nullopt;
  time.reset();
  return SceneTimes(bare);
}

/// Chooses what is left to data of which one step is asked for from all steps, as films do: so
/// pictures of several steps can be compared.
void choose_from_steps(SceneRequest& request, const ParallelFor& parallel) {
  if (!request.times) return;
  SceneDescription& asked = request.prepared.description;
  SceneDescription tried = asked;
  for (std::size_t i = 0; i < tried.layers.size(); ++i) {
    // A part of the data is chosen in the request alone.
    tried.layers[i].field.options.part = request.description.layers[i].field.options.part;
  }
  const StepsAsked tell{
      {}, [&](const std::string& note) { request.prepared.import_notes.push_back(note); }};
  for (const std::size_t i : choose_for_all_steps(tried, *request.times, parallel, tell)) {
    copy_choice(tried.layers[i], asked.layers[i]);
    copy_choice(tried.layers[i], request.description.layers[i]);
  }
}

}  // namespace

SceneRequest request_scene(const RenderArguments& arguments) {
  SceneRequest request;
  PreparedScene& prepared = request.prepared;
  prepared.description = describe(arguments, prepared.import_notes);
  SceneDescription& description = prepared.description;
  if (!arguments.mesh.has_times) {
    request.times = times_of(arguments, description);
    resolve_time(description);
    if (arguments.suggests_functions) set_first_step(description);
  }
  const int threads = arguments.threads > 0 ? arguments.threads : default_thread_count();
  if (arguments.suggests_functions) {
    request.loaded = view::suggest_missing_functions(
        description, parallel_for(threads),
        [&](std::vector<ChannelSource>& channels) { set_notes(channels, arguments.quiet); });
  }
  Integration& integration = description.integration;
  prepared.tolerance_asked = integration.tolerance;
  if (arguments.tolerance) {
    const PictureTolerance tolerance = parse_picture_tolerance("--tolerance", *arguments.tolerance);
    integration.relative_tolerance.reset();
    if (tolerance.is_share) {
      integration.relative_tolerance = tolerance.value;
    } else {
      prepared.tolerance_asked = tolerance.value;
    }
  }
  integration.tolerance = nearest_tolerance(prepared.tolerance_asked);
  // The files of a scene are known only now.
  refuse_overwriting(output_files(arguments), data_files(description));
  prepared.transfer_function_from = !arguments.transfer_function.empty()
                                        ? arguments.transfer_function
                                    : !arguments.preset.empty()    ? "--preset " + arguments.preset
                                    : !arguments.gaussians.empty() ? "--gaussian"
                                    : description.layers.front().transfer_function ? arguments.input
                                    : description.layers.front().shows_surfaces()  ? "none"
                                                                                   : "default";
  want_look(arguments, prepared);
  request.loaded.resize(description.layers.size());
  SceneDescription& rendered = request.description;
  rendered = description;
  if (arguments.reference && integration.tolerance > reference_tolerance) {
    rendered.integration.tolerance = reference_tolerance;
  }
  request.mesh_notes = std::make_shared<std::vector<std::string>>();
  if (arguments.crop) set_crop(*arguments.crop, rendered.layers.front());
  for (LayerDescription& layer : rendered.layers) {
    visit_sources(layer, [&](FieldSource& field) { set_notes(field, arguments.quiet); });
    if (layer.mesh) {  // printed last, so that a failure is one line
      layer.mesh->options.note = [notes = request.mesh_notes](const std::string& note) {
        notes->push_back(note);
      };
    }
  }
  prepared.has_own_camera = description.camera.has_value();
  const auto& first_mesh = description.layers.front().mesh;
  prepared.array_chosen = first_mesh && first_mesh->channels.empty();
  return request;
}

PreparedScene complete_scene(const RenderArguments& arguments, SceneRequest request, Scene loaded,
                             const std::vector<MeshSource>& meshes, const VisibleCorners& visible) {
  PreparedScene prepared = std::move(request.prepared);
  for (std::string& note : *request.mesh_notes) prepared.import_notes.push_back(std::move(note));
  SceneDescription& description = prepared.description;
  prepared.scene = std::move(loaded);
  Scene& scene = prepared.scene;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    LayerDescription& layer = description.layers[i];
    if (layer.mesh) {
      layer.mesh = meshes[i];
      layer.mesh->options.note = {};
    }
    complete_description(scene.layers[i], layer);
    if (arguments.ranks) continue;  // no rank has all labels
    visit_fields_of_files(scene.layers[i], layer, i, scene.layers.size(),
                          [&](const std::string& name, const Volume& volume) {
                            if (const auto count = label_count(volume)) {
                              prepared.labels.emplace_back(name, *count);
                            }
                          });
  }
  scene.integration = description.integration;
  if (!prepared.knows_its_error(arguments)) scene.integration.relative_tolerance.reset();
  check_data(scene);
  if (!arguments.view.empty()) {
    scene.camera = view_camera(visible(scene), arguments.view, scene.size);
  }
  description.camera = scene.camera;
  make_camera_frame(scene.camera, scene.size);  // throws before anything is written
  check_look(arguments, prepared);
  return prepared;
}

void place_camera(const RenderArguments& arguments, PreparedScene& prepared,
                  const CameraFraming& frame) {
  Scene& scene = prepared.scene;
  if (arguments.azimuth || arguments.elevation) {
    turn_camera(scene.camera, arguments.azimuth.value_or(0), arguments.elevation.value_or(0));
  }
  if (!prepared.has_own_camera || !arguments.view.empty()) scene.camera = frame(scene);
  if (arguments.zoom) zoom_camera(scene.camera, *arguments.zoom);
  make_camera_frame(scene.camera, scene.size);
  prepared.description.camera = scene.camera;
  light_look(arguments, prepared);
}

PreparedScene prepare(const RenderArguments& arguments,
                      const std::function<void(SceneRequest&)>& change) {
  SceneRequest request = request_scene(arguments);
  const ParallelFor parallel =
      parallel_for(arguments.threads > 0 ? arguments.threads : default_thread_count());
  // The viewer does not wait for it.
  if (!arguments.suggests_functions) choose_from_steps(request, parallel);
  if (change) change(request);
  std::vector<MeshSource> meshes;
  const std::vector<std::optional<Layer>> loaded = std::move(request.loaded);
  Scene scene = remake_scene(request.description, loaded, parallel, &meshes);
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    if (loaded[i]) request.prepared.quick_layers.push_back(i);
  }
  return complete_scene(arguments, std::move(request), std::move(scene), meshes,
                        [&](const Scene& whole) { return visible_corners(whole, parallel); });
}

}  // namespace pellucid::cli
