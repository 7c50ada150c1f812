// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"

namespace pellucid::view {

/// A scene to be shown.
struct ViewedScene {
  SceneDescription description;  ///< complete
  Scene scene;
  /// Tells whether the user chose the camera; else it is fitted to the window.
  bool keeps_camera = false;
  /// Layers whose Gaussians were suggested quickly. Better ones are fitted while the first picture
  /// is looked at.
  std::vector<std::size_t> quick_layers{};
  /// The description before it was completed, with what it leaves open; none: nothing. What is left
  /// to data with steps in time is chosen from all of them while the first picture is looked at.
  std::optional<SceneDescription> asked{};
};

/// Reads an input as the command line names it: a file, "builtin:NAME". Throws Error. Called by a
/// thread of the viewer.
using OpenInput = std::function<ViewedScene(const std::string& input)>;

struct ViewerOptions {
  std::uint16_t port = 0;       ///< 0: any that is free
  bool ends_with_page = false;  ///< end when the last page is closed
  int threads = 0;              ///< 0: one per core
  /// Pages of others that may show this one in a frame: sources of a Content Security Policy, such
  /// as "http://localhost:*". Empty: none may.
  std::string frame_ancestors{};
  /// Called with the scene after each change of a page, by a thread of the viewer; may be empty.
  std::function<void(const SceneDescription&, const Scene&)> changed{};
  /// Reads the files that are chosen or dropped on a page. Empty: none are.
  OpenInput open{};
  /// Largest number of bytes that are copied of dropped files.
  std::uint64_t upload_bytes = std::uint64_t(4) << 30;
};

/// Serves the page of a scene until `ended`, which is asked ten times a second, is true, or the
/// last page is closed. Without a scene the page asks for a file. `started` is called with the
/// address. Throws Error.
void run_viewer(std::optional<ViewedScene> scene, const ViewerOptions& options,
                const std::function<void(const std::string& address)>& started,
                const std::function<bool()>& ended);

}  // namespace pellucid::view
