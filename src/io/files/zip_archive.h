// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "volumes/volume_source.h"

namespace pellucid {

/// A file in a zip archive, as the archive's directory describes it.
struct ZipEntry {
  std::string name;
  bool encrypted = false;
  unsigned method = 0;  ///< 0: stored, 8: deflated
  std::uint32_t checksum = 0;
  std::uintmax_t packed_size = 0, size = 0;
  std::uintmax_t header = 0;  ///< where its own header begins
};

/// Reads the directory at the end of a zip archive, also of zip64. Throws Error.
std::vector<ZipEntry> read_zip_directory(const ByteSource& archive);

/// Returns the bytes of an entry, inflated as they are read; reading backwards begins anew. Throws
/// Error where they are damaged, encrypted or packed by another method, or the checksum is not
/// theirs.
ByteSource zip_entry_source(const ByteSource& archive, const ZipEntry& entry);

}  // namespace pellucid
