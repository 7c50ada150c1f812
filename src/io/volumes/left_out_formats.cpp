// SPDX-License-Identifier: Apache-2.0
//
// Stands in for folders of formats that builds for WebAssembly leave out, where others ask them.
#include "vtk/vtk_collection.h"
#include "vtk/vtk_file_kind.h"
#include "zarr/zarr.h"

namespace pellucid {

bool is_zarr(const std::filesystem::path&) {
  return false;
}

bool VtkFileKind::is_volume() const {
  return false;
}

std::optional<VtkFileKind> vtk_file_kind(const std::filesystem::path&) {
  return std::nullopt;
}

bool is_image_collection(const std::filesystem::path&) {
  return false;
}

}  // namespace pellucid
