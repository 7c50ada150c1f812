// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/base/version.h"
#include "render.h"
#include "tolerance.h"

namespace pellucid::cli {

namespace {

std::string method_text(const RenderArguments& arguments, const Integration& integration) {
  return arguments.reference ? "reference" : std::string(method_name(integration.method));
}

std::string precision_text(const RenderArguments& arguments, const Integration& integration,
                           const RenderReport& report) {
  if (arguments.reference || integration.precision == Precision::float64) return "double";
  // The sampling methods know no tolerance: of them, packets alone are in float.
  if (integration.method != Method::exact) return report.sampled_in_float ? "float" : "double";
  return integration.precision == Precision::float32 ? "float" : "automatic";
}

std::string grade_text(Grade grade) {
  return grade == Grade::proved ? "proved" : "estimated";
}

double per_ray(std::uint64_t count, const RenderReport& report) {
  return report.rays > 0 ? static_cast<double>(count) / static_cast<double>(report.rays) : 0;
}

struct NamedCount {
  const char* name;
  std::uint64_t count;
};

std::vector<NamedCount> by_rule(const RuleCounts& spans) {
  return {{"skipped", spans.skipped}, {"constant", spans.constant}, {"strides", spans.strides},
          {"lines", spans.lines},     {"closed", spans.closed},     {"panels", spans.panels}};
}

bool has_step(const RenderArguments& arguments, const Scene& scene) {
  return !arguments.reference && scene.integration.method != Method::exact && !takes_cells(scene);
}

Json channel_json(const std::string& name, const std::string& unit, const VolumeData& values,
                  const VolumeStatistics& data) {
  return {{"name", name},
          {"unit", unit},
          {"type", type_name(values)},
          {"minimum", data.minimum},
          {"maximum", data.maximum},
          {"nan", data.nan}};
}

Json channels_json(const MeshChannels& mesh) {
  Json list = Json::array();
  for (int c = 0; c < mesh.count(); ++c) {
    list.push_back(channel_json(mesh[c].name, mesh[c].unit, mesh[c].values, mesh.statistics(c)));
  }
  return list;
}

Json mesh_json(const MeshChannels& mesh, const MeshSource& source) {
  const MeshStatistics& of_mesh = mesh.mesh().statistics();
  Json arrays = Json::array();
  for (const MeshArrayChoice& choice : source.channels) {
    arrays.push_back({{"array", choice.array},
                      {"component", choice.component ? Json(*choice.component) : Json()}});
  }
  return {{"points", of_mesh.points},
          {"tetrahedra", of_mesh.tetrahedra},
          {"flat", of_mesh.degenerate},
          {"folded_faces", of_mesh.folded_faces},
          {"overlapping_cells", of_mesh.overlapping_cells},
          {"vacuum", mesh.vacuum_count()},
          {"arrays", arrays}};
}

std::size_t nan_values(const Layer& layer) {
  std::size_t count = 0;
  if (const auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    for (int c = 0; c < mesh->mesh->count(); ++c) count += mesh->mesh->statistics(c).nan;
  } else if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    for (const Channel& channel : *channels->channels) count += channel.volume->statistics().nan;
  } else {
    count = grid_of(layer)->statistics().nan;
  }
  return count;
}

Json channels_json(const Channels& channels) {
  Json list = Json::array();
  for (const Channel& channel : channels) {
    list.push_back(channel_json(channel.name, channel.unit, channel.volume->data(),
                                channel.volume->statistics()));
  }
  return list;
}

const char* kind_of(const Layer& layer) {
  if (std::holds_alternative<MeshContent>(layer.content)) return "mesh";
  if (std::holds_alternative<ChannelsContent>(layer.content)) return "channels";
  return std::holds_alternative<LabelContent>(layer.content) ? "labels" : "field";
}

Json layer_json(const Layer& layer, const LayerDescription& description) {
  const Volume* const grid = grid_of(layer);
  const auto* const mesh = std::get_if<MeshContent>(&layer.content);
  const auto* const channels = std::get_if<ChannelsContent>(&layer.content);
  Json json;
  json["name"] = layer.name;
  json["kind"] = kind_of(layer);
  json["visible"] = layer.visible;
  json["dimensions"] = grid != nullptr ? dimensions_json(*grid) : Json();
  json["type"] = type_name(grid != nullptr ? grid->data() : (*mesh->mesh)[0].values);
  json["mesh"] = mesh != nullptr ? mesh_json(*mesh->mesh, *description.mesh) : Json();
  json["channels"] = mesh != nullptr       ? channels_json(*mesh->mesh)
                     : channels != nullptr ? channels_json(*channels->channels)
                                           : Json();
  json["nan"] = nan_values(layer);
  json["clips"] = layer.clips.size();
  json["projection"] =
      layer.projection ? Json(std::string(projection_name(*layer.projection))) : Json();
  Json look = Json::parse(layer_look_to_json(description));
  for (const char* const key : {"shading", "gradient_opacity"}) {
    json[key] = look.contains(key) ? look[key] : Json();
  }
  for (const char* const key : {"isosurfaces", "slices"}) {
    json[key] = look.contains(key) ? look[key] : Json::array();
  }
  json["transfer_function"] =
      description.transfer_function
          ? Json::parse(transfer_function_to_json(*description.transfer_function))
          : Json();
  return json;
}

}  // namespace

std::size_t nan_values(const PreparedScene& prepared) {
  std::size_t count = 0;
  for (const Layer& layer : prepared.scene.layers) count += nan_values(layer);
  if (prepared.whole_layers.empty()) return count;
  count = 0;
  for (const PreparedScene::WholeLayer& layer : prepared.whole_layers) count += layer.nan;
  return count;
}

void add_metadata(const RenderArguments& arguments, const PreparedScene& prepared,
                  const RenderReport& report, Image& image) {
  const Integration& integration = prepared.scene.integration;
  auto& metadata = image.metadata;
  metadata["pellucid.version"] = PELLUCID_VERSION_STRING;
  metadata["pellucid.source"] = source_text(arguments);
  metadata["pellucid.method"] = method_text(arguments, integration);
  metadata["pellucid.precision"] = precision_text(arguments, integration, report);
  if (const double error = approximation_error(prepared.scene); error > 0) {
    metadata["pellucid.transfer_function_error"] = fmt::format("{}", error);
  }
  metadata["pellucid.samples"] = fmt::format("{}", prepared.scene.samples);
  if (has_step(arguments, prepared.scene)) {
    metadata["pellucid.step"] = fmt::format("{}", integration.step);
  }
  if (prepared.knows_its_error(arguments)) {
    metadata["pellucid.tolerance"] = fmt::format("{}", integration.tolerance);
    if (const auto& share = integration.relative_tolerance) {
      metadata["pellucid.relative_tolerance"] = fmt::format("{}", *share);
    }
    metadata["pellucid.grade"] = grade_text(integration.grade);
    metadata["pellucid.largest_error"] = fmt::format("{}", report.largest_error);
    metadata["pellucid.pixels_proved"] = fmt::format("{}", report.pixels_proved);
    metadata["pellucid.pixels_over"] = fmt::format("{}", report.pixels_over_tolerance);
  }
  // Of the first layer, and of each other one with its number behind.
  const std::vector<LayerDescription>& layers = prepared.description.layers;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (layers[i].projection) {
      metadata[i == 0 ? "pellucid.projection" : fmt::format("pellucid.projection.{}", i + 1)] =
          projection_name(*layers[i].projection);
    }
    const Json look = Json::parse(layer_look_to_json(layers[i]));
    for (const auto& [key, value] : look.items()) {
      metadata["pellucid." + key + (i == 0 ? "" : fmt::format(".{}", i + 1))] = value.dump();
    }
    if (!layers[i].transfer_function) continue;
    metadata[i == 0 ? "pellucid.transfer_function"
                    : fmt::format("pellucid.transfer_function.{}", i + 1)] =
        transfer_function_to_json(*layers[i].transfer_function);
  }
  if (std::ranges::any_of(layers, [](const auto& layer) { return layer.shading.has_value(); })) {
    metadata["pellucid.lights"] = lights_to_json(prepared.description.lights);
  }
  metadata["pellucid.camera"] = camera_to_json(prepared.scene.camera);
}

Image depth_picture(const Image& image) {
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  for (const float depth : image.depth) {
    if (!std::isfinite(depth)) continue;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  Image picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.pixels.resize(image.pixels.size());
  const float range = farthest > nearest ? farthest - nearest : 1;
  for (std::size_t p = 0; p < picture.pixels.size(); ++p) {
    if (!std::isfinite(image.depth[p])) continue;
    const float grey = std::clamp((farthest - image.depth[p]) / range, 0.0F, 1.0F);
    picture.pixels[p] = {grey, grey, grey, 1};
  }
  return picture;
}

std::vector<std::string> report_lines(const RenderArguments& arguments,
                                      const PreparedScene& prepared, const RenderReport& report) {
  const Scene& scene = prepared.scene;
  const std::string time = fmt::format("{:.3g} s", report.seconds);
  const double table = approximation_error(scene);
  const std::string table_text =
      table > 0 ? fmt::format(" (opacity table: within {:.2g})", table) : "";
  if (arguments.reference) {
    return {fmt::format("adaptive quadrature to 1e-12{}, {:.1f} cells per ray, {}", table_text,
                        per_ray(report.cells, report), time)};
  }
  if (!prepared.knows_its_error(arguments)) {
    std::vector<std::string> lines{fmt::format(
        "method {}, {:.1f} samples per ray, {}; its error is not known ('pellucid compare' "
        "measures it)",
        method_name(scene.integration.method), per_ray(report.cells, report), time)};
    if (!report.device.empty()) lines.push_back(report.device);
    return lines;
  }
  std::vector<std::string> lines;
  lines.push_back(fmt::format(
      "largest error of a pixel {}{}, tolerance {:.3g} (grade {}); proved for {} of the pixels",
      std::isfinite(report.largest_error) ? fmt::format("{:.3g}", report.largest_error) : "unknown",
      table_text, scene.integration.tolerance, grade_text(scene.integration.grade),
      share_text(report.pixels_proved, report.pixels)));
  if (report.pixels_interpolated > 0) {
    lines.back() += fmt::format(", {} interpolated between rays",
                                share_text(report.pixels_interpolated, report.pixels));
  }
  if (!arguments.verbose) {
    lines.back() += ", " + time;
    if (!report.device.empty()) lines.push_back(report.device);
    return lines;
  }
  std::uint64_t spans = 0;
  for (const NamedCount& rule : by_rule(report.spans)) spans += rule.count;
  std::string line = fmt::format("{:.1f} field evaluations per ray, {}",
                                 per_ray(report.evaluations, report), time);
  const char* separator = "; spans: ";
  for (const NamedCount& rule : by_rule(report.spans)) {
    if (rule.count == 0) continue;
    line += fmt::format("{}{} {}", separator, share_text(rule.count, spans), rule.name);
    separator = ", ";
  }
  if (report.spans.in_double > 0) {
    line += fmt::format(" ({} in double)", share_text(report.spans.in_double, spans));
  }
  lines.push_back(line);
  if (!report.device.empty()) lines.push_back(report.device);
  return lines;
}

Json report_json(const RenderArguments& arguments, const PreparedScene& prepared,
                 const RenderedPicture& picture, double largest,
                 const std::vector<std::string>& written) {
  const Scene& scene = prepared.scene;
  const RenderReport& report = picture.report;
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["input"] = source_text(arguments);
  json["layers"] = Json::array();
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    Json layer = layer_json(scene.layers[i], prepared.description.layers[i]);
    if (!prepared.whole_layers.empty()) {
      const PreparedScene::WholeLayer& whole = prepared.whole_layers[i];
      if (!layer["dimensions"].is_null()) layer["dimensions"] = whole.dimensions;
      layer["nan"] = whole.nan;
    }
    json["layers"].push_back(std::move(layer));
  }
  // Of a single layer the program has always told here.
  const bool one = scene.layers.size() == 1;
  for (const char* const key : {"dimensions", "type", "mesh", "channels", "transfer_function"}) {
    json[key] = one ? json["layers"][0][key] : Json();
  }
  json["lights"] = Json::parse(lights_to_json(prepared.description.lights));
  json["nan"] = nan_values(prepared);
  json["labels"] = Json::object();
  for (const auto& [channel, count] : prepared.labels) json["labels"][channel] = count;
  json["size"] = {scene.size.width, scene.size.height};
  json["method"] = method_text(arguments, scene.integration);
  json["step"] = has_step(arguments, scene) ? Json(scene.integration.step) : Json();
  json["precision"] = precision_text(arguments, scene.integration, report);
  json["samples"] = scene.samples;
  const bool exact = prepared.knows_its_error(arguments);
  const auto of_exact = [&](const Json& value) { return exact ? value : Json(); };
  json["tolerance_asked"] = of_exact(prepared.tolerance_asked);
  json["tolerance"] = of_exact(scene.integration.tolerance);
  const auto& share = scene.integration.relative_tolerance;
  json["relative_tolerance"] = of_exact(share ? Json(*share) : Json());
  json["largest_channel"] = largest;
  json["below_tolerance"] = of_exact(largest <= scene.integration.tolerance);
  json["grade"] = of_exact(grade_text(scene.integration.grade));
  json["largest_error"] = of_exact(report.largest_error);
  json["pixels"] = scene.size.width * static_cast<std::int64_t>(scene.size.height);
  json["pixels_proved"] = of_exact(report.pixels_proved);
  json["pixels_over"] = of_exact(report.pixels_over_tolerance);
  json["pixels_between"] = of_exact(report.pixels_interpolated);
  json["threads"] = report.threads;
  json["device"] = report.device.empty() ? Json("rendered by the CPU") : Json(report.device);
  json["seconds"] = report.seconds;
  json["rays"] = report.rays;
  json["cells"] = report.cells;
  json["evaluations"] = of_exact(report.evaluations);
  json["evaluations_per_ray"] = of_exact(per_ray(report.evaluations, report));
  Json spans;
  for (const NamedCount& rule : by_rule(report.spans)) spans[rule.name] = rule.count;
  spans["in_double"] = report.spans.in_double;
  json["spans"] = of_exact(spans);
  json["transfer_function_from"] = prepared.transfer_function_from;
  json["transfer_function_error"] = approximation_error(scene);
  json["camera"] = Json::parse(camera_to_json(scene.camera));
  if (!picture.ranks_json.empty()) json["ranks"] = Json::parse(picture.ranks_json);
  json["outputs"] = written;
  return json;
}

}  // namespace pellucid::cli
