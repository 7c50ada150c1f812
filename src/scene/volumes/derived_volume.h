// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <span>
#include <string>
#include <utility>

#include "blocks/volume_scan.h"
#include "message.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/volume.h"
#include "volume_check.h"

namespace pellucid {

/// Values computed at the data values of another volume, row by row along x.
class DerivedVolume {
 public:
  /// Throws Error where memory does not hold the values.
  DerivedVolume(const Volume& from, std::string name)
      : description_(from.description()), name_(std::move(name)) {
    description_.name = name_;
    const auto& n = description_.dimensions;
    width_ = static_cast<std::size_t>(n[0]);
    rows_ = static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]);
    try {
      values_ = DataArray<float>(width_ * rows_);
    } catch (const std::bad_alloc&) {
      throw Error(name_ + ": not enough memory for its values; crop the data");
    }
    out_ = values_.writable();
  }

  /// Returns row j + n[1] · k.
  std::span<float> row(std::size_t r) const noexcept { return out_.subspan(r * width_, width_); }
  /// Rounds a result to float. beyond() is true from then on if a volume cannot hold it.
  float held(double result) noexcept {
    if (!(std::abs(result) > largest_value)) return static_cast<float>(result);
    beyond_.store(true, std::memory_order_relaxed);
    return std::numeric_limits<float>::infinity();
  }

  /// Calls body(first, last) on parts of the rows that together are all of them.
  template <class Body>
  void each_rows(const ParallelFor& parallel, const Body& body) const {
    if (!parallel) return body(0, rows_);
    const int parts =
        static_cast<int>(std::min<std::size_t>(rows_, std::numeric_limits<int>::max()));
    const auto begin = [&](int part) {
      const auto p = static_cast<std::size_t>(part), all = static_cast<std::size_t>(parts);
      return rows_ / all * p + rows_ % all * p / all;
    };
    parallel(parts, [&](int first, int last) { body(begin(first), begin(last)); });
  }

  /// Returns the volume, once all rows are there. Throws Error where one of them holds what cannot
  /// be.
  Volume finish() {
    if (beyond_.load()) {
      const auto at = std::find_if(out_.begin(), out_.end(), [](float v) { return std::isinf(v); });
      const VolumeCheck check(description_);
      check.fail("the value at index " +
                 check.position_text(static_cast<std::size_t>(at - out_.begin())) + " is beyond " +
                 number(largest_value) + " in magnitude, more than float arithmetic carries; " +
                 "use another unit of length, or rescale the data");
    }
    return Volume(std::move(description_), VolumeData(std::move(values_)));
  }

 private:
  Volume::Description description_;
  std::string name_;
  std::size_t width_ = 0, rows_ = 0;
  DataArray<float> values_;
  std::span<float> out_;
  std::atomic<bool> beyond_{false};
};

/// Returns the name of a volume in messages.
inline std::string volume_name(const Volume& volume) {
  const std::string& name = volume.description().name;
  return name.empty() ? "volume" : name;
}

}  // namespace pellucid
