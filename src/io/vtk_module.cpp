// SPDX-License-Identifier: Apache-2.0
#include "vtk_module.h"

#include "pellucid/io/module.h"

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

}  // namespace pellucid
