// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Files have number types that a volume has not. Volumes keep half floats ("f16") as f32, exactly.
/// They keep whole numbers of 64 bits ("i64", "u64") in the first of u8, i8, u16, i16, u32, i32
/// and f64 that holds every one of them; f64 holds some beyond 2^53 only after rounding.
///
/// No function here needs more than pellucid::scene, so that modules can use them too.

/// Returns whether the name is one of these: "f16", "i64", "u64".
bool is_stored_only(std::string_view type) noexcept;

/// Returns the first of u8, i8, u16, i16, u32 and i32 that has so many bytes at least and holds the
/// whole numbers from `lowest` to `highest`; nothing where none does.
std::optional<std::string> whole_type_for(double lowest, double highest, std::size_t least_bytes);

/// Makes values of a type of volumes. Throws Error or std::bad_alloc.
using MakeValues = std::function<VolumeData(const std::string& type)>;

/// The whole numbers that were rounded.
struct Rounding {
  std::size_t count = 0;
  std::uint64_t largest = 0;  ///< largest difference between a number and its double

  void merge(const Rounding& other) noexcept;
  /// Says "2 of 60 whole numbers of 64 bits do not fit double and are rounded, by at most 512".
  std::string text(std::size_t of) const;
};

/// Collects whole numbers of 64 bits, part by part, in the smallest type that holds them.
class WholeNumbers {
 public:
  /// Holds no numbers yet. `make` makes room for all of them, again whenever a wider type is
  /// needed.
  explicit WholeNumbers(MakeValues make);

  using Signed = std::int64_t;
  using Unsigned = std::uint64_t;
  /// Adds the next ones, for which there must be room.
  void add(std::span<const Signed> numbers);
  void add(std::span<const Unsigned> numbers);

  const std::string& type() const noexcept { return type_; }
  const Rounding& rounding() const noexcept { return rounding_; }
  /// Widens the type so that it holds what `other` holds too.
  void widen_for(const WholeNumbers& other);
  VolumeData take() { return std::move(values_); }

 private:
  template <class Number>
  void add_any(std::span<const Number> numbers);
  void hold(std::int64_t least, std::uint64_t largest);

  std::size_t done_ = 0;
  MakeValues make_;
  std::int64_t least_ = 0;     ///< of all numbers and 0
  std::uint64_t largest_ = 0;  ///< of all numbers and 0
  std::string type_ = "u8";
  VolumeData values_;
  Rounding rounding_;
};

/// Gives components of one file one type.
void unify(std::span<WholeNumbers> components);

/// Converts IEEE 754 binary16, every value exactly: subnormals, infinities and NaN as well.
float half_to_float(std::uint16_t bits) noexcept;

}  // namespace pellucid
