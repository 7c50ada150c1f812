// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "pellucid/scene/tetrahedralize.h"

namespace pellucid {

/// Cuts a step in time of a mesh, as cut_into_tetrahedra() does, and keeps beside its tetrahedra
/// what finds the points and cells of another step equal. If those of `before`, which this function
/// returned, are equal to the bit, its tetrahedra are taken, with faces and neighbors: values alone
/// are new. `before` may be null. Throws Error as cut_into_tetrahedra() does.
std::shared_ptr<const MeshChannels> tetrahedralize_step(UnstructuredGrid grid,
                                                        std::span<const MeshArrayChoice> choices,
                                                        const MeshChannels* before,
                                                        const ParallelFor& parallel = {});

}  // namespace pellucid
