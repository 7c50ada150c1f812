// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/error.h"
#include "volume_source.h"

namespace pellucid {

Volume read_raw(const ByteSource& source, const ReadOptions& options) {
  if (!options.dimensions || !options.type) {
    throw Error(source.name +
                ": headerless data; give its dimensions (x y z) and its type (u8 … f64)");
  }
  const std::array<int, 3>& dimensions = *options.dimensions;
  const std::size_t count = value_count({dimensions[0], dimensions[1], dimensions[2]}, source.name);
  const std::uintmax_t bytes = std::uintmax_t{count} * value_size(*options.type, source.name);
  if (options.skip_bytes > source.size || source.size - options.skip_bytes != bytes) {
    std::string skipped;
    if (options.skip_bytes > 0) {
      skipped = " after " + std::to_string(options.skip_bytes) + " skipped ones";
    }
    throw Error(source.name + ": the file has " + std::to_string(source.size) + " bytes, but " +
                std::to_string(dimensions[0]) + " x " + std::to_string(dimensions[1]) + " x " +
                std::to_string(dimensions[2]) + " values of " + *options.type + " need " +
                std::to_string(bytes) + skipped + "; check dimensions, type and bytes to skip");
  }
  const ValueLayout layout{*options.type, options.big_endian.value_or(false), options.skip_bytes};
  VolumeData data = read_values(source, layout, count);
  Volume::Description description;
  description.dimensions = dimensions;
  description.name = source.name;
  apply_overrides(options, description);
  return Volume(std::move(description), std::move(data));
}

Volume parse_raw(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options) {
  return read_raw(memory_source(bytes, name), options);
}

}  // namespace pellucid
