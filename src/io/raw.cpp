// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "components.h"
#include "pellucid/scene/error.h"

namespace pellucid {

VolumeFile open_raw(const ByteSource& source, const ReadOptions& options) {
  if (!options.dimensions || !options.type) {
    throw Error(source.name +
                ": headerless data; give its dimensions (x y z) and its type (u8 … f64)");
  }
  const std::array<int, 3>& dimensions = *options.dimensions;
  const std::size_t count = value_count({dimensions[0], dimensions[1], dimensions[2]}, source.name);
  const int components = options.components.value_or(1);
  if (components < 1) {
    throw Error(source.name + ": " + std::to_string(components) +
                " components are given, but there must be at least 1");
  }
  const std::uintmax_t bytes = std::uintmax_t{value_count(count, components, source.name)} *
                               value_size(*options.type, source.name);
  if (options.skip_bytes > source.size || source.size - options.skip_bytes != bytes) {
    std::string skipped;
    if (options.skip_bytes > 0) {
      skipped = " after " + std::to_string(options.skip_bytes) + " skipped ones";
    }
    throw Error(source.name + ": the file has " + std::to_string(source.size) + " bytes, but " +
                std::to_string(dimensions[0]) + " x " + std::to_string(dimensions[1]) + " x " +
                std::to_string(dimensions[2]) + " values of " +
                (components > 1 ? std::to_string(components) + " x " : "") + *options.type +
                " need " + std::to_string(bytes) + skipped + "; check dimensions, type" +
                (components > 1 ? ", components" : "") + " and bytes to skip");
  }
  const ValueLayout layout{*options.type, options.big_endian.value_or(false), options.skip_bytes,
                           components, true};
  VolumeFile file;
  file.description.dimensions = dimensions;
  file.description.name = source.name;
  apply_overrides(options, file.description);
  file.components = components;
  file.holds = std::to_string(components) + " components at each point";
  file.read = [source, layout, count](ComponentRange range) {
    return read_components(source, layout, count, range);
  };
  return file;
}

Volume parse_raw(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options) {
  return read_chosen(open_raw(memory_source(bytes, name), options), options);
}

}  // namespace pellucid
