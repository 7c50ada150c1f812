// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "itk_module.h"
#include "volumes/components.h"

namespace pellucid {

/// Reads the header of a MetaImage through ITK. Throws Error, also where the module that has ITK is
/// not there.
MetaImageHeader read_meta_image_header(const std::filesystem::path& path);

/// Returns the grid of a header. Throws Error where its sides are no sizes of a volume.
Volume::Description describe(const ItkHeader& header, const std::string& name);

/// Position of the values of a NRRD file that are plain, or compressed as ITK does not read them.
struct NrrdValues {
  static constexpr std::uintmax_t last_bytes = std::numeric_limits<std::uintmax_t>::max();

  std::filesystem::path file;
  std::uintmax_t offset = 0;  ///< last_bytes: they are the file's last
  std::optional<bool> big_endian;
  std::optional<DataStream::Compression> compression;  ///< begins at the offset
  std::uintmax_t skip_inside = 0;                      ///< of what is decompressed
};

/// Facts in the text of a NRRD header that ITK does not tell.
struct NrrdText {
  /// Number of values: ITK writes as many into a buffer for the sizes that it cut down to 32 bits.
  std::uint64_t count = 0;
  /// ITK 5.2 turns this space to LPS by the wrong axis.
  bool left_anterior_superior = false;
  /// The axis that is none of space, from 1; 0 where there is none. ITK moves it to the front.
  std::size_t components_axis = 0;
  std::size_t values_before = 1;     ///< along the axes in front of that one
  int cell_centred_axes = 0;         ///< of the three of space
  std::optional<NrrdValues> values;  ///< read from there where they are given
};

/// Opens a NRRD file, as `name` in messages. `path` must stay while values are read. Throws Error.
VolumeFile open_nrrd_file(const std::filesystem::path& path, const std::string& name,
                          const NrrdText& text, const ReadOptions& options);

}  // namespace pellucid
