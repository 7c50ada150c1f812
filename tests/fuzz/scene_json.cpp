// SPDX-License-Identifier: Apache-2.0

// The parsers of scenes, transfer functions and cameras, and of Gaussians and channels on command
// lines: any bytes give a value or an Error of one line, and what was read is written and read
// again to the same text. Opens no file.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/error.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

/// Calls parse; where it refuses, the message must be one readable line.
template <class Parse>
void attempt(Parse&& parse) {
  try {
    parse();
  } catch (const pellucid::Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz: ") && message.size() < 2000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
}

/// The same of a parser whose messages do not begin with the name of a file.
template <class Parse>
void attempt_text(Parse&& parse) {
  attempt([&] {
    try {
      parse();
    } catch (const pellucid::Error& error) {
      throw pellucid::Error(std::string("fuzz: ") + error.what());
    }
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  attempt([&] {
    const pellucid::SceneDescription scene = pellucid::parse_scene(text, "fuzz", "folder");
    const std::string written = pellucid::scene_to_json(scene);
    require(pellucid::scene_to_json(pellucid::parse_scene(written, "again")) == written);
    // What is parsed can be made: every term finds its channels.
    for (const pellucid::LayerDescription& layer : scene.layers) {
      if (!layer.transfer_function) continue;
      const auto* function =
          std::get_if<pellucid::MultivariateDescription>(&*layer.transfer_function);
      if (function == nullptr) continue;
      pellucid::make_multivariate(*function,
                                  pellucid::channel_names(pellucid::layer_channels(layer)));
    }
  });
  attempt_text([&] { pellucid::parse_gaussian(text); });
  attempt_text([&] { pellucid::parse_channel_source(text); });
  attempt([&] {
    const pellucid::TransferFunctionDescription function =
        pellucid::parse_transfer_function(text, "fuzz");
    const std::string written = pellucid::transfer_function_to_json(function);
    const auto again = pellucid::parse_transfer_function(written, "again");
    require(pellucid::transfer_function_to_json(again) == written);
    // What is parsed can be made.
    if (const auto* table = std::get_if<pellucid::OpacityTable>(&function)) {
      pellucid::transfer_function_from_opacity_table(table->points, table->unit_distance,
                                                     pellucid::largest_relative_error);
    }
  });
  attempt([&] {
    const std::string written = pellucid::look_to_json(pellucid::parse_look(text, "fuzz"));
    require(pellucid::look_to_json(pellucid::parse_look(written, "again")) == written);
  });
  attempt([&] {
    const std::string written = pellucid::camera_to_json(pellucid::parse_camera(text, "fuzz"));
    require(pellucid::camera_to_json(pellucid::parse_camera(written, "again")) == written);
  });
  return 0;
}
