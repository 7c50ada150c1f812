// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/field/tetrahedra.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Fills Tetrahedron::behind: the two faces of the same three points lie behind each other. The
/// corners of each tetrahedron are in ascending order. Returns the number of a tetrahedron with a
/// face that belongs to more than two; -1: there is none.
///
/// Faces are sorted into buckets by the smallest of their points, of which each has about two
/// dozen.
std::int32_t pair_faces(std::vector<Tetrahedron>& tetrahedra, std::size_t points,
                        const ParallelFor& parallel);

}  // namespace pellucid
