// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "block_levels.h"
#include "block_roughness.h"
#include "block_smoothness.h"
#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/traverse/block_code.h"

namespace pellucid {
namespace {

/// Summary of a transfer function between any two codes, each in two look-ups. Exact: where it is
/// said to be zero or constant it is so at every value of the closed range, and the other way
/// round.
class CodeTable {
 public:
  CodeTable(const BlockCode& code, const TransferTables& transfer)
      : code_(code), last_(transfer.wide.count - 1), at_(static_cast<std::size_t>(code.last) + 1) {
    const PiecewiseLinear<double>& table = transfer.wide;
    const PiecewiseLinearAntiderivative<double>& antiderivative = transfer.wide_antiderivative;
    int below = 0, up_to = 0;
    for (int c = 0; c <= code.last; ++c) {
      const double value = code.value(c);
      while (below < table.count && table.value[below] < value) ++below;
      while (up_to < table.count && table.value[up_to] <= value) ++up_to;
      const bool absorbs = table.evaluate_in(up_to, value).extinction > 0;
      at_[static_cast<std::size_t>(c)] = {below, up_to, absorbs};
    }
    int absorbing = 0, clear = 0, changes = 0, jumps = 0;
    for (int i = 0; i < table.count; ++i) {
      const Material<double>& m = table.material[i];
      if (i > 0) {
        if (!table.is_constant(i, i)) ++changes;
        const RangeSummary<double>& s = antiderivative.node[antiderivative.leaves + i - 1];
        if (!(s.slope_max < s.infinity && s.color_slope < s.infinity)) ++jumps;
      }
      ++(m.extinction > 0 ? absorbing : clear);
      sums_.push_back({absorbing, clear, changes, jumps});
    }
  }

  /// Returns whether nothing absorbs at any value from that of code `lower` to that of `upper`.
  bool is_clear(int lower, int upper) const noexcept {
    const Span s = span(lower, upper);
    return sums_[s.last].absorbing == (s.first == 0 ? 0 : sums_[s.first - 1].absorbing);
  }
  /// Returns whether all of these values absorb; of a jump at `lower` what is above it.
  bool absorbs_throughout(int lower, int upper) const noexcept {
    const Place &p = at_[static_cast<std::size_t>(lower)],
                &q = at_[static_cast<std::size_t>(upper)];
    const auto clear_below = [&](int point) {
      return point > 0 ? sums_[static_cast<std::size_t>(point - 1)].clear : 0;
    };
    return p.absorbs && q.absorbs && clear_below(p.up_to) == clear_below(q.up_to);
  }
  bool is_constant(int lower, int upper) const noexcept {
    if (code_.value(lower) == code_.value(upper)) return true;  // two codes may be one number
    const Span s = span(lower, upper);
    return sums_[s.last].changes == sums_[s.first].changes;
  }
  /// Returns whether the extinction, or a color that is seen, jumps at any of these values.
  bool has_jump(int lower, int upper) const noexcept {
    const Span s = span(lower, upper);
    return sums_[s.last].jumps != sums_[s.first].jumps;
  }

 private:
  /// Numbers of control points below the value of a code and not above it, and whether it absorbs.
  struct Place {
    int below, up_to;
    bool absorbs;
  };
  /// The control points that the function in a range depends on.
  struct Span {
    std::size_t first, last;
  };
  /// Over the points up to one: those that absorb and those that do not, those unlike their left
  /// neighbour, and those that are reached by a jump.
  struct Sums {
    int absorbing, clear, changes, jumps;
  };

  Span span(int lower, int upper) const noexcept {
    const Place p = at_[static_cast<std::size_t>(lower)], q = at_[static_cast<std::size_t>(upper)];
    // At a control point, and at the right one of two, its material alone holds. Below the first
    // and above the last theirs does.
    const int first = p.up_to > 0 ? p.up_to - 1 : 0;
    const int last = q.up_to > q.below ? q.up_to - 1 : q.below;
    return {static_cast<std::size_t>(first), static_cast<std::size_t>(last < last_ ? last : last_)};
  }

  BlockCode code_;
  int last_;
  std::vector<Place> at_;
  std::vector<Sums> sums_;
};

/// Blocks that may be sampled, and those of them in which all values absorb.
struct SampledCounts {
  int all = 0, throughout = 0;

  double share_throughout() const noexcept {
    return all > 0 ? static_cast<double>(throughout) / static_cast<double>(all) : 0;
  }
};

/// Returns the class of a block. `sampled`: as find_smooth_blocks() wants it.
BlockClass classify(const BlockRecord& record, const CodeTable& codes,
                    const BlockRoughness& roughness, SampledBlock& sampled,
                    SampledCounts& counts) noexcept {
  sampled = {};
  const BlockVacuum vacuum = record.vacuum();
  if (vacuum == BlockVacuum::all || codes.is_clear(record.lower, record.upper)) {
    return {0, BlockKind::skip, 0};
  }
  constexpr std::uint16_t infinite = 0x7f80;
  if (vacuum != BlockVacuum::none) return {infinite, BlockKind::cells, 0};
  if (codes.is_constant(record.lower, record.upper)) {
    return {0, BlockKind::constant, 0};
  }
  if (codes.has_jump(record.lower, record.upper)) return {infinite, BlockKind::cells, 0};
  const BlockRoughness::Range range = roughness(record.lower, record.upper);
  sampled = {float_above(range.of_sample), static_cast<float>(range.steps)};
  if (!(sampled.roughness < 0)) {
    ++counts.all;
    if (codes.absorbs_throughout(record.lower, record.upper)) ++counts.throughout;
  }
  return {range.roughness, BlockKind::cells, 0};
}

}  // namespace

BlockClassesStorage::BlockClassesStorage(const BlockRecords& records,
                                         const TransferTables& transfer, double largest_color,
                                         const ParallelFor& parallel,
                                         const std::function<StepLimits(double)>& limits)
    : classes_(static_cast<std::size_t>(records.count())) {
  const ParallelFor run = parallel_or_serial(parallel);
  const CodeTable codes(records.code, transfer);
  const BlockRoughness roughness(records.code, transfer, largest_color, run);
  std::vector<SampledBlock> sampled(limits ? classes_.size() : 0);
  SampledCounts counts;
  std::mutex mutex;
  run(records.count(), [&](int first, int last) {
    SampledBlock unused;
    SampledCounts own;
    for (int i = first; i < last; ++i) {
      const auto b = static_cast<std::size_t>(i);
      classes_[b] =
          classify(records[i], codes, roughness, sampled.empty() ? unused : sampled[b], own);
    }
    const std::lock_guard lock(mutex);
    counts.all += own.all;
    counts.throughout += own.throughout;
  });
  const std::array<int, 3> count{records.axis[0].cells(), records.axis[1].cells(),
                                 records.axis[2].cells()};
  find_block_levels(count, BlockKind::skip, run, classes_.data());
  if (!limits) return;
  const StepLimits of_steps = limits(counts.share_throughout());
  smooth_ = find_smooth_blocks(records, std::move(sampled), of_steps, run, classes_.data(), local_);
  if (!(smooth_.longest_step > 0)) return;
  find_block_levels(count, BlockKind::smooth, run, classes_.data());
}

}  // namespace pellucid
