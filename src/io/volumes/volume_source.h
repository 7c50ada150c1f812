// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "files/data_stream.h"
#include "pellucid/io/read_volume.h"

namespace pellucid {

/// Source of the bytes of a volume: a file, or memory in tests and fuzzing. `read` fills the whole
/// span from the given place, which the caller has checked to lie inside; `map` gives the first so
/// many in place, or null where it cannot, and may itself be missing.
struct ByteSource {
  std::string name;         ///< for messages
  std::uintmax_t size = 0;  ///< bytes
  std::function<void(std::uintmax_t from, std::span<std::byte> to)> read;
  std::function<std::shared_ptr<const std::byte>(std::size_t bytes)> map;
};

/// Returns a regular file. Throws Error where it cannot be read.
ByteSource file_source(const std::filesystem::path& path);
/// Returns a source of bytes in memory, which must outlive it.
ByteSource memory_source(std::span<const std::byte> bytes, std::string name);

/// Is told a line that a user should know.
using Note = std::function<void(const std::string&)>;

/// Layout of values in a file.
struct ValueLayout {
  std::string type;  ///< "u8" … "f64", or one that only files have (stored_numbers.h)
  bool big_endian = false;
  std::uintmax_t offset = 0;  ///< of the first value, in bytes
  int components = 1;         ///< of each point
  bool interleaved = false;   ///< those of a point side by side; else one behind the other
  Note note = {};             ///< is told where whole numbers are rounded; may be missing
};

/// Returns the number of values of a grid. Throws Error where a side is not positive or the product
/// is too large for any machine.
std::size_t value_count(const std::array<std::int64_t, 3>& dimensions, const std::string& name);
/// Returns 1, 2, 4 or 8 bytes, also of types that only files have. Throws Error for a name that is
/// no type.
std::size_t value_size(const std::string& type, const std::string& name);

/// Throws Error where the source ends before the last of `count` values, those of all components.
/// There may be more behind it.
void check_size(const ByteSource& source, const ValueLayout& layout, std::size_t count);
/// Checks the same of so many bytes of values from `offset` on.
void check_bytes(const ByteSource& source, std::uintmax_t offset, std::uintmax_t bytes);
/// Tells `note` how many bytes of `source` stand behind the values; `advice` is what to do where
/// they are not the first bytes, and may be empty.
void note_bytes_left_over(const ByteSource& source, std::uintmax_t end, const Note& note,
                          const std::string& advice);

/// Returns memory for so many values. Throws Error where there is not enough.
VolumeData make_values(const std::string& type, std::size_t count, const std::string& name);
/// Returns the values, of one component, in their own type: in place where they lie there as in
/// memory, else read. The source must hold them all.
VolumeData read_values(const ByteSource& source, const ValueLayout& layout, std::size_t count);
/// The values of a part of a grid, read row by row.
struct GridPart;
VolumeData read_part(const ByteSource& source, const ValueLayout& layout, const GridPart& part);
/// Returns the same from a stream that stands at the first of them.
VolumeData read_values(DataStream& stream, const ValueLayout& layout, std::size_t count);
/// Turns the bytes of each value where `big_endian` is not this machine's order.
void to_native_order(VolumeData& data, bool big_endian);

/// Puts what the options say in the place of what the file says. Throws Error for a spacing that
/// is not positive and for an origin that is not finite.
void apply_overrides(const ReadOptions& options, Volume::Description& description);
/// Throws Error where an option that only headerless data needs is given for a file with a header.
void refuse_raw_options(const ReadOptions& options, const std::string& name);

}  // namespace pellucid
