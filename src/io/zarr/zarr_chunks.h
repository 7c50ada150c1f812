// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zarr_metadata.h"
#include "zarr_values.h"

namespace pellucid {

/// Values of a chunk in memory, and the part of the array that they are.
struct ZarrChunkPart {
  std::span<const std::byte> bytes;
  bool big_endian = false;
  std::vector<std::int64_t> first, end;  ///< along the array's axes
  std::vector<std::size_t> strides;      ///< in values, along the array's axes
};

/// Puts chunks to their places.
class ZarrTarget {
 public:
  ZarrTarget() = default;
  virtual ~ZarrTarget() = default;
  ZarrTarget(const ZarrTarget&) = delete;
  ZarrTarget& operator=(const ZarrTarget&) = delete;
  virtual void put(const ZarrChunkPart& part) = 0;
};

/// The part of an array that is wanted.
class ZarrSelection {
 public:
  /// A component that is wanted, and its place in a box, in values.
  struct Place {
    int number = 0;
    std::size_t offset = 0;
  };

  ZarrSelection(const ZarrArray& array, const ZarrView& view, ComponentRange range)
      : array_(array), view_(view), range_(range), sides_(view.sides(array)) {}

  /// Returns whether a box of the array holds anything that is asked for.
  bool touches(std::span<const std::int64_t> first, std::span<const std::int64_t> end) const {
    if (!holds_fixed(first, end)) return false;
    bool any = false;
    each_component(first, end, {}, [&](const Place&) { any = true; });
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
  std::size_t fixed_offset(const ZarrChunkPart& part) const {
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

/// Chunks that the selection needs, and those of them that are not there.
struct ZarrChunkCounts {
  std::size_t all = 0, missing = 0;
  std::size_t all_in_shards = 0, missing_in_shards = 0;
};

/// Reads the chunks of an array that a selection needs. Throws Error.
ZarrChunkCounts read_zarr_chunks(const std::filesystem::path& folder, const ZarrArray& array,
                                 const ZarrSelection& selection, ZarrTarget& target);

/// Throws Error for more than 16 million chunks, which would keep a machine busy for days.
void check_zarr_chunks(const ZarrArray& array, const std::string& name);

}  // namespace pellucid
