// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "components.h"

namespace pellucid {

/// ITK knows the formats' headers: where a grid stands, its type, its centering. Its world is left,
/// posterior, superior (LPS). The values of NIfTI and MetaImage are read by ourselves: ITK 5.2
/// gives zeros for what a truncated file lacks, and for NaN and infinity in NIfTI. All of these
/// throw Error, also where the build has no ITK.

struct ItkHeader {
  Volume::Description description;
  std::string type;  ///< "u8" … "f64"
  int components = 1;
  bool interleaved = false;  ///< as in ValueLayout, where ITK gives the values
  std::string holds;         ///< what several components are
};

/// Geometry alone. Of a sheared sform, which ITK refuses, `sheared` is set instead of throwing.
Volume::Description read_nifti_description(const std::filesystem::path& path, bool& sheared);

/// Where the values of a MetaImage are.
struct MetaImageHeader : ItkHeader {
  bool big_endian = false;
  bool text = false;
  bool compressed = false;
  int header_size = 0;    ///< of the file of values; -1: what stands before the last bytes
  std::string data_file;  ///< a name, a pattern with its range, LIST or LOCAL
};
MetaImageHeader read_meta_image_header(const std::filesystem::path& path);

/// Where the values of a NRRD file are that are plain, or compressed as ITK does not read them.
struct NrrdValues {
  static constexpr std::uintmax_t last_bytes = std::numeric_limits<std::uintmax_t>::max();

  std::filesystem::path file;
  std::uintmax_t offset = 0;  ///< last_bytes: they are the file's last
  std::optional<bool> big_endian;
  std::optional<DataStream::Compression> compression;  ///< begins at the offset
  std::uintmax_t skip_inside = 0;                      ///< of what is decompressed
};

/// What the text of a NRRD header says that ITK does not tell.
struct NrrdText {
  /// How many values there are: ITK writes as many into a buffer for the sizes that it cut down to
  /// 32 bits.
  std::uint64_t count = 0;
  /// ITK 5.2 turns this space to LPS by the wrong axis.
  bool left_anterior_superior = false;
  /// The axis that is none of space, from 1; 0 where there is none. ITK moves it to the front.
  std::size_t components_axis = 0;
  std::optional<NrrdValues> values;  ///< read from there where they are given
};

/// A NRRD file, as `name` in messages. `path` must stay while values are read.
VolumeFile open_nrrd_file(const std::filesystem::path& path, const std::string& name,
                          const NrrdText& text, const ReadOptions& options);

}  // namespace pellucid
