// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/scene/volume.h"

class vtkDataArray;

namespace pellucid {

/// Returns all values of an array, its components side by side: in place, owned together with VTK,
/// where there is such a type here; bits as u8, whole numbers of 64 bits in the smallest type that
/// holds all of them, else rounded to double, of which `rounded` is told how many.
VolumeData values_in_place(vtkDataArray& array, std::string& rounded);

}  // namespace pellucid
