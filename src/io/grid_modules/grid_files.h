// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "volumes/components.h"

namespace pellucid {

/// Datasets of HDF5 (.h5, .hdf5, .he5) and variables of NetCDF (.nc, .nc4, .cdf) of three axes, or
/// of four, of which one are components: of HDF5 as array_axes() has them, of NetCDF the first.
VolumeFile open_hdf5(const std::filesystem::path& path, const ReadOptions& options);
VolumeFile open_net_cdf(const std::filesystem::path& path, const ReadOptions& options);
/// Grids of OpenVDB (.vdb) as dense ones of their active box, what is not active by its value as
/// well: the background. Vectors are components. Level sets, staggered grids, points, and grids
/// that no affine map places are refused.
VolumeFile open_vdb(const std::filesystem::path& path, const ReadOptions& options);
std::vector<VolumeArray> list_hdf5_arrays(const std::filesystem::path& path,
                                          const ReadOptions& options);
std::vector<VolumeArray> list_net_cdf_arrays(const std::filesystem::path& path);
std::vector<VolumeArray> list_vdb_arrays(const std::filesystem::path& path);

}  // namespace pellucid
