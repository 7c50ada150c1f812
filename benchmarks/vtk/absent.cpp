// SPDX-License-Identifier: Apache-2.0

// In place of the other files of this folder where VTK is not installed.

#include "benchmarks/vtk/vtk_contenders.h"

namespace pellucid::bench {

VtkContenders vtk_contenders(const Scene&, const std::vector<double>&, int) {
  return {{},
          "VTK was not found when this program was built; install libvtk9-dev and configure anew"};
}

std::string vtk_version() {
  return {};
}

}  // namespace pellucid::bench
