// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "command.h"
#include "pellucid/io/scene_json.h"
#include "pellucid/scene/image.h"

namespace pellucid::view {

/// A file that a page offers for download.
struct SavedFile {
  std::string name, content_type, bytes;
};

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
