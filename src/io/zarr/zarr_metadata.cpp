// SPDX-License-Identifier: Apache-2.0
//
// Zarr 2: https://zarr-specs.readthedocs.io/en/latest/v2/v2.0.html, .zgroup, .zarray and .zattrs.
// Zarr 3: https://zarr-specs.readthedocs.io/en/latest/v3/core/, zarr.json. Codecs of numcodecs have
// the same configuration in both; in version 3 their names begin with "numcodecs.".

#include "zarr_metadata.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "volumes/stored_numbers.h"

namespace pellucid {

using scene_json::Node;

namespace {

constexpr std::int64_t longest_axis = std::int64_t{1} << 52;
constexpr std::size_t deepest_shards = 4;

std::vector<std::int64_t> sides_of(const Node& list, std::int64_t least) {
  if (list.array_size() > max_zarr_axes) list.fail("has more than 32 numbers");
  std::vector<std::int64_t> sides;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    sides.push_back(list.element(i).integer(least, longest_axis));
  }
  return sides;
}

std::vector<std::int64_t> chunk_of(const Node& list, std::size_t axes) {
  std::vector<std::int64_t> chunk = sides_of(list, 1);
  if (chunk.size() != axes) {
    list.fail("has " + std::to_string(chunk.size()) + " numbers, but the array has " +
              std::to_string(axes) + " axes");
  }
  return chunk;
}

// What numpy calls it: "<f8", "|u1".
ZarrType numpy_type(const Node& node) {
  if (!node.is_string()) node.fail("describes records of several fields; save one of them");
  static constexpr std::pair<const char*, const char*> types[] = {
      {"b1", "b1"},  {"u1", "u8"},  {"i1", "i8"},  {"u2", "u16"}, {"i2", "i16"}, {"u4", "u32"},
      {"i4", "i32"}, {"u8", "u64"}, {"i8", "i64"}, {"f2", "f16"}, {"f4", "f32"}, {"f8", "f64"}};
  const std::string& text = node.string();
  const char order = text.empty() ? '\0' : text[0];
  for (const auto& [numpy, name] : types) {
    if (text.substr(text.empty() ? 0 : 1) != numpy) continue;
    const auto bytes = static_cast<std::size_t>(numpy[1] - '0');
    if (order == '<' || order == '>' || (order == '|' && bytes == 1)) {
      return {name, bytes, order == '>'};
    }
  }
  node.fail("\"" + printable(text) +
            "\" is not read: read are b1, u1 to u8, i1 to i8 and f2 to f8; convert with .astype");
}

ZarrType type_of_version_3(const Node& node) {
  static constexpr std::pair<const char*, const char*> types[] = {
      {"bool", "b1"},   {"uint8", "u8"},    {"int8", "i8"},     {"uint16", "u16"},
      {"int16", "i16"}, {"uint32", "u32"},  {"int32", "i32"},   {"uint64", "u64"},
      {"int64", "i64"}, {"float16", "f16"}, {"float32", "f32"}, {"float64", "f64"}};
  const Node text = node.is_object() ? node.at("name", "give the name of the type") : node;
  for (const auto& [known, name] : types) {
    if (text.string() != known) continue;
    const std::string_view digits = std::string_view(name).substr(1);
    int bits = 8;
    std::from_chars(digits.data(), digits.data() + digits.size(), bits);
    return {name, known == std::string_view("bool") ? 1 : static_cast<std::size_t>(bits) / 8};
  }
  node.fail("\"" + printable(text.string()) +
            "\" is not read: read are bool, uint8 to uint64, int8 to int64 and float16 to "
            "float64; convert with .astype");
}

template <class Number>
void put(Number number, std::array<std::byte, 8>& fill) {
  std::memcpy(fill.data(), &number, sizeof number);
}

/// Returns a whole number that the file may state as 3 or 3.0, in this type.
template <class Number>
Number whole(const Node& node) {
  const nlohmann::json& value = node.value();
  constexpr Number least = std::numeric_limits<Number>::min();
  constexpr Number largest = std::numeric_limits<Number>::max();
  if (value.is_number_unsigned() && std::in_range<Number>(value.get<std::uint64_t>())) {
    return static_cast<Number>(value.get<std::uint64_t>());
  }
  if (value.is_number_integer() && !value.is_number_unsigned() &&
      std::in_range<Number>(value.get<std::int64_t>())) {
    return static_cast<Number>(value.get<std::int64_t>());
  }
  if (value.is_number_float()) {
    // 2^63 and 2^64 as doubles are just beyond the range of 64 bits.
    const double number = value.get<double>();
    constexpr double end =
        sizeof(Number) == 8 ? (least < 0 ? 0x1p63 : 0x1p64) : static_cast<double>(largest) + 1;
    if (number == std::floor(number) && number >= static_cast<double>(least) && number < end) {
      return static_cast<Number>(number);
    }
  }
  node.fail("is no number of the array's type");
}

double real(const Node& node) {
  if (node.is_number()) return node.value().get<double>();
  const std::string& text = node.string();
  if (text == "NaN") return std::numeric_limits<double>::quiet_NaN();
  if (text == "Infinity") return std::numeric_limits<double>::infinity();
  if (text == "-Infinity") return -std::numeric_limits<double>::infinity();
  node.fail("\"" + printable(text) + "\" is no number");
}

/// "0x7fc00000": the bits of a number, from the highest.
std::optional<std::uint64_t> bits_of(const Node& node) {
  if (!node.is_string() || !node.string().starts_with("0x")) return std::nullopt;
  const std::string& text = node.string();
  std::uint64_t bits = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data() + 2, end, bits, 16);
  if (result.ec != std::errc() || result.ptr != end) node.fail("is no number");
  return bits;
}

void read_fill(const Node& node, ZarrArray& array) {
  const std::string& type = array.type.name;
  array.fill_text = printable(node.value().dump());
  if (node.is_null()) {
    array.fill_text = "0";
    return;
  }
  array.has_fill = true;
  if (const auto bits = bits_of(node); bits && type[0] == 'f') {
    if (type == "f16") put(half_to_float(static_cast<std::uint16_t>(*bits)), array.fill);
    if (type == "f32") put(static_cast<std::uint32_t>(*bits), array.fill);
    if (type == "f64") put(*bits, array.fill);
  } else if (node.value().is_boolean() || type == "b1") {
    put(static_cast<std::uint8_t>(node.is_true() ? 1 : 0), array.fill);
  } else if (type == "u8") {
    put(whole<std::uint8_t>(node), array.fill);
  } else if (type == "i8") {
    put(whole<std::int8_t>(node), array.fill);
  } else if (type == "u16") {
    put(whole<std::uint16_t>(node), array.fill);
  } else if (type == "i16") {
    put(whole<std::int16_t>(node), array.fill);
  } else if (type == "u32") {
    put(whole<std::uint32_t>(node), array.fill);
  } else if (type == "i32") {
    put(whole<std::int32_t>(node), array.fill);
  } else if (type == "u64") {
    put(whole<std::uint64_t>(node), array.fill);
  } else if (type == "i64") {
    put(whole<std::int64_t>(node), array.fill);
  } else if (type == "f16" || type == "f32") {
    put(static_cast<float>(real(node)), array.fill);
  } else {
    put(real(node), array.fill);
  }
}

/// Returns a codec of numcodecs by its name and its configuration.
ZarrCodec numcodecs_codec(const std::string& name, const Node& where, const Node* settings,
                          const ZarrType& type) {
  using Kind = ZarrCodec::Kind;
  static constexpr std::pair<const char*, Kind> simple[] = {
      {"blosc", Kind::blosc},         {"zstd", Kind::zstd},
      {"gzip", Kind::deflate},        {"zlib", Kind::deflate},
      {"bz2", Kind::bzip2},           {"lz4", Kind::lz4},
      {"crc32", Kind::check_crc32},   {"adler32", Kind::check_adler32},
      {"crc32c", Kind::check_crc32c}, {"fletcher32", Kind::check_behind},
      {"bitround", Kind::same},       {"packbits", Kind::packbits}};
  ZarrCodec codec;
  codec.name = name;
  for (const auto& [known, kind] : simple) {
    if (name != known) continue;
    codec.kind = kind;
    return codec;
  }
  const auto setting = [&](const char* key) {
    return settings == nullptr ? std::optional<Node>() : settings->find(key);
  };
  const auto type_setting = [&](const char* key, const ZarrType& otherwise) {
    const auto node = setting(key);
    return node && !node->is_null() ? numpy_type(*node) : otherwise;
  };
  if (name == "shuffle") {
    codec.kind = Kind::shuffle;
    const auto size = setting("elementsize");
    codec.element = size ? static_cast<std::size_t>(size->integer(1, 1 << 20)) : 4;
    return codec;
  }
  if (name == "astype") {
    codec.kind = Kind::convert;
    codec.encoded = type_setting("encode_dtype", type);
    codec.decoded = type_setting("decode_dtype", type);
    return codec;
  }
  if (name == "delta" || name == "quantize" || name == "fixedscaleoffset") {
    codec.kind = name == "delta" ? Kind::delta : Kind::convert;
    codec.decoded = type_setting("dtype", type);
    codec.encoded = type_setting("astype", codec.decoded);
    if (name == "fixedscaleoffset") {
      const auto scale = setting("scale"), offset = setting("offset");
      if (!scale || !offset) where.fail("a fixedscaleoffset needs its scale and its offset");
      codec.scale = scale->number();
      codec.offset = offset->number();
      if (codec.scale == 0) scale->fail("is 0");
    }
    return codec;
  }
  where.fail("\"" + printable(name) +
             "\" is no codec that is read: read are blosc, zstd, gzip, zlib, bz2, lz4, crc32c and "
             "simple filters; save the array with one of them");
}

ZarrChain parse_chain(const Node& list, const ZarrType& type, std::size_t axes, std::size_t depth);

/// "codecs" of an index: numbers of 64 bits, with a checksum behind or without.
void read_index_codecs(const Node& list, ZarrShards& shards) {
  const ZarrChain chain = parse_chain(list, {"u64", 8}, 1, deepest_shards);
  shards.big_endian_index = chain.big_endian;
  shards.checked_index = !chain.codecs.empty();
  if (chain.codecs.size() > 1 ||
      (shards.checked_index && chain.codecs[0].kind != ZarrCodec::Kind::check_crc32c)) {
    list.fail("an index may have the codecs \"bytes\" and \"crc32c\" alone");
  }
}

std::shared_ptr<const ZarrShards> parse_shards(const Node& settings, const ZarrType& type,
                                               std::size_t axes, std::size_t depth) {
  if (depth == deepest_shards) settings.fail("has shards in shards in shards");
  ZarrShards shards;
  shards.chunk = chunk_of(settings.at("chunk_shape", "give the chunks' sides"), axes);
  shards.chain =
      parse_chain(settings.at("codecs", "list the chunks' codecs"), type, axes, depth + 1);
  read_index_codecs(settings.at("index_codecs", "list the index's codecs"), shards);
  if (const auto place = settings.find("index_location")) {
    shards.index_in_front = place->one_of({"start", "end"}) == 0;
  }
  return std::make_shared<const ZarrShards>(std::move(shards));
}

std::vector<std::size_t> straight(std::size_t axes) {
  std::vector<std::size_t> order(axes);
  for (std::size_t i = 0; i < axes; ++i) order[i] = i;
  return order;
}

std::vector<std::size_t> transposition(const Node& settings, std::size_t axes) {
  const Node node = settings.at("order", "list the axes in their stored order");
  std::vector<std::size_t> order = straight(axes);
  if (node.is_string()) {  // of early drafts
    if (node.one_of({"C", "F"}) == 1) std::ranges::reverse(order);
    return order;
  }
  if (node.array_size() != axes) node.fail("does not list all axes of the array");
  std::vector<bool> seen(axes, false);
  for (std::size_t i = 0; i < axes; ++i) {
    order[i] =
        static_cast<std::size_t>(node.element(i).integer(0, static_cast<std::int64_t>(axes) - 1));
    if (seen[order[i]]) node.fail("lists an axis twice");
    seen[order[i]] = true;
  }
  return order;
}

ZarrChain parse_chain(const Node& list, const ZarrType& type, std::size_t axes, std::size_t depth) {
  constexpr std::size_t max_codecs = 16;
  ZarrChain chain;
  chain.order = straight(axes);
  if (list.array_size() > max_codecs) list.fail("has more than 16 codecs");
  bool has_bytes = false;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    const Node codec = list.element(i);
    const Node name_node = codec.is_object() ? codec.at("name", "give its name") : codec;
    std::string name = name_node.string();
    const auto settings = codec.is_object() ? codec.find("configuration") : std::nullopt;
    if (settings && !settings->is_object()) settings->fail("must be an object");
    if (!has_bytes && name == "transpose") {
      const std::vector<std::size_t> order = transposition(settings.value_or(codec), axes);
      std::vector<std::size_t> composed(axes);
      for (std::size_t a = 0; a < axes; ++a) composed[a] = chain.order[order[a]];
      chain.order = composed;
      continue;
    }
    if (!has_bytes && (name == "bytes" || name == "endian")) {
      has_bytes = true;
      if (const auto endian = settings ? settings->find("endian") : std::nullopt;
          endian && !endian->is_null()) {
        chain.big_endian = endian->one_of({"little", "big"}) == 1;
      }
      if (chain.big_endian && !chain.codecs.empty()) {
        codec.fail("filters before big-endian bytes are not read");
      }
      continue;
    }
    if (!has_bytes && name == "sharding_indexed") {
      has_bytes = true;
      if (!chain.codecs.empty()) codec.fail("filters before shards are not read");
      // Sides of inner chunks are those along the axes as they were permuted.
      chain.shards = parse_shards(settings.value_or(codec), type, axes, depth);
      continue;
    }
    if (name.starts_with("numcodecs.")) name.erase(0, 10);
    const Node* const given = settings ? &*settings : nullptr;
    chain.codecs.push_back(numcodecs_codec(name, codec, given, type));
  }
  if (!has_bytes) list.fail("has no codec that makes bytes of numbers, as \"bytes\" does");
  return chain;
}

/// Adds a codec of "compressor" or of "filters": an object with its "id".
void add_codec(const Node& node, const ZarrType& type, ZarrChain& chain) {
  const Node id = node.at("id", "give the name of the codec");
  chain.codecs.push_back(numcodecs_codec(id.string(), node, &node, type));
}

ZarrArray checked(ZarrArray array, const Node& where) {
  if (array.shape.size() != array.chunk.size()) where.fail("shape and chunks differ in their axes");
  return array;
}

/// Throws Error for members of an array that its reader must understand and that are not known.
void check_extensions(const Node& metadata) {
  constexpr std::array known = std::to_array<std::string_view>(
      {"zarr_format", "node_type", "shape", "data_type", "chunk_grid", "chunk_key_encoding",
       "fill_value", "codecs", "attributes", "storage_transformers", "dimension_names",
       "consolidated_metadata", "must_understand"});
  for (const auto& [key, value] : metadata.value().items()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    const bool may_be_left_out =
        value.is_object() && value.contains("must_understand") && value["must_understand"] == false;
    if (may_be_left_out) continue;
    metadata.fail("has an extension \"" + printable(key) +
                  "\" that a reader must understand (no must_understand: false), and this one "
                  "does not; save the array without it");
  }
}

}  // namespace

const Node& as_object(const Node& node) {
  if (!node.is_object()) node.fail("must be an object");
  return node;
}

ZarrArray parse_zarr_2(const Node& metadata) {
  ZarrArray array;
  as_object(metadata).at("zarr_format", "it must be 2").integer(2, 2);
  array.shape = sides_of(metadata.at("shape", "list the array's sides"), 0);
  array.chunk = chunk_of(metadata.at("chunks", "list the chunks' sides"), array.shape.size());
  array.type = numpy_type(metadata.at("dtype", "give the type of the numbers"));
  array.chain.big_endian = array.type.big_endian;
  array.chain.order = straight(array.shape.size());
  if (metadata.at("order", "it must be \"C\" or \"F\"").one_of({"C", "F"}) == 1) {
    std::ranges::reverse(array.chain.order);
  }
  if (const auto filters = metadata.find("filters"); filters && !filters->is_null()) {
    constexpr std::size_t max_filters = 16;
    if (filters->array_size() > max_filters) filters->fail("has more than 16 filters");
    for (std::size_t i = 0; i < filters->array_size(); ++i) {
      add_codec(filters->element(i), array.type, array.chain);
    }
  }
  if (const auto codec = metadata.find("compressor"); codec && !codec->is_null()) {
    add_codec(*codec, array.type, array.chain);
  }
  if (const auto separator = metadata.find("dimension_separator")) {
    array.separator = separator->one_of({".", "/"}) == 0 ? '.' : '/';
  }
  array.fill_text = "0";
  if (const auto fill = metadata.find("fill_value")) read_fill(*fill, array);
  return checked(std::move(array), metadata);
}

ZarrArray parse_zarr_3(const Node& metadata) {
  ZarrArray array;
  as_object(metadata).at("zarr_format", "it must be 3").integer(3, 3);
  check_extensions(metadata);
  array.shape = sides_of(metadata.at("shape", "list the array's sides"), 0);
  const Node grid = metadata.at("chunk_grid", "give the grid of chunks");
  grid.at("name", "it must be \"regular\"").one_of({"regular"});
  array.chunk =
      chunk_of(grid.at("configuration", "give the chunks' sides").at("chunk_shape", "list them"),
               array.shape.size());
  array.type = type_of_version_3(metadata.at("data_type", "give the type of the numbers"));
  array.chain =
      parse_chain(metadata.at("codecs", "list the codecs"), array.type, array.shape.size(), 0);
  const Node keys = metadata.at("chunk_key_encoding", "say how files of chunks are named");
  const bool is_default = keys.at("name", "say how").one_of({"default", "v2"}) == 0;
  array.key_prefix = is_default ? "c" : "";
  array.separator = is_default ? '/' : '.';
  if (const auto settings = keys.find("configuration")) {
    if (const auto separator = settings->find("separator")) {
      array.separator = separator->one_of({".", "/"}) == 0 ? '.' : '/';
    }
  }
  if (const auto others = metadata.find("storage_transformers");
      others && !others->is_null() && others->array_size() > 0) {
    others->fail("are not read; save the array without them");
  }
  array.fill_text = "0";
  if (const auto fill = metadata.find("fill_value")) read_fill(*fill, array);
  if (const auto names = metadata.find("dimension_names"); names && !names->is_null()) {
    for (std::size_t i = 0; i < names->array_size(); ++i) {
      const Node name = names->element(i);
      array.dimension_names.push_back(name.is_null() ? std::string() : name.string());
    }
  }
  return checked(std::move(array), metadata);
}

std::size_t zarr_chunk_values(const std::vector<std::int64_t>& chunk, const std::string& name) {
  // 2^56 values of 8 bytes, and what codecs add, are still a number of bytes.
  constexpr std::int64_t largest = std::int64_t{1} << 56;
  std::int64_t count = 1;
  for (const std::int64_t side : chunk) {
    if (count > largest / side) throw Error(name + ": has chunks that are too large to be read");
    count *= side;
  }
  return static_cast<std::size_t>(count);
}

}  // namespace pellucid
