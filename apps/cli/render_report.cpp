// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/base/version.h"
#include "render.h"

namespace pellucid::cli {

namespace {

std::string method_text(const RenderArguments& arguments, const Integration& integration) {
  return arguments.reference ? "reference" : std::string(method_name(integration.method));
}

std::string precision_text(const RenderArguments& arguments, const Integration& integration) {
  return arguments.reference || integration.precision == Precision::float64 ? "double" : "float";
}

bool has_step(const RenderArguments& arguments, const Integration& integration) {
  return !arguments.reference && integration.method != Method::exact;
}

}  // namespace

void add_metadata(const RenderArguments& arguments, const PreparedScene& prepared, Image& image) {
  const Integration& integration = prepared.scene.integration;
  auto& metadata = image.metadata;
  metadata["pellucid.version"] = PELLUCID_VERSION_STRING;
  metadata["pellucid.source"] = arguments.input;
  metadata["pellucid.method"] = method_text(arguments, integration);
  metadata["pellucid.precision"] = precision_text(arguments, integration);
  if (has_step(arguments, integration))
    metadata["pellucid.step"] = fmt::format("{}", integration.step);
  metadata["pellucid.transfer_function"] =
      transfer_function_to_json(*prepared.scene.transfer_function);
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

Json report_json(const RenderArguments& arguments, const PreparedScene& prepared,
                 const RenderReport& report, const std::vector<std::string>& written) {
  const Scene& scene = prepared.scene;
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["input"] = arguments.input;
  json["dimensions"] = dimensions_json(*scene.volume);
  json["type"] = type_name(scene.volume->data());
  json["nan"] = scene.volume->statistics().nan;
  json["size"] = {scene.size.width, scene.size.height};
  json["method"] = method_text(arguments, scene.integration);
  json["step"] = has_step(arguments, scene.integration) ? Json(scene.integration.step) : Json();
  json["precision"] = precision_text(arguments, scene.integration);
  json["threads"] = report.threads;
  json["seconds"] = report.seconds;
  json["rays"] = report.rays;
  json["cells"] = report.cells;
  json["transfer_function_from"] = prepared.transfer_function_from;
  json["transfer_function"] = Json::parse(transfer_function_to_json(*scene.transfer_function));
  json["camera"] = Json::parse(camera_to_json(scene.camera));
  json["outputs"] = written;
  return json;
}

}  // namespace pellucid::cli
