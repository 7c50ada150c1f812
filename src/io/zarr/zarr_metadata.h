// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "text/json_file.h"

namespace pellucid {

/// A number type as Zarr stores it.
struct ZarrType {
  std::string name;  ///< "u8" … "f64", and what volumes have not: "b1", "i64", "u64", "f16"
  std::size_t bytes = 1;
  bool big_endian = false;
};

/// One step that turns bytes into other bytes when a chunk is written.
struct ZarrCodec {
  enum class Kind {
    blosc,
    bzip2,
    check_behind,   ///< 4 bytes of a checksum behind that is not verified
    check_crc32,    ///< 4 bytes in front
    check_adler32,  ///< 4 bytes in front
    check_crc32c,   ///< 4 bytes behind
    convert,        ///< numbers of another type, scaled
    deflate,        ///< gzip or zlib
    delta,
    lz4,
    packbits,
    same,     ///< changes values before they are stored, nothing when they are read
    shuffle,  ///< bytes of equal weight side by side
    zstd
  };
  Kind kind = Kind::same;
  std::string name;           ///< for messages
  std::size_t element = 1;    ///< shuffle: bytes of an element
  ZarrType decoded, encoded;  ///< convert and delta
  double scale = 1, offset = 0;
};

struct ZarrShards;

/// Way in which a chunk becomes bytes: the axes are permuted, the values or smaller chunks of them
/// become bytes in C order, the codecs follow in their order.
struct ZarrChain {
  std::vector<std::size_t> order;  ///< the stored axes, by their places among the chunk's
  bool big_endian = false;
  std::shared_ptr<const ZarrShards> shards;  ///< null: values
  std::vector<ZarrCodec> codecs;
};

/// A chunk that holds smaller ones, and an index of where they begin.
struct ZarrShards {
  std::vector<std::int64_t> chunk;  ///< along the stored axes
  ZarrChain chain;                  ///< of each
  bool index_in_front = false, big_endian_index = false, checked_index = false;
};

/// An array's metadata, of .zarray or zarr.json.
struct ZarrArray {
  std::vector<std::int64_t> shape, chunk;
  ZarrType type;
  ZarrChain chain;
  std::array<std::byte, 8> fill{};  ///< value of missing chunks: in memory, f16 as f32
  std::string fill_text;            ///< for notes
  bool has_fill = false;            ///< whether the metadata state one
  std::string key_prefix;           ///< of files of chunks: "" or "c"
  char separator = '.';
  std::string note;  ///< on files that are not as the metadata say; begins with "its"
  std::vector<std::string> dimension_names;  ///< "" where one has no name; empty: none has
};

inline constexpr std::size_t max_zarr_axes = 32;

/// Returns the node. Fails unless it is an object.
const scene_json::Node& as_object(const scene_json::Node& node);

/// A group or an array of a store.
struct ZarrNode {
  std::filesystem::path folder;
  int version = 2;
  bool is_array = false;
  JsonFile metadata;
  JsonFile attributes;  ///< its root is an object
};

/// Reads the metadata of a folder; nothing where it is no node of a store. Throws Error.
std::optional<ZarrNode> read_zarr_node(const std::filesystem::path& folder);
/// Returns the array that a node describes. Throws Error for what is wrong or not read.
ZarrArray zarr_array(const ZarrNode& node);

/// The parsers of both versions, apart for tests and fuzzing.
ZarrArray parse_zarr_2(const scene_json::Node& metadata);
ZarrArray parse_zarr_3(const scene_json::Node& metadata);

/// Returns the number of values of a chunk. Throws Error that begins with `name` where no machine
/// holds it.
std::size_t zarr_chunk_values(const std::vector<std::int64_t>& chunk, const std::string& name);

}  // namespace pellucid
