// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
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
};

/// Reads a volume by its extension: .nii .nii.gz .hdr/.img(.gz) .nrrd .nhdr .mha .mhd (through ITK,
/// where the build has it), .npy, .raw; and any file as raw where dimensions and type are both
/// given. Throws Error: what, where, what to do.
Volume read_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// The parsers of our own, from memory, so that they can be fuzzed. `name` is for messages.
Volume parse_npy(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options = {});
Volume parse_raw(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options);

}  // namespace pellucid
