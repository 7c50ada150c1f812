// SPDX-License-Identifier: Apache-2.0
#include "grid_modules/grid_files.h"
#include "vdb_size.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace {

constexpr GridFormat vdb{
    {"pellucid_openvdb.so", "reads OpenVDB files", "OpenVDB (Debian: libopenvdb-dev)"},
    "fog volume"};

}  // namespace

/// Grids as dense ones of their active box, what is not active by its value as well: the
/// background. Vectors are components. Level sets, staggered grids, points, and grids that no
/// affine map places are refused.
extern const VolumeFormat vdb_format{
    .name = "OpenVDB",
    .extensions = ".vdb",
    .open =
        [](const std::filesystem::path& path, const ReadOptions& options) {
          check_vdb_size(path);
          return open_grid(path, options, vdb);
        },
    .list =
        [](const std::filesystem::path& path, const ReadOptions&) {
          check_vdb_size(path);
          return list_grid_arrays(path, vdb, {});
        }};

}  // namespace pellucid
