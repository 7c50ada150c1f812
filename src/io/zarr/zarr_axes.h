// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "axes/axis_meaning.h"
#include "zarr_store.h"
#include "zarr_values.h"

namespace pellucid {

/// The axes of an array of a store: those of space, of components and of time.
struct ZarrAxes {
  ZarrView view;
  std::optional<std::size_t> time;
  std::optional<VolumeAxes> named;  ///< as xarray names them
};

/// Returns the axes by the names that OME-Zarr, Zarr 3 or xarray give them, else as the options
/// say, or guessed. Throws Error.
ZarrAxes zarr_axes(const ZarrChoice& choice, const std::string& name, const ReadOptions& options);
/// Throws Error where the names of an array's axes are those of no volume.
void check_zarr_axes(const std::filesystem::path& folder, const ZarrArray& array);

/// Returns the times of all steps along an axis, with their unit. Throws Error that begins with
/// `name` for too many.
AxisPositions zarr_times(const ZarrChoice& choice, std::size_t axis, const std::string& name);
/// Returns "2 times of 3 channels (DAPI, GFP, RFP)".
std::string zarr_holds(const ZarrChoice& choice, const ZarrAxes& axes);

}  // namespace pellucid
