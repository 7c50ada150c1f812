// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "pellucid/geometry/vec3.h"

namespace pellucid::bench {

/// Whether the program was built with VTK, which finds them.
bool has_delaunay();

/// vtkDelaunay3D's tetrahedra, four indices of points each.
std::vector<std::int32_t> delaunay_tetrahedra(const std::vector<Vec3<double>>& points);

}  // namespace pellucid::bench
