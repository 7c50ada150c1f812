// SPDX-License-Identifier: Apache-2.0
#include "zarr_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include "memory_limit.h"
#include "pellucid/scene/error.h"
#include "stored_numbers.h"
#include "zarr_codecs.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

/// Values of a chunk in memory, and the part of the array that they are.
struct ChunkPart {
  std::span<const std::byte> bytes;
  bool big_endian = false;
  std::vector<std::int64_t> first, end;  ///< along the array's axes
  std::vector<std::size_t> strides;      ///< in values, along the array's axes
};

/// Puts chunks to their places.
class Target {
 public:
  Target() = default;
  virtual ~Target() = default;
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  virtual void put(const ChunkPart& part) = 0;
};

/// The numbers of the components that a box of the array holds, each with its place in the box.
struct ComponentPlace {
  int number = 0;
  std::size_t offset = 0;
};

class Selection {
 public:
  Selection(const ZarrArray& array, const ZarrView& view, ComponentRange range)
      : array_(array), view_(view), range_(range), sides_(view.sides(array)) {}

  /// Whether a box of the array holds anything that is asked for.
  bool touches(std::span<const std::int64_t> first, std::span<const std::int64_t> end) const {
    if (!holds_fixed(first, end)) return false;
    bool any = false;
    each_component(first, end, {}, [&](const ComponentPlace&) { any = true; });
    return any;
  }

  template <class Visit>
  void each_component(std::span<const std::int64_t> first, std::span<const std::int64_t> end,
                      std::span<const std::size_t> strides, const Visit& visit) const {
    visit_components(0, 0, 0, first, end, strides, visit);
  }

  bool holds_fixed(std::span<const std::int64_t> first, std::span<const std::int64_t> end) const {
    for (std::size_t a = 0; a < first.size(); ++a) {
      const bool free = std::ranges::find(view_.components, a) != view_.components.end() ||
                        std::ranges::find(view_.space, std::optional(a)) != view_.space.end();
      if (!free && (view_.at[a] < first[a] || view_.at[a] >= end[a])) return false;
    }
    return true;
  }
  std::size_t fixed_offset(const ChunkPart& part) const {
    std::size_t offset = 0;
    for (std::size_t a = 0; a < part.first.size(); ++a) {
      const bool free = std::ranges::find(view_.components, a) != view_.components.end() ||
                        std::ranges::find(view_.space, std::optional(a)) != view_.space.end();
      if (!free) offset += static_cast<std::size_t>(view_.at[a] - part.first[a]) * part.strides[a];
    }
    return offset;
  }

  const ZarrView& view() const { return view_; }
  const std::array<std::int64_t, 3>& sides() const { return sides_; }
  ComponentRange range() const { return range_; }

 private:
  template <class Visit>
  void visit_components(std::size_t depth, std::int64_t number, std::size_t offset,
                        std::span<const std::int64_t> first, std::span<const std::int64_t> end,
                        std::span<const std::size_t> strides, const Visit& visit) const {
    if (depth == view_.components.size()) {
      const std::int64_t within = number - range_.first;
      if (within >= 0 && within < range_.number) visit({static_cast<int>(within), offset});
      return;
    }
    const std::size_t axis = view_.components[depth];
    for (std::int64_t i = first[axis]; i < end[axis]; ++i) {
      const std::size_t step = strides.empty() ? 0 : strides[axis];
      visit_components(depth + 1, number * array_.shape[axis] + i,
                       offset + static_cast<std::size_t>(i - first[axis]) * step, first, end,
                       strides, visit);
    }
  }

  const ZarrArray& array_;
  const ZarrView& view_;
  ComponentRange range_;
  std::array<std::int64_t, 3> sides_;
};

// How stored numbers become those that are kept.
struct Truth {
  using Stored = std::uint8_t;
  static std::uint8_t keep(Stored bits) { return bits != 0 ? 1 : 0; }
};
struct Half {
  using Stored = std::uint16_t;
  static float keep(Stored bits) { return half_to_float(bits); }
};
template <class Number>
struct Same {
  using Stored = Number;
  static Number keep(Stored number) { return number; }
};

template <class Kind>
class TypedTarget : public Target {
 public:
  using Stored = typename Kind::Stored;
  using Kept = decltype(Kind::keep(Stored{}));

  TypedTarget(const Selection& selection, std::vector<std::span<Kept>> to,
              const std::array<std::byte, 8>& fill)
      : selection_(selection), to_(std::move(to)) {
    std::memcpy(&fill_, fill.data(), sizeof fill_);
    for (const std::span<Kept> values : to_) std::ranges::fill(values, fill_);
  }

  void put(const ChunkPart& part) override {
    const bool swapped = part.big_endian != (std::endian::native == std::endian::big);
    const std::size_t fixed = selection_.fixed_offset(part);
    selection_.each_component(part.first, part.end, part.strides, [&](const ComponentPlace& c) {
      const std::span<Kept> to = to_[static_cast<std::size_t>(c.number)];
      if (swapped && sizeof(Stored) > 1) {
        copy<true>(part, fixed + c.offset, to);
      } else {
        copy<false>(part, fixed + c.offset, to);
      }
    });
  }

 private:
  /// The part along x, y or z: where it begins, how long it is, how far values are apart.
  struct Run {
    std::size_t first = 0, count = 1, stride = 0;
  };
  Run run(const ChunkPart& part, std::size_t a) const {
    const auto axis = selection_.view().space[a];
    if (!axis) return {};
    return {static_cast<std::size_t>(part.first[*axis]),
            static_cast<std::size_t>(part.end[*axis] - part.first[*axis]), part.strides[*axis]};
  }

  template <bool swapped>
  void copy(const ChunkPart& part, std::size_t from, std::span<Kept> to) const {
    const Run x = run(part, 0), y = run(part, 1), z = run(part, 2);
    const auto nx = static_cast<std::size_t>(selection_.sides()[0]);
    const auto ny = static_cast<std::size_t>(selection_.sides()[1]);
    for (std::size_t k = 0; k < z.count; ++k) {
      for (std::size_t j = 0; j < y.count; ++j) {
        const std::size_t row = ((z.first + k) * ny + y.first + j) * nx + x.first;
        const std::size_t begin = from + k * z.stride + j * y.stride;
        for (std::size_t i = 0; i < x.count; ++i) {
          std::array<std::byte, sizeof(Stored)> bytes;
          std::memcpy(bytes.data(), &part.bytes[(begin + i * x.stride) * sizeof(Stored)],
                      sizeof(Stored));
          if constexpr (swapped) std::ranges::reverse(bytes);
          to[row + i] = Kind::keep(std::bit_cast<Stored>(bytes));
        }
      }
    }
  }

  const Selection& selection_;
  std::vector<std::span<Kept>> to_;
  Kept fill_{};
};

/// Reads the chunks of an array that a selection needs.
class ChunkReader {
 public:
  ChunkReader(const fs::path& folder, const ZarrArray& array, const Selection& selection,
              Target& target)
      : folder_(folder), array_(array), selection_(selection), target_(target) {}

  void read_all() {
    const std::size_t axes = array_.shape.size();
    std::vector<std::int64_t> chunk(axes, 0), grid(axes);
    for (std::size_t a = 0; a < axes; ++a) grid[a] = (array_.shape[a] - 1) / array_.chunk[a] + 1;
    do {
      read_chunk(chunk);
    } while (advance(chunk, grid));
  }

  std::size_t chunks() const { return chunks_; }
  std::size_t missing() const { return missing_; }

 private:
  /// The next index in a box, the last axis fastest; false behind the last one.
  static bool advance(std::vector<std::int64_t>& index, const std::vector<std::int64_t>& end) {
    for (std::size_t a = index.size(); a-- > 0;) {
      if (++index[a] < end[a]) return true;
      index[a] = 0;
    }
    return false;
  }

  /// A box of the array's axes, cut off where the array ends; false where nothing is left of it.
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
    ++chunks_;
    const fs::path path = file_of(chunk);
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) {
      ++missing_;
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

  /// What a chain made of a part of the array that begins at `first`. `axes` says which axis of the
  /// array each axis of the chunk is.
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
    // The chunk beside the values, which have their memory by now; codecs take as much again.
    if (const std::uintmax_t needed = std::uintmax_t{2} * bytes + 2 * source.size;
        needed > checked_) {
      check_memory(needed, source.name + ": a chunk");
      checked_ = needed;
    }
    ZarrBytes stored(static_cast<std::size_t>(source.size));
    source.read(0, stored.span());
    const ZarrBytes values = undo_codecs(chain.codecs, std::move(stored), bytes, source.name);
    put(chain, values, stored_axes, first, stored_chunk);
  }

  void put(const ZarrChain& chain, const ZarrBytes& values, const std::vector<std::size_t>& axes,
           const std::vector<std::int64_t>& first, const std::vector<std::int64_t>& chunk) {
    ChunkPart part;
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

  /// Where each of `count` chunks lies in a shard.
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
    if (entry.offset == none && entry.bytes == none) return;
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
  const Selection& selection_;
  Target& target_;
  std::size_t chunks_ = 0, missing_ = 0;
  std::uintmax_t checked_ = 0;  ///< bytes that there was memory for
};

/// A store of a byte a chunk could keep a machine busy for days.
void check_chunk_count(const ZarrArray& array, const std::string& name) {
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

template <class Kind>
void read_into(const fs::path& folder, const ZarrArray& array, const Selection& selection,
               std::vector<std::span<decltype(Kind::keep(typename Kind::Stored{}))>> to,
               const std::function<void(const std::string&)>& note) {
  TypedTarget<Kind> target(selection, std::move(to), array.fill);
  ChunkReader reader(folder, array, selection, target);
  reader.read_all();
  if (reader.missing() > 0 && note) {
    note(folder.string() + ": " + std::to_string(reader.missing()) + " of " +
         std::to_string(reader.chunks()) + " chunks are not there; their values are " +
         array.fill_text + ", the fill value");
  }
}

/// Types that volumes have, or that become one of those number by number.
template <class Kind>
std::vector<VolumeData> read_plain(const fs::path& folder, const ZarrArray& array,
                                   const Selection& selection, std::size_t points,
                                   const std::function<void(const std::string&)>& note) {
  using Kept = decltype(Kind::keep(typename Kind::Stored{}));
  const std::string name = folder.string();
  std::vector<VolumeData> list;
  std::vector<std::span<Kept>> to;
  for (int c = 0; c < selection.range().number; ++c) {
    list.push_back(make_values(kept_type(array.type), points, name));
    to.push_back(std::get<DataArray<Kept>>(list.back()).writable());
  }
  read_into<Kind>(folder, array, selection, std::move(to), note);
  return list;
}

template <class Number>
std::vector<VolumeData> read_wide(const fs::path& folder, const ZarrArray& array,
                                  const Selection& selection, std::size_t points,
                                  const std::function<void(const std::string&)>& note) {
  const auto number = static_cast<std::size_t>(selection.range().number);
  const std::string name = folder.string();
  // Chunks come in no order of the points; the type is known when all are read.
  std::vector<std::unique_ptr<Number[]>> stored;
  std::vector<std::span<Number>> to;
  for (std::size_t c = 0; c < number; ++c) {
    stored.push_back(std::make_unique_for_overwrite<Number[]>(points));
    to.emplace_back(stored.back().get(), points);
  }
  read_into<Same<Number>>(folder, array, selection, std::move(to), note);
  const auto make = [&](const std::string& type) { return make_values(type, points, name); };
  std::vector<WholeNumbers> components;
  components.reserve(number);
  for (std::unique_ptr<Number[]>& numbers : stored) {
    components.emplace_back(make);
    components.back().add(std::span<const Number>(numbers.get(), points));
    numbers.reset();
  }
  return take_components(components, points, name, note);
}

}  // namespace

std::array<std::int64_t, 3> ZarrView::sides(const ZarrArray& array) const {
  std::array<std::int64_t, 3> result{1, 1, 1};
  for (std::size_t a = 0; a < 3; ++a) {
    if (space[a]) result[a] = array.shape[*space[a]];
  }
  return result;
}

int ZarrView::component_count(const ZarrArray& array, const std::string& name) const {
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  std::int64_t count = 1;
  for (const std::size_t axis : components) {
    const std::int64_t side = array.shape[axis];
    if (side < 1) throw Error(name + ": has an axis without entries");
    if (count > most / side) throw Error(name + ": has too many components");
    count *= side;
  }
  return static_cast<int>(count);
}

std::string kept_type(const ZarrType& type) {
  if (type.name == "b1") return "u8";
  if (type.name == "f16") return "f32";
  return type.name == "i64" || type.name == "u64" ? "f64" : type.name;
}

std::vector<VolumeData> read_zarr_values(const fs::path& folder, const ZarrArray& array,
                                         const ZarrView& view, ComponentRange range,
                                         const std::function<void(const std::string&)>& note) {
  const std::string name = folder.string();
  const Selection selection(array, view, range);
  const std::size_t points = value_count(view.sides(array), name);
  const std::size_t count = value_count(points, range.number, name);
  check_chunk_count(array, name);
  const std::string& type = array.type.name;
  const bool is_wide = type == "i64" || type == "u64";
  check_memory(std::uintmax_t{count} * value_size(kept_type(array.type), name) * (is_wide ? 2 : 1),
               name + ": its values");
  const auto plain = [&]<class Kind>(Kind) {
    return read_plain<Kind>(folder, array, selection, points, note);
  };
  if (type == "b1") return plain(Truth{});
  if (type == "u8") return plain(Same<std::uint8_t>{});
  if (type == "i8") return plain(Same<std::int8_t>{});
  if (type == "u16") return plain(Same<std::uint16_t>{});
  if (type == "i16") return plain(Same<std::int16_t>{});
  if (type == "u32") return plain(Same<std::uint32_t>{});
  if (type == "i32") return plain(Same<std::int32_t>{});
  if (type == "f16") return plain(Half{});
  if (type == "f32") return plain(Same<float>{});
  if (type == "f64") return plain(Same<double>{});
  return type == "i64" ? read_wide<std::int64_t>(folder, array, selection, points, note)
                       : read_wide<std::uint64_t>(folder, array, selection, points, note);
}

std::vector<double> read_zarr_line(const fs::path& folder, const ZarrArray& array,
                                   std::size_t most) {
  const std::string name = folder.string();
  if (array.shape.size() != 1 || array.shape[0] < 1 ||
      static_cast<std::uint64_t>(array.shape[0]) > most) {
    throw Error(name + ": is no list of positions");
  }
  ZarrView view;
  view.space[0] = 0;
  view.at = {0};
  const std::vector<VolumeData> values = read_zarr_values(folder, array, view, {0, 1}, {});
  std::vector<double> line;
  std::visit(
      [&](const auto& list) {
        for (std::size_t i = 0; i < list.size(); ++i) line.push_back(static_cast<double>(list[i]));
      },
      values.front());
  return line;
}

}  // namespace pellucid
