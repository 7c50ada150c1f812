// SPDX-License-Identifier: Apache-2.0
#include "raw.h"

#include <utility>

#include "files/input_file.h"
#include "pellucid/io/internal/parse_arrays.h"
#include "pellucid/scene/error.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace {

/// Shape of headerless data, by the options.
struct RawShape {
  VolumeFile file;  ///< without what reads the values
  ValueLayout layout;
  std::size_t count = 0;
  std::uintmax_t bytes = 0;
  std::string described;  ///< for messages

  RawShape(const std::string& name, const ReadOptions& options) {
    if (!options.dimensions || !options.type) {
      throw Error(name + ": headerless data; give its dimensions (x y z) and its type (u8 … f64)");
    }
    const std::array<int, 3>& dimensions = *options.dimensions;
    count = value_count({dimensions[0], dimensions[1], dimensions[2]}, name);
    const int components = options.components.value_or(1);
    if (components < 1) {
      throw Error(name + ": " + std::to_string(components) +
                  " components are given, but there must be at least 1");
    }
    bytes = std::uintmax_t{value_count(count, components, name)} * value_size(*options.type, name);
    layout = {
        *options.type, options.big_endian.value_or(false), options.skip_bytes, components, true,
        options.note};
    described = std::to_string(dimensions[0]) + " x " + std::to_string(dimensions[1]) + " x " +
                std::to_string(dimensions[2]) + " values of " +
                (components > 1 ? std::to_string(components) + " x " : "") + *options.type;
    file.description.dimensions = dimensions;
    file.description.name = name;
    apply_overrides(options, file.description);
    file.components = components;
    file.holds = std::to_string(components) + " components at each point";
  }
};

}  // namespace

VolumeFile open_raw(const ByteSource& source, const ReadOptions& options) {
  RawShape raw(source.name, options);
  if (options.skip_bytes > source.size || source.size - options.skip_bytes != raw.bytes) {
    std::string skipped;
    if (options.skip_bytes > 0) {
      skipped = " after " + std::to_string(options.skip_bytes) + " skipped ones";
    }
    throw Error(source.name + ": the file has " + std::to_string(source.size) + " bytes, but " +
                raw.described + " need " + std::to_string(raw.bytes) + skipped +
                "; check dimensions, type" + (raw.file.components > 1 ? ", components" : "") +
                " and bytes to skip");
  }
  raw.file.reads_parts = source.map && reads_parts(raw.layout);
  raw.file.read = [source, layout = raw.layout, count = raw.count](ComponentRange range) {
    return read_components(source, layout, count, range);
  };
  return std::move(raw.file);
}

namespace {

VolumeFile open_raw_gzip(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  RawShape raw(name, options);
  // Deflate makes at most 1032 bytes of one.
  if (check_input_file(path) < raw.bytes / 1032) {
    throw Error(name + ": is too small for " + raw.described + "; check dimensions and type");
  }
  raw.file.read = [path, layout = raw.layout, count = raw.count,
                   described = raw.described](ComponentRange range) {
    DataStream stream(path, 0, DataStream::Compression::deflate);
    stream.skip(layout.offset);
    std::vector<VolumeData> list = read_components(stream, layout, count, range);
    if (!stream.at_end()) {
      throw Error(path.string() + ": holds more than " + described + "; check dimensions and type");
    }
    return list;
  };
  return std::move(raw.file);
}

}  // namespace

Volume parse_raw(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options) {
  return read_chosen(open_raw(memory_source(bytes, name), options), options);
}

extern const VolumeFormat raw_format{
    .name = "headerless data",
    .extensions = ".raw",
    .open = [](const std::filesystem::path& path,
               const ReadOptions& options) { return open_raw(file_source(path), options); },
    .has_header = false};

extern const VolumeFormat raw_gzip_format{.name = "headerless data, gzipped",
                                          .extensions = ".raw.gz",
                                          .open = open_raw_gzip,
                                          .has_header = false};

}  // namespace pellucid
