// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "page_server.h"
#include "pellucid/io/color_bar.h"
#include "pellucid/io/scene_json.h"
#include "pellucid/scene/image.h"
#include "view/command.h"

namespace pellucid::view {

/// A file that a page offers for download.
struct SavedFile {
  std::string name, content_type, bytes;
};

/// Returns the message that gives a page a file.
PageMessage file_message(const SavedFile& file);

/// Returns the color bars of a scene. Throws Error if there are none, or they cannot be drawn.
std::vector<ColorBar> wanted_color_bars(const SceneDescription& description, const Scene& scene);
/// Returns a picture as the program writes it.
SavedFile png_file(const Image& image, const std::optional<Background>& background);
SavedFile exr_file(const Image& image);
/// Returns a layer's function and look in a format (ExportFunction); `notes` receives what the
/// format cannot hold. Throws Error.
SavedFile function_file(const LayerDescription& layer, const std::string& format,
                        std::vector<std::string>& notes);
/// Reads a function of our own or of another program. Throws Error.
LookDescription read_function(const ImportFunction& import, std::vector<std::string>& notes);

}  // namespace pellucid::view
