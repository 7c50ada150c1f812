// SPDX-License-Identifier: Apache-2.0

// In place of the other files of this folder where VTK is not installed.

#include "benchmarks/vtk/delaunay.h"
#include "benchmarks/vtk/segment_integrators.h"
#include "benchmarks/vtk/unstructured.h"
#include "benchmarks/vtk/vtk_contenders.h"

namespace pellucid::bench {

VtkContenders vtk_contenders(const Scene&, const std::vector<double>&, int) {
  return {{},
          "VTK was not found when this program was built; install libvtk9-dev and configure anew"};
}

std::string vtk_version() {
  return {};
}

bool has_delaunay() {
  return false;
}

std::vector<std::int32_t> delaunay_tetrahedra(const std::vector<Vec3<double>>&) {
  return {};
}

struct VtkMesh {};

std::shared_ptr<VtkMesh> vtk_mesh(const UnstructuredGrid&, const Box<double>&) {
  return nullptr;
}

std::vector<MeshContender> vtk_mesh_contenders(const std::shared_ptr<VtkMesh>&, const MeshScene&) {
  return {};
}

std::vector<SegmentIntegrator> vtk_segment_integrators() {
  return {};
}

}  // namespace pellucid::bench
