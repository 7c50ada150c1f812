// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/device/speed.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "benchmarks/device/resample.h"
#include "benchmarks/device/turning.h"
#include "benchmarks/frames/reference_pixels.h"
#include "benchmarks/support/document.h"
#include "pellucid/cpu/threads.h"
#include "tests/scenes/real.h"
#include "tests/support/one_layer.h"

namespace pellucid::bench {
namespace {

bool is_wanted(const std::string& name, const std::vector<std::string>& parts) {
  const auto is_in_name = [&](const std::string& part) { return name.find(part) != name.npos; };
  return parts.empty() || std::ranges::any_of(parts, is_in_name);
}

/// Goes from coarse steps to fine ones.
void measure_sampler(Scene scene, const SpeedOptions& options, const ReferencePixels& reference,
                     Speed& speed) {
  constexpr double finest = 1.0 / 256;
  scene.integration = {};
  scene.integration.method = Method::midpoint;
  scene.integration.precision = Precision::float32;
  for (double step = 2; step >= finest; step /= 2) {
    scene.integration.step = step;
    Turning turning(scene, options.device, options.threads);
    const double error = error_of(turning.first().image, reference).largest;
    if (error > speed.exact_error && step > finest) continue;
    speed.step = step;
    speed.sampler_error = error;
    speed.sampler = turning.frames_per_second(options.frames, options.seconds);
    return;
  }
}

/// Returns the data of a scan at so many points.
scenes::VolumePointer resampled_scan(const scenes::VolumePointer& scan, int points) {
  const std::array<int, 3> cube{points, points, points};
  if (scan->description().dimensions == cube) return scan;
  return std::make_shared<const Volume>(resampled(*scan, points));
}

}  // namespace

Speed measure_speed(const scenes::NamedScene& named, const SpeedOptions& options,
                    const std::function<void(const Speed&)>& progress) {
  const Scene& scene = named.scene;
  Speed speed;
  const auto tell = [&] {
    if (progress) progress(speed);
  };
  speed.scene = named.name;
  speed.tolerance = scene.integration.tolerance;
  Turning turning(scene, options.device, options.threads);
  const RenderResult first = turning.first();
  const auto share = [&](std::uint64_t pixels) {
    return static_cast<double>(pixels) / static_cast<double>(first.report.pixels);
  };
  speed.device = first.report.device;
  speed.first = first.report.seconds;
  speed.in_double = share(first.report.pixels_in_double);
  speed.left = share(first.report.pixels_left);
  speed.exact = turning.frames_per_second(options.frames, options.seconds);
  tell();
  if (options.cpu) {
    speed.cpu = Turning(scene, Device::cpu, options.threads)
                    .frames_per_second(std::max(options.frames / 10, 2), options.seconds);
    tell();
  }
  const int threads = options.threads > 0 ? options.threads : default_thread_count();
  const ReferencePixels reference = reference_pixels(scene, options.pixels, threads, options.cache);
  speed.exact_error = error_of(first.image, reference).largest;
  tell();
  if (!scene.layers[0].shading) {
    measure_sampler(scene, options, reference, speed);
    tell();
  }
  return speed;
}

std::vector<scenes::NamedScene> speed_scenes(int points, ImageSize size,
                                             const std::vector<std::string>& parts,
                                             std::vector<std::string>& missing) {
  std::vector<scenes::NamedScene> result;
  const auto add = [&](scenes::NamedScene named) {
    scenes::NamedScene lit = named;
    lit.name += ", lit";
    lit.scene.layers[0].shading = Shading{};
    for (scenes::NamedScene* one : {&named, &lit}) {
      if (is_wanted(one->name, parts)) result.push_back(std::move(*one));
    }
  };
  const auto some_wanted = [&](std::initializer_list<const char*> names) {
    return std::ranges::any_of(names, [&](const std::string& name) {
      return is_wanted(name, parts) || is_wanted(name + ", lit", parts);
    });
  };
  if (some_wanted({"haze, oblique", "band, oblique", "spike, oblique"})) {
    for (scenes::NamedScene& named : scenes::marschner_lobb_scenes(points, size)) {
      if (named.name.ends_with("oblique")) add(std::move(named));
    }
  }
  for (const scenes::RealData& data : scenes::real_data()) {
    if (data.name != "bonsai" || !some_wanted({"bonsai, outside"})) continue;
    if (!std::filesystem::exists(data.file)) {
      missing.push_back(data.name);
      continue;
    }
    scenes::NamedScene named = scenes::real_scenes(data, size).front();
    scenes::VolumePointer& volume = test::volume_of(named.scene).volume;
    volume = resampled_scan(volume, points);
    add(std::move(named));
  }
  std::ranges::stable_partition(
      result, [](const scenes::NamedScene& named) { return !named.scene.layers[0].shading; });
  return result;
}

std::string speed_markdown(const std::vector<Speed>& rows) {
  std::string text =
      "| scene | exact: frames/s | first frame, s | error | again in double | sampler: frames/s | "
      "step | error | exact / sampler | CPU: frames/s "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n";
  const auto if_known = [](bool known, const std::string& number) {
    return (known ? number : std::string("–")) + " | ";
  };
  for (const Speed& row : rows) {
    const bool rendered = row.exact > 0, sampled = row.sampler > 0;
    std::string error = format("%.1e", row.exact_error);
    if (row.exact_error > row.tolerance) error = "**" + error + "**";
    text += "| " + row.scene + " | " + if_known(rendered, format("%.4g", row.exact)) +
            if_known(rendered, format("%.2f", row.first)) + if_known(row.exact_error >= 0, error) +
            if_known(rendered, format("%.1f %%", 100 * row.in_double)) +
            if_known(sampled, format("%.4g", row.sampler)) +
            if_known(sampled, format("%g", row.step)) +
            if_known(sampled, format("%.1e", row.sampler_error)) +
            if_known(sampled, format("%.3g", sampled ? row.exact / row.sampler : 0)) +
            if_known(row.cpu > 0, format("%.4g", row.cpu));
    text.back() = '\n';
  }
  for (const Speed& row : rows) text += "\n- " + row.scene + ": " + row.device;
  return text + "\n";
}

nlohmann::ordered_json to_json(const Speed& s) {
  // JSON has no infinity, which is the error of an image that is not finite.
  const auto finite = [](double error) {
    return std::min(error, std::numeric_limits<double>::max());
  };
  return {{"scene", s.scene},
          {"device", s.device},
          {"first_seconds", s.first},
          {"exact", s.exact},
          {"exact_error", finite(s.exact_error)},
          {"tolerance", s.tolerance},
          {"in_double", s.in_double},
          {"left", s.left},
          {"sampler", s.sampler},
          {"sampler_error", finite(s.sampler_error)},
          {"step", s.step},
          {"cpu", s.cpu}};
}

Speed speed_from_json(const nlohmann::ordered_json& json) {
  Speed s;
  json.at("scene").get_to(s.scene);
  json.at("device").get_to(s.device);
  json.at("first_seconds").get_to(s.first);
  json.at("exact").get_to(s.exact);
  json.at("exact_error").get_to(s.exact_error);
  json.at("tolerance").get_to(s.tolerance);
  json.at("in_double").get_to(s.in_double);
  json.at("left").get_to(s.left);
  json.at("sampler").get_to(s.sampler);
  json.at("sampler_error").get_to(s.sampler_error);
  json.at("step").get_to(s.step);
  json.at("cpu").get_to(s.cpu);
  return s;
}

}  // namespace pellucid::bench
