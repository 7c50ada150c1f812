// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pellucid/render/transfer_tables.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// BlockClass::roughness of any two codes, in two look-ups: the maxima over runs of 2^n bins, each
/// of a few codes, for every n and every begin of a run. A bin that a range touches counts as a
/// whole: for data of 8 or 12 bits it has one step.
class BlockRoughness {
 public:
  BlockRoughness(const BlockCode& code, const TransferTables& transfer, double largest_color,
                 const ParallelFor& parallel);

  struct Range {
    std::uint16_t roughness;
    double of_sample;  ///< SmoothBlocks::roughness
    /// Whether neither extinction nor color is ever more than four times as steep as it has to be
    /// to get from its least value in the range to its largest: no peak is narrower than that.
    /// Where the extinction only rises, or only falls, there is none: then 32 times, for a ramp may
    /// begin near an end of the range; and colors count where anything absorbs.
    bool steady;
  };

  /// lower < upper, with no jump between or at them.
  Range operator()(int lower, int upper) const noexcept;

 private:
  static constexpr int most_bins = 4096;

  /// What bounds need of a transfer function over a range (RangeSummary), rounded outward.
  struct Bin {
    float slope = 0, color_slope = 0;
    bool rises = false, falls = false;           ///< anywhere in it
    float absorbing_from = 0, absorbing_to = 0;  ///< the values; alike: none
    float color_rate = 0;                        ///< largest |color'| where anything absorbs
    float least = 0, most = 0;                   ///< extinction
    float color_min[3], color_max[3];
    void merge(const Bin& other) noexcept;
  };
  static void add_lines(const PiecewiseLinear<double>& table, double lower, double upper, Bin& bin);
  Bin make_bin(int bin, const TransferTables& transfer) const;

  BlockCode code_;
  double largest_color_;
  int shift_ = 0;  ///< a bin has 2^shift steps of the code
  std::size_t bins_ = 1;
  std::vector<std::vector<Bin>> runs_;  ///< [n][begin]
};

}  // namespace pellucid
