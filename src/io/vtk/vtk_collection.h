// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pellucid {

/// Returns whether a file of VTK's lists others (.vtm, .vtmb, .pvd) of which one is an image or a
/// rectilinear grid, or is adaptive (.vthb, .vth, also .vtm): then it is no mesh.
bool is_image_collection(const std::filesystem::path& path);

/// A file of a list, and its time.
struct ListedStep {
  double time = 0;
  std::string file;  ///< name in the list
};

/// Returns the files of a list by time (.pvd), ascending by time. A file without a time has 0.
/// Throws Error, without the list's name, where it is damaged.
std::vector<ListedStep> steps_of_list(const std::filesystem::path& path);

}  // namespace pellucid
