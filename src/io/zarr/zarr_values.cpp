// SPDX-License-Identifier: Apache-2.0
#include "zarr_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "files/memory_limit.h"
#include "pellucid/scene/error.h"
#include "volumes/stored_numbers.h"
#include "zarr_chunks.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

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
class TypedTarget : public ZarrTarget {
 public:
  using Stored = typename Kind::Stored;
  using Kept = decltype(Kind::keep(Stored{}));

  TypedTarget(const ZarrSelection& selection, std::vector<std::span<Kept>> to,
              const std::array<std::byte, 8>& fill)
      : selection_(selection), to_(std::move(to)) {
    std::memcpy(&fill_, fill.data(), sizeof fill_);
    for (const std::span<Kept> values : to_) std::ranges::fill(values, fill_);
  }

  void put(const ZarrChunkPart& part) override {
    const bool swapped = part.big_endian != (std::endian::native == std::endian::big);
    const std::size_t fixed = selection_.fixed_offset(part);
    selection_.each_component(part.first, part.end, part.strides,
                              [&](const ZarrSelection::Place& c) {
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
  Run run(const ZarrChunkPart& part, std::size_t a) const {
    const auto axis = selection_.view().space[a];
    if (!axis) return {};
    return {static_cast<std::size_t>(part.first[*axis]),
            static_cast<std::size_t>(part.end[*axis] - part.first[*axis]), part.strides[*axis]};
  }

  template <bool swapped>
  void copy(const ZarrChunkPart& part, std::size_t from, std::span<Kept> to) const {
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

  const ZarrSelection& selection_;
  std::vector<std::span<Kept>> to_;
  Kept fill_{};
};

template <class Kind>
void read_into(const fs::path& folder, const ZarrArray& array, const ZarrSelection& selection,
               std::vector<std::span<decltype(Kind::keep(typename Kind::Stored{}))>> to,
               const std::function<void(const std::string&)>& note) {
  TypedTarget<Kind> target(selection, std::move(to), array.fill);
  const ZarrChunkCounts counts = read_zarr_chunks(folder, array, selection, target);
  if (!note) return;
  const std::string end = " are not there; they have the fill value, " + array.fill_text;
  const auto of = [](std::size_t missing, std::size_t all) {
    return std::to_string(missing) + " of " + std::to_string(all);
  };
  if (counts.missing > 0) {
    note(folder.string() + ": " + of(counts.missing, counts.all) + " chunks" + end);
  }
  if (counts.missing_in_shards > 0) {
    note(folder.string() + ": " + of(counts.missing_in_shards, counts.all_in_shards) +
         " chunks in shards" + end);
  }
}

/// Types that volumes have, or that become one of those number by number.
template <class Kind>
std::vector<VolumeData> read_plain(const fs::path& folder, const ZarrArray& array,
                                   const ZarrSelection& selection, std::size_t points,
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
                                  const ZarrSelection& selection, std::size_t points,
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
  const ZarrSelection selection(array, view, range);
  const std::size_t points = value_count(view.sides(array), name);
  const std::size_t count = value_count(points, range.number, name);
  check_zarr_chunks(array, name);
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
