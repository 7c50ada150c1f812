// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>

#include "benchmarks/support/document.h"
#include "pellucid/cpu/renderer.h"
#include "tests/cuda/device_examples.h"
#include "tests/device_check/parts.h"
#include "tests/device_check/rows.h"
#include "tests/scenes/peers.h"

namespace pellucid::device_check {
namespace {

/// Returns a hash of all numbers of an image (FNV-1a).
std::uint64_t hash_of(const Image& image) {
  std::uint64_t state = 0xcbf29ce484222325u;
  const auto add = [&](const auto& numbers) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(numbers.data());
    for (std::size_t i = 0; i < numbers.size() * sizeof(numbers[0]); ++i) {
      state = (state ^ bytes[i]) * 0x100000001b3u;
    }
  };
  add(image.pixels);
  add(image.depth);
  add(image.error);
  add(image.proved);
  return state;
}

std::vector<scenes::NamedScene> scenes_of(const Arguments& arguments) {
  std::vector<scenes::NamedScene> list;
  for (scenes::DeviceExample& example : scenes::device_examples(arguments.size)) {
    list.push_back({example.name, std::move(example.scene)});
  }
  if (arguments.examples) return list;
  for (scenes::NamedScene& named :
       scenes::marschner_lobb_scenes(arguments.points, {arguments.size, arguments.size})) {
    if (named.name.ends_with("oblique")) list.push_back(std::move(named));
  }
  return list;
}

/// Returns the hashes that another run wrote, by scene.
std::map<std::string, std::string> hashes_of(const std::filesystem::path& file) {
  std::map<std::string, std::string> hashes;
  for (const Json& row : read_rows(file)) {
    if (row.value("kind", "") == "frame") hashes[row.at("scene")] = row.at("bits");
  }
  if (hashes.empty()) throw Error("the first run has no frames");
  return hashes;
}

}  // namespace

bool check_frames(const Arguments& arguments) {
  std::map<std::string, std::string> first_run;
  if (!arguments.against.empty()) first_run = hashes_of(arguments.against);
  RowWriter rows(arguments.rows);
  bool good = true;
  for (const auto& [name, scene] : scenes_of(arguments)) {
    RenderOptions options;
    options.machine.device = arguments.device;
    options.machine.threads = arguments.threads;
    options.outputs.error = options.outputs.depth = true;
    Renderer renderer;
    const auto [image, report] = renderer.render(scene, options);
    const std::uint64_t first = hash_of(image);
    const std::uint64_t again = hash_of(renderer.render(scene, options).image);
    const std::uint64_t anew = hash_of(Renderer().render(scene, options).image);
    const std::string bits = bench::format("%016llx", static_cast<unsigned long long>(first));
    Json row{{"kind", "frame"},
             {"scene", name},
             {"bits", bits},
             {"pixels", report.pixels},
             {"on_device", !report.device.starts_with("rendered by the CPU")},
             {"same_again", again == first && anew == first}};
    if (!arguments.against.empty()) {
      const auto found = first_run.find(name);
      // A first run that was cut off has not all scenes.
      if (found != first_run.end()) row["same_as_first_run"] = found->second == bits;
    }
    for (const char* const promise : {"on_device", "same_again", "same_as_first_run"}) {
      if (row.value(promise, true)) continue;
      good = false;
      std::printf("%s: not %s\n", name.c_str(), promise);
    }
    rows.add(row);
  }
  return good;
}

}  // namespace pellucid::device_check
