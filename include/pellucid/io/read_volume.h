// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/io/time_between.h"
#include "pellucid/scene/sub_volume.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Properties that a file lacks, or that replace the file's own.
struct ReadOptions {
  std::optional<std::array<int, 3>> dimensions;  ///< raw: required
  std::optional<std::string> type;  ///< raw: required ("u8" … "f64", also "i64", "u64", "f16")
  std::optional<bool> big_endian;   ///< raw; default little
  std::size_t skip_bytes = 0;       ///< raw: header to skip
  std::optional<Vec3<double>> spacing;  ///< replaces the file's
  std::optional<Vec3<double>> origin;   ///< replaces the file's
  std::optional<Centering> centering;   ///< replaces the file's
  std::optional<int> components;        ///< raw: numbers at each point, side by side
  std::optional<int> component;         ///< component to read, from 0
  /// Component to read by the file's name of it, such as that of a channel; `component` goes first.
  std::optional<std::string> component_name;
  /// Files with steps in time (source_times()): reads the nearest step, not a component.
  std::optional<double> time;
  TimeBetween time_between = TimeBetween::nearest;  ///< needs a time
  std::optional<std::string> array;  ///< name of the array to read; none: see VolumeArray
  /// .npy, .npz, HDF5, and Zarr and tifffile's arrays that do not name their axes: a letter for
  /// each axis of the array, in the order of its indices: x, y and z, and c for components ("xyz",
  /// "czyx"). None: "zyx"; of four axes c is the first or the last, whichever is short, and `note`
  /// is told which was taken.
  std::optional<std::string> axes;
  std::optional<int> level;  ///< OME-Zarr: level of resolution, 0 is the finest; none: 0
  /// DICOM: series to read from a folder: its number as in list_dicom_series(), from 1, its UID, or
  /// a unique end of the UID. OME-TIFF: the image to read, by its number from 1 or its name.
  std::optional<std::string> series;
  /// Takes the description of the whole and returns the part that is wanted, which is read in its
  /// place. Uncompressed files are read there alone (VolumeOutline::reads_parts); of others the
  /// rest is let go of. Empty: all of it.
  std::function<IndexBox(const Volume::Description&)> part;
  /// Receives one line for each assumption about what the files do not say, and for each part that
  /// is left out.
  std::function<void(const std::string&)> note;
};

/// Description of a volume by its file's header.
struct VolumeOutline {
  Volume::Description description;
  bool reads_parts = false;  ///< whether a part is read without the rest (ReadOptions::part)
  std::string space;         ///< as world_space() returns it
};
/// Reads the header that read_volume() reads, and no values. Throws Error as it does.
VolumeOutline outline_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads a volume. The format follows from the extension (volume_extensions()), for VTK files from
/// the first bytes; docs/reference/command-line.md has the table of both. Beside files with an
/// extension these are read:
///
/// - stores of Zarr and OME-Zarr, and data sets of vtk.js, by their folder;
/// - DICOM: a series by its folder or any of its files, whatever their names;
/// - a stack of images: any of its files, a pattern ("slice%03d.tif") or the folder;
/// - any file as raw data if dimensions and type are both given.
///
/// Arrays of points of VTK's files are point-centred, arrays of cells cell-centred, and bits become
/// u8. NetCDF provides positions along the axes, scaled values, and NaN for missing ones. OpenVDB
/// gives the dense grid of the active box.
///
/// Half floats become float. Integers of 64 bits become the smallest type that holds each of them;
/// if only double is left and rounds some, `note` is told.
///
/// Throws Error: what, where, what to do; also for a file of several components or a .npz of
/// several arrays if the options select none.
Volume read_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// Returns the number of components per point, as the file's header says: colors, vectors, the
/// steps of a fourth axis. Throws Error like read_volume().
int component_count(const std::filesystem::path& path, const ReadOptions& options = {});
/// Reads each component as a volume, in the file's type and on its grid; only one if the options
/// select it. Throws Error like read_volume().
std::vector<Volume> read_components(const std::filesystem::path& path,
                                    const ReadOptions& options = {});

/// Components and the name of their array; the name is empty if the format has none.
struct NamedComponents {
  std::string array;
  std::vector<Volume> components;
};
/// Reads the same with the array's name. Throws Error like read_volume().
NamedComponents read_named_components(const std::filesystem::path& path,
                                      const ReadOptions& options = {});

/// A named array of a file.
struct VolumeArray {
  std::string name;
  Centering centering = Centering::point;
  std::string type;             ///< after reading: "u8" … "f64"
  std::vector<int> dimensions;  ///< data values along x, y, z
  std::vector<VolumeStatistics> components;
  int more_components = 0;        ///< components beyond the 64 that are read for the statistics
  std::string unreadable_reason;  ///< why it cannot be read; empty: it can
  /// True if it is read where none is selected: the array that the file marks as its scalars, else
  /// the first array of points with one component, else the first array.
  bool is_default = false;
};
/// Returns all arrays of a file whose format names them, else none. Reads all of their values.
/// Throws Error like read_volume().
std::vector<VolumeArray> list_arrays(const std::filesystem::path& path,
                                     const ReadOptions& options = {});
/// Returns whether files of this name are volumes with a header, which provides what headerless
/// data need as options.
bool has_volume_header(std::string_view file_name);
/// Returns the name of the space that the file places its volume in. "LPS": in a patient, x towards
/// left, y towards posterior, z towards superior, in mm; spaces of patients are turned to it. Other
/// names are the file's own ("scanner-xyz"). Empty: the file names none, or cannot be read.
std::string world_space(const std::filesystem::path& file, const ReadOptions& options = {});
/// Returns whether that space is LPS.
bool is_placed_in_lps(const std::filesystem::path& file, const ReadOptions& options = {});
/// Returns whether a .json file is a volume, such as an index.json of vtk.js, and not a scene.
bool is_volume_json(const std::filesystem::path& path);
/// Returns the extensions of volume files for messages and help: ".nii .nii.gz …".
std::string volume_extensions();

}  // namespace pellucid
