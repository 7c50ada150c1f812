// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"

namespace pellucid::view {

struct ViewerOptions {
  std::uint16_t port = 0;       ///< 0: any that is free
  bool ends_with_page = false;  ///< end when the last page is closed
  int threads = 0;              ///< 0: one per core
  bool keeps_camera =
      false;  ///< whether the user chose the camera; else it is fitted to the window
  /// Layers whose Gaussians were suggested quickly. Better ones are fitted while the first picture
  /// is looked at.
  std::vector<std::size_t> quick_layers{};
  /// Pages of others that may show this one in a frame: sources of a Content Security Policy, such
  /// as "http://localhost:*". Empty: none may.
  std::string frame_ancestors{};
  /// Called with the scene after each change of a page, by a thread of the viewer; may be empty.
  std::function<void(const SceneDescription&, const Scene&)> changed{};
};

/// Serves the page of a scene until `ended`, which is asked ten times a second, is true, or the
/// last page is closed. `started` is called with the address. The description is complete. Throws
/// Error.
void run_viewer(SceneDescription description, Scene scene, const ViewerOptions& options,
                const std::function<void(const std::string& address)>& started,
                const std::function<bool()>& ended);

}  // namespace pellucid::view
