// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Blocks in groups of 4³, all that are of each: whether data are smooth shows over several blocks.
class BlockGroups {
 public:
  explicit BlockGroups(const BlockRecords& records)
      : records_(&records),
        blocks_{records.axis[0].cells(), records.axis[1].cells(), records.axis[2].cells()} {}

  /// Returns the number of slabs of groups, one behind the other along z.
  int slabs() const noexcept { return groups(2); }

  class Group {
   public:
    /// Calls visit(block) for its blocks.
    template <class Visit>
    void each(const Visit& visit) const {
      for (int k = first_[2]; k < end_[2]; ++k) {
        for (int j = first_[1]; j < end_[1]; ++j) {
          for (int i = first_[0]; i < end_[0]; ++i) visit(records_->index(i, j, k));
        }
      }
    }

   private:
    friend class BlockGroups;
    const BlockRecords* records_;
    std::array<int, 3> first_, end_;
  };

  /// Calls visit(group) for the groups of a slab.
  template <class Visit>
  void each(int slab, const Visit& visit) const {
    Group group;
    group.records_ = records_;
    for (int j = 0; j < groups(1); ++j) {
      for (int i = 0; i < groups(0); ++i) {
        group.first_ = {i * width, j * width, slab * width};
        for (std::size_t a = 0; a < 3; ++a) {
          group.end_[a] = std::min(group.first_[a] + width, blocks_[a]);
        }
        visit(static_cast<const Group&>(group));
      }
    }
  }

 private:
  static constexpr int width = 4;
  int groups(std::size_t axis) const noexcept { return (blocks_[axis] + width - 1) / width; }

  const BlockRecords* records_;
  std::array<int, 3> blocks_;
};

/// Variation of the data of several blocks together.
struct GroupVariation {
  /// A derivative has to swing by that many times of what it changes in one cell: so it does in
  /// waves of nine cells, for which it takes π of them along a third of the wave.
  static constexpr double min_steps = 3;

  float oscillation[3] = {}, second_difference[3] = {}, twist[3] = {};  ///< as in BlockRecord

  void add(const BlockRecord& record) noexcept {
    for (int a = 0; a < 3; ++a) {
      oscillation[a] = std::max(oscillation[a], from_upper_half(record.oscillation[a]));
      second_difference[a] =
          std::max(second_difference[a], from_upper_half(record.second_difference[a]));
      twist[a] = std::max(twist[a], from_upper_half(record.twist[a]));
    }
  }

  /// Returns the most that a derivative changes in a cell.
  double most_change() const noexcept {
    return static_cast<double>(std::max({second_difference[0], second_difference[1],
                                         second_difference[2], twist[0], twist[1], twist[2]}));
  }

  /// Returns the number of cells in which the derivative swings from one end of its range to the
  /// other, the least of the axes.
  double steps() const noexcept {
    // An axis along which the data hardly bend, compared with others, is not looked at: what is
    // there may be rounding.
    constexpr float negligible = 0x1p-10f;
    std::array<float, 3> change{};
    for (std::size_t a = 0; a < 3; ++a) {
      change[a] = std::max({second_difference[a], twist[(a + 1) % 3], twist[(a + 2) % 3]});
    }
    const float largest = std::max({change[0], change[1], change[2]});
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < 3; ++a) {
      if (!(change[a] > negligible * largest)) continue;
      least = std::min(least, static_cast<double>(oscillation[a]) / static_cast<double>(change[a]));
    }
    return least;
  }
};

}  // namespace pellucid
