// SPDX-License-Identifier: Apache-2.0
#include "vtk_module.h"

#include <algorithm>

#include "files/memory_limit.h"
#include "pellucid/io/internal/module.h"

namespace pellucid {

namespace {

constexpr Module vtk{"pellucid_vtk.so", "reads VTK's and Exodus files",
                     "VTK (Debian: libvtk9-dev)"};

}  // namespace

ReadWithVtk& vtk_module() {
  static auto* const function =
      reinterpret_cast<ReadWithVtk*>(module_function(vtk, read_with_vtk_name));
  return *function;
}

ReadVolumeWithVtk& vtk_volume_module() {
  static auto* const function =
      reinterpret_cast<ReadVolumeWithVtk*>(module_function(vtk, read_volume_with_vtk_name));
  return *function;
}

ReadExodusTimes& exodus_times_module() {
  static auto* const function =
      reinterpret_cast<ReadExodusTimes*>(module_function(vtk, read_exodus_times_name));
  return *function;
}

void check_vtk_module() {
  module_file(vtk);
}

std::uintmax_t memory_for_vtk(std::uintmax_t file_bytes) {
  // Deflate packs a thousand bytes into one at most; VTK and we have two copies each.
  constexpr std::uintmax_t for_any = std::uintmax_t{1} << 30, per_file_byte = 4096;
  return std::min(for_any + per_file_byte * file_bytes, memory_limit().bytes);
}

}  // namespace pellucid
