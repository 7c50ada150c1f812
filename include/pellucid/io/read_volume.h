// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// What a headerless file does not say, and what may be said instead of the file.
struct ReadOptions {
  std::optional<std::array<int, 3>> dimensions;  ///< raw: required
  std::optional<std::string> type;               ///< raw: required ("u8" … "f64")
  std::optional<bool> big_endian;                ///< raw; default little
  std::size_t skip_bytes = 0;                    ///< raw: header to skip
  std::optional<Vec3<double>> spacing;           ///< replaces the file's
  std::optional<Vec3<double>> origin;            ///< replaces the file's
  std::optional<Centering> centering;            ///< replaces the file's
  std::optional<int> components;                 ///< raw: numbers at each point, side by side
  std::optional<int> component;                  ///< which of a file's, from 0
  /// In place of a component, the step nearest to it: NetCDF, OME-Zarr.
  std::optional<double> time;
  std::optional<std::string> array;  ///< by name, of a file that has several; none: see VolumeArray
  std::optional<int> level;          ///< OME-Zarr: the resolution, 0 (default) the finest
  /// DICOM: which of a folder's series: its number as list_dicom_series() has them, from 1, its
  /// UID, or the unique end of one.
  std::optional<std::string> series;
  /// Is told, a line each, what is assumed where files do not say it, and what is left out.
  std::function<void(const std::string&)> note;
};

/// Reads a volume by its extension: .nii .nii.gz .hdr/.img(.gz) .nrrd .nhdr .mha .mhd (through ITK,
/// where the build has it), .npy, .slc, .raw, .mrc .map .rec .st .ccp4 (each also .gz), .dcm .ima;
/// a .dat or .ivf header of Inviwo's or Voreen's; a stack of images, .tif .tiff .png, by any of its
/// files, a pattern of them ("slice%03d.tif") or its folder; a DICOM series by its folder or any of
/// its files, of any name; any file as raw where dimensions and type are both given; and images and
/// rectilinear grids of VTK's by their first bytes (.vti, .pvti, .vtr, .pvtr, legacy .vtk; through
/// VTK, where the build has it): arrays of points are point-centred, arrays of cells cell-centred,
/// whole numbers of 64 bits become double, bits u8; datasets of HDF5 (.h5, .hdf5, .he5) and
/// variables of NetCDF (.nc, .nc4, .cdf), where the build has these: of NetCDF positions along the
/// axes where it has them, scaled, and NaN for what is missing; fog volumes of OpenVDB (.vdb) as
/// the dense grid of their active box, where the build has it; stores of Zarr and OME-Zarr by their
/// folder; data sets of vtk.js by their folder or its index.json; Voreen's .vvd. Throws Error:
/// what, where, what to do; also for a file of several components of which the options choose none.
Volume read_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// A file may have several numbers at each point, its components: colors and vectors, the steps of
/// a fourth axis, and of .npy the last of four axes. This is how many, by its header. Throws Error
/// like read_volume.
int component_count(const std::filesystem::path& path, const ReadOptions& options = {});
/// Each component as a volume of its own, in the file's type and on its one grid; the chosen one
/// alone where the options choose. Throws Error like read_volume.
std::vector<Volume> read_components(const std::filesystem::path& path,
                                    const ReadOptions& options = {});

/// The same, with the name of the array that they are of; empty where the format has no names.
struct NamedComponents {
  std::string array;
  std::vector<Volume> components;
};
NamedComponents read_named_components(const std::filesystem::path& path,
                                      const ReadOptions& options = {});

/// What a file has under one name.
struct VolumeArray {
  std::string name;
  Centering centering = Centering::point;
  std::string type;             ///< as it is read: "u8" … "f64"
  std::vector<int> dimensions;  ///< data values along x, y, z
  std::vector<VolumeStatistics> components;
  int more_components = 0;        ///< not looked at: beyond the 64 that are, each of which is read
  std::string unreadable_reason;  ///< why it is not; empty: it is
  /// Read where no array is chosen: the one that the file marks as its scalars, else the first of
  /// points with one component, else the first.
  bool shown = false;
};
/// All arrays of a file in which they have names; none of other files. Reads all of their values.
/// Throws Error like read_volume.
std::vector<VolumeArray> list_arrays(const std::filesystem::path& path,
                                     const ReadOptions& options = {});
/// Whether the program reads files of this name as volumes with a header, which says of itself what
/// headerless data need to be told.
bool has_volume_header(std::string_view file_name);
/// Whether a .json file is read as a volume, as an index.json of vtk.js is: then it is no scene.
bool is_volume_json(const std::filesystem::path& path);
/// The extensions of volumes, for messages and help: ".nii .nii.gz …".
std::string volume_extensions();

/// The parsers of our own, from memory, so that they can be fuzzed. `name` is for messages.
Volume parse_npy(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options = {});
Volume parse_raw(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options);
Volume parse_slc(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options = {});

}  // namespace pellucid
