// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "volume_source.h"

namespace pellucid {

/// ITK knows the formats' headers: where a grid stands, its type, its centering. Its world is left,
/// posterior, superior (LPS). The values of NIfTI and MetaImage are read by ourselves: ITK 5.2
/// gives zeros for what a truncated file lacks, and for NaN and infinity in NIfTI. All of these
/// throw Error, also where the build has no ITK.

struct ItkHeader {
  Volume::Description description;
  std::string type;  ///< "u8" … "f64"
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

/// Where the values of a NRRD file are that are neither compressed nor text.
struct NrrdValues {
  static constexpr std::uintmax_t last_bytes = std::numeric_limits<std::uintmax_t>::max();

  std::filesystem::path file;
  std::uintmax_t offset = 0;  ///< last_bytes: they are the file's last
  std::optional<bool> big_endian;
};

/// All of a NRRD file, as `name` in messages; the values from `values` where those are given.
/// ITK 5.2 turns the space left-anterior-superior to LPS by the wrong axis, so it must be told
/// apart. `count` is how many values the header's text says there are: ITK writes as many into a
/// buffer for the sizes that it cut down to 32 bits.
Volume read_nrrd_file(const std::filesystem::path& path, const std::string& name,
                      std::uint64_t count, bool left_anterior_superior,
                      const std::optional<NrrdValues>& values, const ReadOptions& options);

}  // namespace pellucid
