// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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
    /// By how many times the slopes' range is more than what they go to and fro in an eighth; at
    /// most 8. Corners at which they change for good are not to and fro.
    double steps;
  };

  /// Returns the roughness of a range of data, lower < upper, with no jump between or at them.
  Range operator()(int lower, int upper) const noexcept;

 private:
  static constexpr int max_bins = 4096;

  /// Extinction and the channels of the color.
  static constexpr std::size_t curves = 4;

  /// Slopes of the curves in a bin; `variation` is the total one.
  struct Slopes {
    std::array<double, curves> first{}, last{}, variation{};
  };
  /// Bounds of a transfer function over a range (RangeSummary), rounded outward.
  struct Bin {
    float slope = 0, color_slope = 0;
    float color_min[3], color_max[3];
    float most = 0;                              ///< extinction
    float slope_min[curves], slope_max[curves];  ///< of each curve
    void merge(const Bin& other) noexcept;
    double range(std::size_t curve) const noexcept;
    /// Returns the largest error of a sample per change of a curve's slope.
    double weight(std::size_t curve, double largest_color) const noexcept;
  };
  Bin make_bin(int bin, const TransferTables& transfer, Slopes& slopes) const;
  void find_slopes(const PiecewiseLinear<double>& table, double lower, double upper, Bin& bin,
                   Slopes& slopes) const;
  Bin over(std::size_t first, std::size_t count) const noexcept;
  /// Returns the variation of a curve's slopes, there and back, over `count` bins from `first` on,
  /// whose range is `range`.
  double to_and_fro(std::size_t first, std::size_t count, std::size_t curve,
                    double range) const noexcept;

  BlockCode code_;
  double largest_color_;
  int shift_ = 0;  ///< a bin has 2^shift steps of the code
  std::size_t bins_ = 1;
  std::vector<std::vector<Bin>> runs_;  ///< [n][begin]
  /// The total variation of the slopes up to the begin of a bin, without and with what they change
  /// by there.
  std::vector<std::array<double, curves>> before_, up_to_;
};

}  // namespace pellucid
