// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/labels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "pellucid/scene/internal/label_values.h"

namespace pellucid {
namespace {

/// Atlases of the mouse brain have some 700.
constexpr std::size_t max_labels = 1000;

template <class Value>
bool is_whole(Value value) {
  if constexpr (std::is_floating_point_v<Value>) return value == std::floor(value);
  return true;
}

template <class Value>
bool is_nan(Value value) {
  if constexpr (std::is_floating_point_v<Value>) return std::isnan(value);
  return false;
}

/// Different values, ascending, as long as all are whole and there are no more than max_labels.
template <class Value>
class DistinctValues {
 public:
  /// Returns whether the values may still be labels.
  bool add(std::span<const Value> values) {
    for (const Value value : values) {
      if (!list_.empty() && value == last_) continue;
      if (is_nan(value)) continue;
      last_ = value;
      const auto place = std::ranges::lower_bound(list_, value);
      if (place != list_.end() && *place == value) continue;
      if (!is_whole(value) || list_.size() == max_labels) return false;
      list_.insert(place, value);
    }
    return true;
  }
  std::size_t size() const { return list_.size(); }
  std::vector<double> list() const { return {list_.begin(), list_.end()}; }
  std::size_t rank(Value value) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(list_, value) - list_.begin());
  }

 private:
  std::vector<Value> list_;
  Value last_{};
};

/// Pairs of neighbours, by what they say of labels.
class NeighbourCounts {
 public:
  explicit NeighbourCounts(std::size_t values) : equal_(values), unequal_(values) {}

  void add(std::size_t a, std::size_t b) {
    if (a == b) {
      ++equal_[a];
      return;
    }
    ++unequal_[a];
    ++unequal_[b];
    ++jumps_;
    if (std::max(a, b) - std::min(a, b) > 1) ++skipping_;
  }

  bool look_like_labels() const {
    std::uint64_t all_equal = 0;
    for (const std::uint64_t count : equal_) all_equal += count;
    const auto equal = static_cast<double>(all_equal), jumps = static_cast<double>(jumps_);
    // Two values are a mask, however thin it is; white noise of two values is none.
    constexpr double least_equal = 0.6;
    if (equal < least_equal * (equal + jumps)) return false;
    if (equal_.size() == 2) return true;
    if (filled_values() < least_filled * static_cast<double>(equal_.size())) return false;
    // Smooth data step from value to value; of few values, neighbours are often next to each other.
    constexpr std::size_t few = 8;
    constexpr double min_skipping = 0.25;
    return equal_.size() <= few || static_cast<double>(skipping_) >= min_skipping * jumps;
  }

 private:
  /// Returns the number of different values that fill regions: most neighbours of such a value are
  /// equal to it. A blurred edge between two regions has many values that do not.
  double filled_values() const {
    constexpr double least = 0.55;
    double filled = 0;
    for (std::size_t i = 0; i < equal_.size(); ++i) {
      const auto equal = static_cast<double>(equal_[i]);
      // A jump counts half for either side.
      if (equal >= least * (equal + static_cast<double>(unequal_[i]) / 2)) ++filled;
    }
    return filled;
  }

  static constexpr double least_filled = 0.6;

  std::vector<std::uint64_t> equal_, unequal_;  ///< by rank of the value
  std::uint64_t jumps_ = 0, skipping_ = 0;
};

/// Some rows along x, even over the volume; all of a small one.
class SampledRows {
 public:
  explicit SampledRows(const std::array<int, 3>& dimensions)
      : nx_(static_cast<std::size_t>(dimensions[0])),
        ny_(static_cast<std::size_t>(dimensions[1])),
        rows_(ny_ * static_cast<std::size_t>(dimensions[2])) {
    constexpr std::size_t max_voxels = std::size_t{1} << 19;
    taken_ = std::clamp<std::size_t>(max_voxels / nx_, 1, rows_);
  }

  std::size_t size() const { return taken_; }
  /// Returns row n of those that are taken. The fractional parts of multiples of the golden ratio
  /// are even at every scale.
  std::size_t operator[](std::size_t n) const {
    if (taken_ == rows_) return n;
    const double s = static_cast<double>(n) / std::numbers::phi;
    const double share = s - std::floor(s);
    return std::min(static_cast<std::size_t>(share * static_cast<double>(rows_)), rows_ - 1);
  }
  std::size_t length() const { return nx_; }
  /// Returns the rows behind along y and along z; `row` itself where there is none.
  std::size_t next_y(std::size_t row) const { return row % ny_ + 1 < ny_ ? row + 1 : row; }
  std::size_t next_z(std::size_t row) const { return row + ny_ < rows_ ? row + ny_ : row; }

 private:
  std::size_t nx_, ny_, rows_, taken_;
};

/// Returns all values of data that look like labels, or that are alike as far as rows tell.
template <class Value>
std::optional<DistinctValues<Value>> find_labels(std::span<const Value> data,
                                                 const SampledRows& rows) {
  const auto row_at = [&](std::size_t row) {
    return data.subspan(row * rows.length(), rows.length());
  };
  DistinctValues<Value> sampled;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const std::size_t row = rows[n];
    for (const std::size_t at : {row, rows.next_y(row), rows.next_z(row)}) {
      if (!sampled.add(row_at(at))) return std::nullopt;
    }
  }
  DistinctValues<Value> all;
  if (sampled.size() < 2) {
    if (!all.add(data) || all.size() > 1) return std::nullopt;
    return all;
  }

  NeighbourCounts counts(sampled.size());
  constexpr std::size_t none = max_labels + 1;
  const auto fill_ranks = [&](std::size_t row, std::vector<std::size_t>& ranks) {
    const std::span<const Value> values = row_at(row);
    ranks.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool repeats = i > 0 && values[i] == values[i - 1];
      ranks[i] = repeats ? ranks[i - 1] : is_nan(values[i]) ? none : sampled.rank(values[i]);
    }
  };
  std::vector<std::size_t> here, there;
  const auto add = [&](std::size_t a, std::size_t b) {
    if (a != none && b != none) counts.add(a, b);
  };
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const std::size_t row = rows[n];
    fill_ranks(row, here);
    for (std::size_t i = 1; i < here.size(); ++i) add(here[i - 1], here[i]);
    for (const std::size_t next : {rows.next_y(row), rows.next_z(row)}) {
      if (next == row) continue;
      fill_ranks(next, there);
      for (std::size_t i = 0; i < here.size(); ++i) add(here[i], there[i]);
    }
  }
  if (!counts.look_like_labels()) return std::nullopt;

  if (!all.add(data)) return std::nullopt;
  return all;
}

}  // namespace

std::optional<std::vector<double>> label_values_of_part(const Volume& part) {
  const SampledRows rows(part.description().dimensions);
  return std::visit(
      [&](const auto& values) -> std::optional<std::vector<double>> {
        const auto found = find_labels(std::span(values.data(), values.size()), rows);
        return found ? std::optional(found->list()) : std::nullopt;
      },
      part.data());
}

std::optional<std::size_t> label_count(const Volume& volume) {
  const auto values = label_values_of_part(volume);
  return values && values->size() > 1 ? std::optional(values->size()) : std::nullopt;
}

}  // namespace pellucid
