// SPDX-License-Identifier: Apache-2.0
#include "zarr_chunks.h"

#include <bit>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

#include "files/memory_limit.h"
#include "pellucid/scene/error.h"
#include "zarr_codecs.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

/// Reads the chunks of an array that a selection needs.
class ChunkReader {
 public:
  ChunkReader(const fs::path& folder, const ZarrArray& array, const ZarrSelection& selection,
              ZarrTarget& target)
      : folder_(folder), array_(array), selection_(selection), target_(target) {}

  void read_all() {
    const std::size_t axes = array_.shape.size();
    std::vector<std::int64_t> chunk(axes, 0), grid(axes);
    for (std::size_t a = 0; a < axes; ++a) grid[a] = (array_.shape[a] - 1) / array_.chunk[a] + 1;
    do {
      read_chunk(chunk);
    } while (advance(chunk, grid));
  }

  const ZarrChunkCounts& counts() const { return counts_; }

 private:
  /// Finds the next index in a box, the last axis fastest; false behind the last one.
  static bool advance(std::vector<std::int64_t>& index, const std::vector<std::int64_t>& end) {
    for (std::size_t a = index.size(); a-- > 0;) {
      if (++index[a] < end[a]) return true;
      index[a] = 0;
    }
    return false;
  }

  /// Finds a box of the array's axes, cut off where the array ends; false where nothing is left of
  /// it.
  bool clip(std::vector<std::int64_t>& end, const std::vector<std::int64_t>& first) const {
    for (std::size_t a = 0; a < end.size(); ++a) {
      if (first[a] >= array_.shape[a]) return false;
      end[a] = std::min(end[a], array_.shape[a]);
    }
    return true;
  }

  void read_chunk(const std::vector<std::int64_t>& chunk) {
    const std::size_t axes = chunk.size();
    std::vector<std::int64_t> first(axes), end(axes);
    std::vector<std::size_t> straight(axes);
    for (std::size_t a = 0; a < axes; ++a) {
      first[a] = chunk[a] * array_.chunk[a];
      end[a] = first[a] + array_.chunk[a];
      straight[a] = a;
    }
    clip(end, first);
    if (!selection_.touches(first, end)) return;
    ++counts_.all;
    const fs::path path = file_of(chunk);
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) {
      ++counts_.missing;
      return;
    }
    read_chain(array_.chain, file_source(path), straight, first, array_.chunk);
  }

  fs::path file_of(const std::vector<std::int64_t>& chunk) const {
    std::string key = array_.key_prefix;
    for (const std::int64_t i : chunk) {
      if (!key.empty()) key += array_.separator;
      key += std::to_string(i);
    }
    return folder_ / (key.empty() ? "0" : key);
  }

  /// Reads what a chain made of a part of the array that begins at `first`. `axes` says which axis
  /// of the array each axis of the chunk is.
  void read_chain(const ZarrChain& chain, const ByteSource& source,
                  const std::vector<std::size_t>& axes, const std::vector<std::int64_t>& first,
                  const std::vector<std::int64_t>& chunk) {
    std::vector<std::size_t> stored_axes;
    std::vector<std::int64_t> stored_chunk;
    for (const std::size_t place : chain.order) {
      stored_axes.push_back(axes[place]);
      stored_chunk.push_back(chunk[place]);
    }
    if (chain.shards && chain.codecs.empty()) {
      read_shards(*chain.shards, source, stored_axes, first, stored_chunk);
      return;
    }
    if (chain.shards) {
      throw Error(source.name + ": shards that are compressed as a whole are not read");
    }
    const std::size_t bytes = zarr_chunk_values(chunk, source.name) * array_.type.bytes;
    if (ZarrInflation::takes(chain.codecs)) {
      read_slabs(chain, source, stored_axes, first, stored_chunk, bytes);
      return;
    }
    // The chunk beside the values, which have their memory by now; codecs take as much again.
    check_memory_of_chunk(std::uintmax_t{2} * bytes + 2 * source.size, source.name);
    ZarrBytes stored(static_cast<std::size_t>(source.size));
    source.read(0, stored.span());
    const ZarrBytes values = undo_codecs(chain.codecs, std::move(stored), bytes, source.name);
    put(chain, values, stored_axes, first, stored_chunk);
  }

  void check_memory_of_chunk(std::uintmax_t needed, const std::string& name) {
    if (needed <= checked_) return;
    check_memory(needed, name + ": a chunk");
    checked_ = needed;
  }

  /// Inflates the `bytes` of a chunk slab by slab, and puts each to its place, so that the chunk is
  /// never there as a whole, neither compressed nor inflated.
  void read_slabs(const ZarrChain& chain, const ByteSource& source,
                  const std::vector<std::size_t>& axes, const std::vector<std::int64_t>& first,
                  const std::vector<std::int64_t>& chunk, std::size_t bytes) {
    constexpr std::size_t wanted = std::size_t{1} << 20;
    std::size_t cut = 0;  // slabs are cut off along the first axis that can be
    while (cut + 1 < chunk.size() && chunk[cut] == 1) ++cut;
    const std::int64_t side = chunk.empty() ? 1 : chunk[cut];
    const std::size_t layer = bytes / static_cast<std::size_t>(side);
    const std::int64_t most = std::max<std::int64_t>(1, static_cast<std::int64_t>(wanted / layer));
    // What is inflated for hours without end is not data.
    check_memory_of_chunk(bytes, source.name);
    std::uintmax_t at = 0;
    ZarrInflation inflation(
        chain.codecs.front(),
        [&](std::span<std::byte> to) {
          const auto part =
              static_cast<std::size_t>(std::min<std::uintmax_t>(to.size(), source.size - at));
          source.read(at, to.first(part));
          at += part;
          return part;
        },
        source.name);
    std::vector<std::int64_t> begin = first, slab = chunk;
    for (std::int64_t done = 0; done < side;) {
      const std::int64_t count = std::min(most, side - done);
      ZarrBytes values(layer * static_cast<std::size_t>(count));
      inflation.read(values.span());
      if (!chunk.empty()) {
        begin[axes[cut]] = first[axes[cut]] + done;
        slab[cut] = count;
      }
      put(chain, values, axes, begin, slab);
      done += count;
    }
    inflation.expect_end();
  }

  void put(const ZarrChain& chain, const ZarrBytes& values, const std::vector<std::size_t>& axes,
           const std::vector<std::int64_t>& first, const std::vector<std::int64_t>& chunk) {
    ZarrChunkPart part;
    part.bytes = values.span();
    part.big_endian = chain.big_endian;
    part.first = first;
    part.end = first;
    part.strides.resize(axes.size());
    std::size_t stride = 1;
    for (std::size_t i = axes.size(); i-- > 0;) {
      part.strides[axes[i]] = stride;
      part.end[axes[i]] += chunk[i];
      stride *= static_cast<std::size_t>(chunk[i]);
    }
    if (clip(part.end, part.first) && selection_.holds_fixed(part.first, part.end)) {
      target_.put(part);
    }
  }

  struct Entry {
    std::uint64_t offset = 0, bytes = 0;
  };

  /// Returns the place of each of `count` chunks in a shard.
  std::vector<Entry> read_index(const ZarrShards& shards, const ByteSource& source,
                                std::size_t count) const {
    constexpr std::size_t checksum = 4;
    const std::size_t entries = count * sizeof(Entry);
    const std::size_t size = entries + (shards.checked_index ? checksum : 0);
    if (source.size < size) {
      throw Error(source.name + ": is shorter than the index of its chunks; it is cut off");
    }
    check_memory(std::uintmax_t{2} * size, source.name + ": the index of its chunks");
    ZarrBytes bytes(size);
    source.read(shards.index_in_front ? 0 : source.size - size, bytes.span());
    std::vector<Entry> index(count);
    std::memcpy(index.data(), bytes.span().data(), entries);
    const bool swapped = shards.big_endian_index != (std::endian::native == std::endian::big);
    const auto turned = [&](std::uint64_t number) {
      auto raw = std::bit_cast<std::array<std::byte, 8>>(number);
      if (swapped) std::ranges::reverse(raw);
      return std::bit_cast<std::uint64_t>(raw);
    };
    for (Entry& entry : index) entry = {turned(entry.offset), turned(entry.bytes)};
    if (shards.checked_index) {
      std::uint32_t said = 0;
      for (std::size_t i = 4; i-- > 0;) {
        said = said << 8 | std::to_integer<std::uint32_t>(bytes.span()[entries + i]);
      }
      if (crc32c(bytes.span().first(entries)) != said) {
        throw Error(source.name + ": the checksum of the index of its chunks is wrong; it is " +
                    "damaged or cut off");
      }
    }
    return index;
  }

  void read_shards(const ZarrShards& shards, const ByteSource& source,
                   const std::vector<std::size_t>& axes, const std::vector<std::int64_t>& first,
                   const std::vector<std::int64_t>& shard) {
    const std::size_t rank = axes.size();
    std::vector<std::int64_t> grid(rank), inner(rank, 0);
    constexpr std::int64_t most = std::int64_t{1} << 26;
    std::int64_t count = 1;
    for (std::size_t i = 0; i < rank; ++i) {
      grid[i] = shard[i] / shards.chunk[i];
      if (grid[i] * shards.chunk[i] != shard[i]) {
        throw Error(source.name + ": a shard's sides are no multiples of its chunks'");
      }
      if (count > most / grid[i]) throw Error(source.name + ": has too many chunks in a shard");
      count *= grid[i];
    }
    const std::vector<Entry> index = read_index(shards, source, static_cast<std::size_t>(count));
    auto entry = index.begin();
    do {
      read_inner(shards, source, *entry++, axes, first, inner);
    } while (advance(inner, grid));
  }

  void read_inner(const ZarrShards& shards, const ByteSource& source, const Entry& entry,
                  const std::vector<std::size_t>& axes, const std::vector<std::int64_t>& first,
                  const std::vector<std::int64_t>& inner) {
    std::vector<std::int64_t> begin = first, end = first;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      begin[axes[i]] += inner[i] * shards.chunk[i];
      end[axes[i]] = begin[axes[i]] + shards.chunk[i];
    }
    if (!clip(end, begin) || !selection_.touches(begin, end)) return;
    constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
    ++counts_.all_in_shards;
    if (entry.offset == none && entry.bytes == none) {
      ++counts_.missing_in_shards;
      return;
    }
    if (entry.offset > source.size || entry.bytes > source.size - entry.offset) {
      throw Error(source.name + ": the index of its chunks points beyond its end; it is damaged " +
                  "or cut off");
    }
    const ByteSource part{
        source.name,
        entry.bytes,
        [&](std::uintmax_t from, std::span<std::byte> to) { source.read(entry.offset + from, to); },
        {}};
    read_chain(shards.chain, part, axes, begin, shards.chunk);
  }

  const fs::path& folder_;
  const ZarrArray& array_;
  const ZarrSelection& selection_;
  ZarrTarget& target_;
  ZarrChunkCounts counts_;
  std::uintmax_t checked_ = 0;  ///< bytes that there was memory for
};

}  // namespace

ZarrChunkCounts read_zarr_chunks(const fs::path& folder, const ZarrArray& array,
                                 const ZarrSelection& selection, ZarrTarget& target) {
  ChunkReader reader(folder, array, selection, target);
  reader.read_all();
  return reader.counts();
}

void check_zarr_chunks(const ZarrArray& array, const std::string& name) {
  constexpr std::int64_t most = std::int64_t{1} << 24;
  std::int64_t count = 1;
  for (std::size_t a = 0; a < array.shape.size(); ++a) {
    const std::int64_t side = (array.shape[a] - 1) / array.chunk[a] + 1;
    if (count > most / side) {
      throw Error(name +
                  ": has more than 16 million chunks, which would be as many files; save it "
                  "in larger ones");
    }
    count *= side;
  }
}

}  // namespace pellucid
