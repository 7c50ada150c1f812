// SPDX-License-Identifier: Apache-2.0
#include "files/input_file.h"
#include "grid_modules/grid_files.h"
#include "net_cdf_size.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace {

constexpr GridFormat net_cdf{
    {"pellucid_netcdf.so", "reads NetCDF files", "NetCDF (Debian: libnetcdf-dev)"},
    "array of three or four axes of numbers"};

}  // namespace

/// Variables of three axes, or of four, of which the first are components.
extern const VolumeFormat netcdf_format{
    .name = "NetCDF",
    .extensions = ".nc .nc4 .cdf",
    .open =
        [](const std::filesystem::path& path, const ReadOptions& options) {
          check_input_file(path);
          check_net_cdf_size(path);
          return open_grid(path, options, net_cdf);
        },
    .list =
        [](const std::filesystem::path& path, const ReadOptions&) {
          check_input_file(path);
          check_net_cdf_size(path);
          return list_grid_arrays(path, net_cdf, {});
        },
    .has_times = true};

}  // namespace pellucid
