// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
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
  /// DICOM: which of a folder's series: its number as list_dicom_series() has them, from 1, its
  /// UID, or the unique end of one.
  std::optional<std::string> series;
  /// Is told, a line each, what is assumed where files do not say it, and what is left out.
  std::function<void(const std::string&)> note;
};

/// Reads a volume by its extension: .nii .nii.gz .hdr/.img(.gz) .nrrd .nhdr .mha .mhd (through ITK,
/// where the build has it), .npy, .raw, .mrc .map .rec .st .ccp4, .dcm .ima; a stack of images,
/// .tif .tiff .png, by any of its files, a pattern of them ("slice%03d.tif") or its folder; a DICOM
/// series by its folder or any of its files, of any name; and any file as raw where dimensions and
/// type are both given. Throws Error: what, where, what to do; also for a file of several
/// components of which the options choose none.
Volume read_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// A file may have several numbers at each point, its components: colors and vectors, the steps of
/// a fourth axis, and of .npy the last of four axes. This is how many, by its header. Throws Error
/// like read_volume.
int component_count(const std::filesystem::path& path, const ReadOptions& options = {});
/// Each component as a volume of its own, in the file's type and on its one grid; the chosen one
/// alone where the options choose. Throws Error like read_volume.
std::vector<Volume> read_components(const std::filesystem::path& path,
                                    const ReadOptions& options = {});

/// The parsers of our own, from memory, so that they can be fuzzed. `name` is for messages.
Volume parse_npy(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options = {});
Volume parse_raw(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options);

}  // namespace pellucid
