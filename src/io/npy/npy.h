// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "volumes/components.h"

namespace pellucid {

/// What the header of a .npy file says.
struct NpyArray {
  std::string type;  ///< as of ValueLayout
  bool big_endian = false;
  std::uintmax_t offset = 0;  ///< of the first value, in bytes
  bool fortran_order = false;
  std::vector<std::int64_t> shape;
};

/// Throws Error, also for types that are not read.
NpyArray read_npy_header(const ByteSource& source);

/// Returns the values of a small array, the last axis fastest. Throws Error.
std::vector<double> read_npy_numbers(const ByteSource& source);

/// The arrays of an archive of .npy files, as numpy.savez writes it.
std::vector<VolumeArray> list_npz_arrays(const std::filesystem::path& path,
                                         const ReadOptions& options);

}  // namespace pellucid
