// SPDX-License-Identifier: Apache-2.0
#include "vtk_module.h"

#include "module.h"

namespace pellucid {

namespace {

#ifdef PELLUCID_HAVE_VTK
constexpr bool built = true;
#else
constexpr bool built = false;
#endif

constexpr Module vtk{"pellucid_vtk.so", "VTK's and Exodus files", built,
                     "VTK (Debian: libvtk9-dev) and -DPELLUCID_WITH_VTK=ON"};

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
