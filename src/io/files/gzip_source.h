// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "volumes/volume_source.h"

namespace pellucid {

/// Returns the contents of a gzipped file, inflated once to know their length, and again where they
/// are read. What is read in the order of its bytes is inflated once more only. Throws Error where
/// the file is cut off or damaged.
ByteSource gzip_source(const std::filesystem::path& path);

/// Returns a source of what is unpacked where the file begins as gzip does, else of the file as it
/// is.
ByteSource plain_or_gzip_source(const std::filesystem::path& path);

}  // namespace pellucid
