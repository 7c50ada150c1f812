// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <string>

#include "grid_modules/grid_module.h"

namespace pellucid {

/// Returns whether a file of HDF5 is one of Imaris, whatever its name.
bool is_imaris(hid_t file);

/// Lists its levels of resolution, the finest first, each an array whose components are channels
/// and steps in time. Throws Error for channels and steps that differ in size or type.
void list_imaris(hid_t file, GridContents& contents);

/// Reads values of a level by its name.
void read_imaris(hid_t file, const std::string& name, ComponentRange range, GridValues& values);

}  // namespace pellucid
