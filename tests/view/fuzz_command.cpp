// SPDX-License-Identifier: Apache-2.0

// Messages of a page: any bytes give a command or an Error of one readable line. An edit that is
// read is also made in a small scene, which takes it or stays as it was.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "pellucid/scene/error.h"
#include "view/command.h"
#include "view/scene_state.h"

namespace {

using namespace pellucid;
using namespace pellucid::view;

void require(bool condition) {
  if (!condition) std::abort();
}

SceneState small_scene() {
  SceneDescription description = parse_scene(
      R"({"layers": [{"field": {"builtin": "sphere", "points": 4}, "transfer_function": {"points":
      [{"value": 0, "extinction": 1, "color": [1, 1, 1]}]}}], "image": {"width": 4, "height": 4}})",
      "fuzz");
  Scene scene = make_scene(description);
  description.camera = scene.camera;
  return {std::move(description), std::move(scene), {}};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::optional<Command> command;
  try {
    command = parse_command({reinterpret_cast<const char*>(data), size});
  } catch (const Error& error) {
    const std::string_view message = error.what();
    require(!message.empty() && message.size() < 1000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
    return 0;
  }
  const Edit* const edit = std::get_if<Edit>(&*command);
  if (edit == nullptr) return 0;
  SceneState state = small_scene();
  const std::string before = state.saved();
  try {
    state.edit(*edit);
    state.undo();
  } catch (const Error&) {
  }
  require(state.saved() == before);
  return 0;
}
