// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "volumes/components.h"

namespace pellucid {

struct ArrayBeside;

/// Contents of the header of a .npy file.
struct NpyArray {
  std::string type;  ///< as of ValueLayout
  bool big_endian = false;
  std::uintmax_t offset = 0;  ///< of the first value, in bytes
  bool fortran_order = false;
  std::vector<std::int64_t> shape;
};

/// Returns the preamble and the header of an array of this type ("u8" … "f64") in this machine's
/// byte order, the last axis fastest or, in Fortran's order, the first: NumPy's format 1.0, of a
/// multiple of 64 bytes.
std::string npy_header(std::string_view type, const std::vector<std::size_t>& shape,
                       bool fortran_order = false);

/// Throws Error, also for types that are not read.
NpyArray read_npy_header(const ByteSource& source);

/// Returns the values of a small array, the last axis fastest. Throws Error.
std::vector<double> read_npy_numbers(const ByteSource& source);

/// Opens the array of a .npy file behind which nothing may be, as in a .npz file, whose entries
/// have one array each. `beside` are the other arrays of the archive, which may say positions.
/// Throws Error.
VolumeFile open_npy_alone(const ByteSource& source, const ReadOptions& options,
                          std::span<const ArrayBeside> beside = {});

}  // namespace pellucid
