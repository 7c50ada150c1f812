// SPDX-License-Identifier: Apache-2.0
#include "volume_source.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "components.h"
#include "files/input_file.h"
#include "files/mapped_file.h"
#include "files/memory_limit.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

bool is_native(const ValueLayout& layout, std::size_t size) {
  return size == 1 || layout.big_endian == (std::endian::native == std::endian::big);
}

/// Returns the values in place; nothing where their bytes or their place are not those of memory.
std::optional<VolumeData> mapped_values(const ByteSource& source, const ValueLayout& layout,
                                        std::size_t count) {
  const std::size_t size = value_size(layout.type, source.name);
  if (!source.map || !is_native(layout, size) || layout.offset % size != 0) return std::nullopt;
  // The file need not fit, but what is built over it must.
  constexpr std::uintmax_t values_per_index = 20;
  check_memory(count * size / values_per_index, source.name + ": the index of its values");
  const std::shared_ptr<const std::byte> bytes = source.map(layout.offset + count * size);
  if (!bytes) return std::nullopt;
  VolumeData data = make_volume_data(layout.type, 0);
  std::visit(
      [&](auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        const auto* first = reinterpret_cast<const Value*>(bytes.get() + layout.offset);
        values = DataArray<Value>(std::shared_ptr<const Value>(bytes, first), count);
      },
      data);
  return data;
}

}  // namespace

ByteSource file_source(const std::filesystem::path& path) {
  ByteSource source{path.string(), check_input_file(path), {}, {}};
  auto stream = std::make_shared<std::ifstream>(path, std::ios::binary);
  source.read = [stream, name = source.name](std::uintmax_t from, std::span<std::byte> to) {
    stream->seekg(static_cast<std::streamoff>(from));
    stream->read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
    if (!*stream) throw Error(name + ": cannot read the file to its end; is it being written?");
  };
  source.map = [path](std::size_t bytes) { return map_file(path, bytes); };
  return source;
}

ByteSource memory_source(std::span<const std::byte> bytes, std::string name) {
  return {std::move(name),
          bytes.size(),
          [bytes](std::uintmax_t from, std::span<std::byte> to) {
            std::ranges::copy(bytes.subspan(from, to.size()), to.begin());
          },
          {}};
}

std::size_t value_count(const std::array<std::int64_t, 3>& dimensions, const std::string& name) {
  const std::string text = std::to_string(dimensions[0]) + " x " + std::to_string(dimensions[1]) +
                           " x " + std::to_string(dimensions[2]);
  // 2^60 values of 8 bytes are still a number of bytes.
  constexpr std::int64_t largest = std::int64_t{1} << 60;
  std::int64_t count = 1;
  for (const std::int64_t side : dimensions) {
    if (side < 1 || side > std::numeric_limits<int>::max()) {
      throw Error(name + ": a volume of " + text + " values cannot be; sides are from 1 to " +
                  std::to_string(std::numeric_limits<int>::max()));
    }
    if (count > largest / side)
      throw Error(name + ": a volume of " + text + " values is too large");
    count *= side;
  }
  return static_cast<std::size_t>(count);
}

std::size_t value_size(const std::string& type, const std::string& name) {
  static constexpr std::pair<const char*, std::size_t> sizes[] = {
      {"u8", 1},  {"i8", 1},  {"u16", 2}, {"i16", 2}, {"u32", 4}, {"i32", 4},
      {"u64", 8}, {"i64", 8}, {"f16", 2}, {"f32", 4}, {"f64", 8}};
  for (const auto& [known, size] : sizes) {
    if (type == known) return size;
  }
  throw Error(name + ": there is no type \"" + type +
              "\"; the types are u8, i8, u16, i16, u32, i32, u64, i64, f16, f32 and f64");
}

void check_size(const ByteSource& source, const ValueLayout& layout, std::size_t count) {
  check_bytes(source, layout.offset, std::uintmax_t{count} * value_size(layout.type, source.name));
}

void check_bytes(const ByteSource& source, std::uintmax_t offset, std::uintmax_t bytes) {
  if (offset <= source.size && source.size - offset >= bytes) return;
  throw Error(source.name + ": the file has " + std::to_string(source.size) +
              " bytes, but its header says that " + std::to_string(bytes) +
              " bytes of values begin at byte " + std::to_string(offset) +
              "; it is cut off or its header is wrong");
}

void note_bytes_left_over(const ByteSource& source, std::uintmax_t end, const Note& note,
                          const std::string& advice) {
  if (!note || source.size <= end) return;
  note(source.name + ": has " + std::to_string(source.size - end) +
       " bytes more than its header needs; they are left over behind the values" +
       (advice.empty() ? "" : "; " + advice));
}

VolumeData make_values(const std::string& type, std::size_t count, const std::string& name) {
  const std::uintmax_t bytes = std::uintmax_t{count} * value_size(type, name);
  check_memory(bytes, name + ": its values");
  try {
    return make_volume_data(type, count);
  } catch (const std::bad_alloc&) {
    refuse_memory(bytes, name + ": its values", memory_limit());
  }
}

VolumeData read_values(const ByteSource& source, const ValueLayout& layout, std::size_t count) {
  if (std::optional<VolumeData> data = mapped_values(source, layout, count)) {
    return *std::move(data);
  }
  VolumeData data = make_values(layout.type, count, source.name);
  std::visit(
      [&](auto& values) { source.read(layout.offset, std::as_writable_bytes(values.writable())); },
      data);
  to_native_order(data, layout.big_endian);
  return data;
}

VolumeData read_part(const ByteSource& source, const ValueLayout& layout, const GridPart& part) {
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  const std::size_t bytes = value_size(layout.type, source.name);
  const std::size_t row = size(part.box.count[0]) * bytes, rows = size(part.box.count[1]);
  const std::size_t whole_row = size(part.dimensions[0]) * bytes;
  VolumeData data = make_values(
      layout.type, size(part.box.count[0]) * rows * size(part.box.count[2]), source.name);
  std::visit(
      [&](auto& values) {
        std::span<std::byte> to = std::as_writable_bytes(values.writable());
        // Whole rows at once, of which the part is a good share; else row after row.
        const bool together = 8 * row > whole_row;
        std::vector<std::byte> slice(together ? (rows - 1) * whole_row + row : 0);
        for (int k = 0; k < part.box.count[2]; ++k) {
          const std::uintmax_t begin =
              layout.offset + size(part.box.first[0]) * bytes +
              std::uintmax_t{whole_row} *
                  (size(part.box.first[1]) +
                   std::uintmax_t{size(part.dimensions[1])} * size(part.box.first[2] + k));
          if (together) source.read(begin, slice);
          for (std::size_t j = 0; j < rows; ++j) {
            const std::span<std::byte> one = to.first(row);
            if (together) {
              std::memcpy(one.data(), slice.data() + j * whole_row, row);
            } else {
              source.read(begin + j * whole_row, one);
            }
            to = to.subspan(row);
          }
        }
      },
      data);
  to_native_order(data, layout.big_endian);
  return data;
}

VolumeData read_values(DataStream& stream, const ValueLayout& layout, std::size_t count) {
  VolumeData data = make_values(layout.type, count, stream.name());
  std::visit([&](auto& values) { stream.read(std::as_writable_bytes(values.writable())); }, data);
  to_native_order(data, layout.big_endian);
  return data;
}

void to_native_order(VolumeData& data, bool big_endian) {
  if (big_endian == (std::endian::native == std::endian::big)) return;
  std::visit(
      [](auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        for (Value& value : values.writable()) {
          std::array<std::byte, sizeof(Value)> bytes = std::bit_cast<decltype(bytes)>(value);
          std::ranges::reverse(bytes);
          value = std::bit_cast<Value>(bytes);
        }
      },
      data);
}

void apply_overrides(const ReadOptions& options, Volume::Description& description) {
  if (options.spacing) {
    for (int a = 0; a < 3; ++a) {
      if (!(std::isfinite((*options.spacing)[a]) && (*options.spacing)[a] > 0)) {
        throw Error(description.name + ": the spacing given is not a positive number on axis " +
                    std::string(1, "xyz"[a]));
      }
    }
    description.placement.spacing = *options.spacing;
  }
  if (options.origin) {
    for (int a = 0; a < 3; ++a) {
      if (!std::isfinite((*options.origin)[a])) {
        throw Error(description.name + ": the origin given is not a finite number on axis " +
                    std::string(1, "xyz"[a]));
      }
    }
    description.placement.origin = *options.origin;
  }
  if (options.centering) description.centering = *options.centering;
}

void refuse_raw_options(const ReadOptions& options, const std::string& name) {
  const char* option = options.dimensions   ? "dimensions"
                       : options.type       ? "a type"
                       : options.big_endian ? "a byte order"
                       : options.skip_bytes ? "bytes to skip"
                       : options.components ? "a number of components"
                                            : nullptr;
  if (option == nullptr) return;
  throw Error(name + ": " + option +
              " may only be given for headerless data; leave it out, the file has a header");
}

}  // namespace pellucid
