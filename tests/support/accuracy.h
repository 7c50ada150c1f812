// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

namespace pellucid::test {

/// u of the specification, half the distance from 1 to the next larger number: 2^-24 or 2^-53.
template <class T>
inline constexpr long double unit_of = static_cast<long double>(std::numeric_limits<T>::epsilon()) /
                                       2;

/// |computed - truth| in units of u. Infinite when `computed` is NaN or infinite, so that no
/// comparison with a bound lets it pass.
template <class T>
long double absolute_error_in_u(T computed, long double truth) {
  static_assert(std::is_same_v<T, float> || std::is_same_v<T, double>);
  if (!std::isfinite(computed)) {
    return std::numeric_limits<long double>::infinity();
  }
  return std::fabs(static_cast<long double>(computed) - truth) / unit_of<T>;
}

/// |computed - truth| / |truth| in units of u; 0 when both are zero, infinite when only the truth
/// is.
template <class T>
long double relative_error_in_u(T computed, long double truth) {
  const long double error = absolute_error_in_u(computed, truth);
  return error == 0 ? 0 : error / std::fabs(truth);
}

/// The errors of one quantity: largest, root mean square, and where the largest is.
///
///     ErrorRecord opacity("opacity, float", "u");
///     opacity.add(relative_error_in_u(result.opacity, truth), "row 17, thin");
///     opacity.print();
///     EXPECT_LE(opacity.largest(), 16);
class ErrorRecord {
 public:
  explicit ErrorRecord(std::string quantity, std::string unit = "u")
      : quantity_(std::move(quantity)), unit_(std::move(unit)) {}

  /// `error` >= 0; a NaN counts as infinite.
  template <class Where>
  void add(long double error, const Where& where) {
    if (std::isnan(error)) {
      error = std::numeric_limits<long double>::infinity();
    }
    ++count_;
    sum_of_squares_ += error * error;
    if (count_ == 1 || error > largest_) {
      largest_ = error;
      if constexpr (std::is_invocable_v<Where>) {
        where_ = where();
      } else {
        where_ = where;
      }
    }
  }

  long double largest() const { return largest_; }
  long double rms() const {
    return count_ == 0 ? 0 : std::sqrt(sum_of_squares_ / static_cast<long double>(count_));
  }
  std::size_t count() const { return count_; }
  const std::string& worst() const { return where_; }

  std::string summary() const {
    char line[256];
    std::snprintf(line, sizeof line,
                  "%-36s largest %9.3Lg %s   RMS %9.3Lg %s   of %zu   worst: ", quantity_.c_str(),
                  largest_, unit_.c_str(), rms(), unit_.c_str(), count_);
    return line + where_;
  }
  void print() const { std::printf("[ accuracy ] %s\n", summary().c_str()); }

 private:
  std::string quantity_;
  std::string unit_;
  std::size_t count_ = 0;
  long double largest_ = 0;
  long double sum_of_squares_ = 0;
  std::string where_ = "none";
};

}  // namespace pellucid::test
