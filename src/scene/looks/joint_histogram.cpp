// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/joint_histogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <string>
#include <type_traits>

#include "message.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

[[noreturn]] void refuse_histogram(const std::string& what) {
  throw Error("histogram: " + what);
}

void check_bins(int bins) {
  if (bins < 1 || bins > max_histogram_bins) {
    refuse_histogram("bins is " + std::to_string(bins) + ", but must be from 1 to " +
                     std::to_string(max_histogram_bins));
  }
}

std::size_t check_axes(const std::vector<HistogramAxis>& axes) {
  std::size_t all = 1;
  for (const HistogramAxis& axis : axes) {
    check_bins(axis.bins);
    if (!(axis.lower < axis.upper) || !std::isfinite(axis.upper - axis.lower)) {
      refuse_histogram("the axis from " + number(axis.lower) + " to " + number(axis.upper) +
                       " is empty or endless; give two finite values, the lower one first");
    }
    all *= static_cast<std::size_t>(axis.bins);
    if (all > static_cast<std::size_t>(max_histogram_bins)) {
      refuse_histogram("there are more than " + std::to_string(max_histogram_bins) +
                       " bins in all; give fewer for each axis");
    }
  }
  return all;
}

// What a place without a bin has instead of one.
constexpr int outside = -1, not_a_number = -2;

/// Places that are looked up together, channel by channel.
constexpr std::size_t chunk = 4096;

/// Finds the bins of some places, and counts them into a histogram of its own.
class Counter {
 public:
  Counter(const Channels& channels, const std::vector<int>& which, const JointHistogram& shape)
      : channels_(channels), which_(which), mine_(shape) {}

  void count(std::size_t first, std::size_t last) {
    bin_.fill(0);
    int stride = 1;
    for (std::size_t a = 0; a < which_.size(); ++a) {
      const HistogramAxis& axis = mine_.axes[a];
      std::visit([&](const auto& values) { look_up(values, axis, stride, first, last); },
                 channels_[which_[a]].volume->data());
      stride *= axis.bins;
    }
    for (std::size_t i = 0; i < last - first; ++i) {
      if (bin_[i] >= 0) {
        ++mine_.count[static_cast<std::size_t>(bin_[i])];
      } else {
        ++(bin_[i] == not_a_number ? mine_.nan : mine_.outside);
      }
    }
  }

  void add_to(JointHistogram& all) const {
    for (std::size_t i = 0; i < all.count.size(); ++i) all.count[i] += mine_.count[i];
    all.nan += mine_.nan;
    all.outside += mine_.outside;
  }

 private:
  template <class Value>
  void look_up(const DataArray<Value>& values, const HistogramAxis& axis, int stride,
               std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      int& bin = bin_[i - first];
      const Value v = values[i];
      if constexpr (std::is_floating_point_v<Value>) {
        if (v != v) bin = not_a_number;
      }
      if (bin < outside) continue;
      const int here = axis.bin(static_cast<double>(v));
      bin = bin == outside || here < 0 ? outside : bin + stride * here;
    }
  }

  const Channels& channels_;
  const std::vector<int>& which_;
  JointHistogram mine_;
  std::array<int, chunk> bin_{};
};

}  // namespace

double HistogramAxis::edge(int i) const noexcept {
  // Both ends are met exactly.
  const double share = static_cast<double>(i) / bins;
  return share < 0.5 ? lower + share * (upper - lower) : upper - (1 - share) * (upper - lower);
}

double HistogramAxis::center(int i) const noexcept {
  return lower + (i + 0.5) / bins * (upper - lower);
}

bool has_whole_numbers(const Volume& volume) noexcept {
  return std::visit(
      [](const auto& values) {
        return std::is_integral_v<typename std::decay_t<decltype(values)>::value_type>;
      },
      volume.data());
}

HistogramAxis histogram_axis(const Volume& volume, int bins) {
  check_bins(bins);
  const VolumeStatistics& s = volume.statistics();
  if (s.finite == 0) return {0, 1, bins};
  if (has_whole_numbers(volume)) {
    const double numbers = s.maximum - s.minimum + 1;
    const double width = std::ceil(numbers / bins), needed = std::ceil(numbers / width);
    return {s.minimum - 0.5, s.minimum - 0.5 + width * needed, static_cast<int>(needed)};
  }
  if (s.minimum == s.maximum) {
    const double reach = s.minimum == 0 ? 0.5 : std::abs(s.minimum) / 2;
    // Half of the smallest number is no number.
    if (reach > 0) return {s.minimum - reach, s.minimum + reach, bins};
    return {std::min(s.minimum, 0.0), std::max(s.minimum, 0.0), bins};
  }
  return {s.minimum, s.maximum, bins};
}

JointHistogram joint_histogram(const Channels& channels, const std::vector<int>& which,
                               const std::vector<HistogramAxis>& axes,
                               const ParallelFor& parallel) {
  if (which.empty() || which.size() > static_cast<std::size_t>(max_histogram_axes)) {
    refuse_histogram("it has " + std::to_string(which.size()) +
                     " channels, but must have from 1 to " + std::to_string(max_histogram_axes));
  }
  if (axes.size() != which.size()) {
    refuse_histogram("it has " + std::to_string(which.size()) + " channels and " +
                     std::to_string(axes.size()) + " axes; give one for each");
  }
  for (const int c : which) {
    if (c < 0 || c >= channels.count()) {
      refuse_histogram("it looks at channel " + std::to_string(c) + ", but there are " +
                       std::to_string(channels.count()) + ", counted from 0");
    }
  }
  JointHistogram all;
  all.axes = axes;
  all.count.assign(check_axes(axes), 0);

  const auto& n = channels.grid().description().dimensions;
  const std::size_t places = static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
                             static_cast<std::size_t>(n[2]);
  // Few enough parts that histograms of their own do not cost more than what they count.
  const std::size_t chunks = (places + chunk - 1) / chunk;
  const int parts = static_cast<int>(std::min<std::size_t>(chunks, 1024));
  const JointHistogram shape = all;
  std::mutex mutex;
  const auto body = [&](int first, int last) {
    Counter counter(channels, which, shape);
    const auto begin_of = [&](int part) {
      return chunks * static_cast<std::size_t>(part) / static_cast<std::size_t>(parts);
    };
    for (std::size_t c = begin_of(first); c < begin_of(last); ++c) {
      counter.count(c * chunk, std::min(places, (c + 1) * chunk));
    }
    const std::lock_guard lock(mutex);
    counter.add_to(all);
  };
  parallel_or_serial(parallel)(parts, body);
  return all;
}

}  // namespace pellucid
