// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// Neighbours of a row, as many as a register of 16 bytes holds, which every machine has that this
/// is compiled for: what the compiler makes of loops over so few is not to be relied upon. NaNs
/// compare as in min() and max() of scalar.h.
template <class Number>
struct RowLanes {
  static constexpr int count = 16 / sizeof(Number);
#if PELLUCID_HAS_VECTOR_TYPES
  using Lanes __attribute__((vector_size(16))) = Number;
  Lanes lane;

  static RowLanes load(const Number* from) noexcept {
    RowLanes r;
    __builtin_memcpy(&r.lane, from, sizeof(r.lane));
    return r;
  }
  static RowLanes all(Number x) noexcept {
    return {Lanes{} + x};
  }
  friend RowLanes operator-(const RowLanes& a, const RowLanes& b) noexcept {
    return {a.lane - b.lane};
  }
  friend RowLanes least(const RowLanes& a, const RowLanes& b) noexcept {
    return {a.lane < b.lane ? a.lane : b.lane};
  }
  friend RowLanes greatest(const RowLanes& a, const RowLanes& b) noexcept {
    return {a.lane > b.lane ? a.lane : b.lane};
  }
#else
  Number lane[count];

  PELLUCID_HD static RowLanes load(const Number* from) noexcept {
    RowLanes r;
    for (int i = 0; i < count; ++i) r.lane[i] = from[i];
    return r;
  }
  PELLUCID_HD static RowLanes all(Number x) noexcept {
    RowLanes r;
    for (int i = 0; i < count; ++i) r.lane[i] = x;
    return r;
  }
  PELLUCID_HD friend RowLanes operator-(const RowLanes& a, const RowLanes& b) noexcept {
    RowLanes r;
    for (int i = 0; i < count; ++i) r.lane[i] = static_cast<Number>(a.lane[i] - b.lane[i]);
    return r;
  }
  PELLUCID_HD friend RowLanes least(const RowLanes& a, const RowLanes& b) noexcept {
    RowLanes r;
    for (int i = 0; i < count; ++i) r.lane[i] = min(a.lane[i], b.lane[i]);
    return r;
  }
  PELLUCID_HD friend RowLanes greatest(const RowLanes& a, const RowLanes& b) noexcept {
    RowLanes r;
    for (int i = 0; i < count; ++i) r.lane[i] = max(a.lane[i], b.lane[i]);
    return r;
  }
#endif
};

}  // namespace pellucid
