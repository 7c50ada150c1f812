// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Makes a field that needs no file: point-centred floats at `points`³ positions of the box
/// [-1,1]³, the first at (-1,-1,-1), spacing 2/(points-1). With r = √(x²+y²+z²):
///
///   marschner_lobb  [(1 − sin(πz/2)) + ¼(1 + cos(12π cos(π√(x²+y²)/2)))] / 2.5, in [0, 1]
///                   (Marschner and Lobb 1994, α = ¼, f = 6)
///   hydrogen        |ψ|² of the 4d_z² orbital: [(12 − σ)(3ζ² − σ²) e^(−σ/4)]²,
///                   (ξ,η,ζ) = 40 (x,y,z) in Bohr radii, σ = 40 r; divided by its largest value,
///                   which lies on the z axis at σ = 12 − √48. Below 0.002 on the faces of the box
///   shells          four spherical shells of radius 0.9, 0.7, 0.5, 0.3 with the values ¼, ½, ¾, 1
///                   from outside to inside, 0 between them; each has one round opening
///                   (shells are 0.1 thick and alias below 64 points)
///   sphere          1 − r
///   ramp            x
///   constant        1
///
/// Throws Error if the name is unknown, `points` is not in [2, 2048], or memory does not suffice.
Volume make_builtin_field(std::string_view name, int points);
/// Returns the names that make_builtin_field() accepts.
const std::vector<std::string_view>& builtin_field_names();

}  // namespace pellucid
