// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/volume_format.h"

namespace pellucid {

/// Datasets of HDF5 of three axes, or of four, of which one are components, as array_axes() has
/// them.
extern const VolumeFormat hdf5_format;

}  // namespace pellucid
