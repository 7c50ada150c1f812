// SPDX-License-Identifier: Apache-2.0

// Headerless data with any options. The first bytes of the input are the options: three 32-bit
// dimensions, the type, flags, the bytes to skip, the components and which of them, a spacing and
// an origin; the rest is the data.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>
#include <variant>
#include <vector>

#include "pellucid/io/internal/parse_arrays.h"
#include "pellucid/scene/error.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

struct Options {
  std::int32_t dimensions[3];
  std::uint8_t type, flags, skip, components;  ///< components: how many, and 16 times which
  double spacing[3], origin[3];
};

struct Type {
  const char* name;
  std::size_t bytes;  ///< of a value as it is stored
};
constexpr Type types[] = {{"u8", 1},  {"i8", 1},  {"u16", 2}, {"i16", 2}, {"u32", 4}, {"i32", 4},
                          {"f32", 4}, {"f64", 8}, {"f16", 2}, {"", 0},    {"i64", 8}, {"u64", 8}};

const Type& type_of(const Options& given) {
  return types[given.type % std::size(types)];
}

pellucid::ReadOptions read_options(const Options& given) {
  pellucid::ReadOptions options;
  if ((given.flags & 1) == 0) {
    options.dimensions = {given.dimensions[0], given.dimensions[1], given.dimensions[2]};
  }
  if ((given.flags & 2) == 0) options.type = type_of(given).name;
  if ((given.flags & 4) != 0) options.big_endian = (given.flags & 8) != 0;
  options.skip_bytes = given.skip;
  if (given.components % 16 != 0) {
    options.components = given.components % 16;
    options.component = given.components / 16;
  }
  if ((given.flags & 16) != 0) {
    options.spacing = {given.spacing[0], given.spacing[1], given.spacing[2]};
  }
  if ((given.flags & 32) != 0) {
    options.origin = {given.origin[0], given.origin[1], given.origin[2]};
  }
  if ((given.flags & 64) != 0) {
    options.centering =
        (given.flags & 128) != 0 ? pellucid::Centering::cell : pellucid::Centering::point;
  }
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Options given{};
  if (size < sizeof(given)) return 0;
  std::memcpy(&given, data, sizeof(given));
  std::vector<std::byte> bytes(size - sizeof(given));
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::byte{data[sizeof(given) + i]};
  try {
    const pellucid::Volume volume = pellucid::parse_raw(bytes, "fuzz", read_options(given));
    const std::size_t count =
        std::visit([](const auto& values) { return values.size(); }, volume.data());
    const std::size_t components = given.components % 16 == 0 ? 1 : given.components % 16;
    require(count * type_of(given).bytes * components + given.skip == bytes.size());
    require(volume.statistics().infinite == 0 && volume.voxel_size() > 0);
  } catch (const pellucid::Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz: ") && message.size() < 1000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
  return 0;
}
