// SPDX-License-Identifier: Apache-2.0
#include "hdf5_format.h"

#include "grid_modules/grid_files.h"

namespace pellucid {

namespace {

constexpr GridFormat hdf5{{"pellucid_hdf5.so", "reads HDF5 files", "HDF5 (Debian: libhdf5-dev)"},
                          "array of three or four axes of numbers"};

}  // namespace

const VolumeFormat hdf5_format{
    .name = "HDF5",
    .extensions = ".h5 .hdf5 .he5 .ims",  // the last is Imaris
    .open = [](const std::filesystem::path& path,
               const ReadOptions& options) { return open_grid(path, options, hdf5); },
    .list = [](const std::filesystem::path& path,
               const ReadOptions& options) { return list_grid_arrays(path, hdf5, options); },
    .takes_axes = true,
    .has_times = true};

}  // namespace pellucid
