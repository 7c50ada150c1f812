// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// A header as ITK understands it: where a grid stands, its type, its centering. ITK's world is
/// left, posterior, superior (LPS).
struct ItkHeader {
  std::array<std::int64_t, 3> sides{};  ///< values along x, y, z; not checked
  GridPlacement placement;
  std::string type;  ///< "u8" … "f64", also "i64" and "u64"
  int components = 1;
  bool interleaved = false;  ///< as in ValueLayout, where ITK gives the values
  std::string holds;         ///< what several components are
};

/// Also where the values of a MetaImage are. They are read by ourselves: ITK 5.2 gives zeros for
/// the part of the values that a truncated file lacks.
struct MetaImageHeader : ItkHeader {
  bool big_endian = false;
  bool text = false;
  bool compressed = false;
  int header_size = 0;    ///< of the file of values; -1: the values are its last bytes
  std::string data_file;  ///< a name, a pattern with its range, LIST or LOCAL
};

struct NrrdHeader : ItkHeader {
  std::uintmax_t bytes = 0;  ///< of all values, as ITK counts them
};

/// The functions of the module, by these names. Each puts an error in one line into `error`, empty
/// where there is none; no exception leaves the module. `name` is the file's in messages.
using ReadMetaImageHeader = void(const std::filesystem::path& path, MetaImageHeader& header,
                                 std::string& error);
using ReadNrrdHeader = void(const std::filesystem::path& path, const std::string& name,
                            NrrdHeader& header, std::string& error);
/// All values, in this machine's byte order; `to` has exactly their size.
using ReadNrrdValues = void(const std::filesystem::path& path, const std::string& name,
                            std::span<std::byte> to, std::string& error);
inline constexpr const char* read_meta_image_header_name = "pellucid_read_meta_image_header_1";
inline constexpr const char* read_nrrd_header_name = "pellucid_read_nrrd_header_1";
inline constexpr const char* read_nrrd_values_name = "pellucid_read_nrrd_values_1";

}  // namespace pellucid
