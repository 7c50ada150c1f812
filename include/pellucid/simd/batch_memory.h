// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch_number.h"

#if PELLUCID_HAS_BATCH_4
namespace pellucid {

/// Returns base[index] of every lane. Reads nothing else.
template <class T, int N>
PELLUCID_ALWAYS_INLINE Batch<T, N> gather(const T* base, Batch<std::int32_t, N> index) noexcept {
  using Native = detail::Native<N>;
  if constexpr (Batch<T, N>::one_register) {
    return Batch<T, N>(typename Batch<T, N>::Register(Native::gather(base, index.part[0])));
  } else {
    typename Native::Double low, high;
    Native::gather(base, index.part[0], low, high);
    return Batch<T, N>(low, high);
  }
}

/// Returns gather() of a small table; without a load per lane where 16 numbers fit into registers.
template <class T, std::size_t Entries, int N>
PELLUCID_ALWAYS_INLINE Batch<T, N> lookup(const T (&table)[Entries],
                                          Batch<std::int32_t, N> index) noexcept {
  if constexpr (Entries == 16 && detail::Native<N>::template has_lookup<T>) {
    using Native = detail::Native<N>;
    if constexpr (Batch<T, N>::one_register) {
      return Batch<T, N>(typename Batch<T, N>::Register(Native::lookup(table, index.part[0])));
    } else {
      typename Native::Double low, high;
      Native::lookup(table, index.part[0], low, high);
      return Batch<T, N>(low, high);
    }
  } else {
    return gather(table, index);
  }
}

template <class T, int N>
inline constexpr bool looks_up_in_registers<Batch<T, N>> =
    detail::Native<N>::template has_lookup<T>;

/// For gather_pairs(): one offset for all lanes.
struct SameOffset {
  std::ptrdiff_t offset;
  PELLUCID_ALWAYS_INLINE std::ptrdiff_t operator[](int) const noexcept { return offset; }
  PELLUCID_ALWAYS_INLINE SameOffset operator+(int) const noexcept { return *this; }
};

/// Loads base[l][offset[l]] and base[l][offset[l] + 1] into lane l as floats, each rounded once;
/// reads exactly those two values. Value: an integer of 8, 16 or 32 bits, float or double. One load
/// per lane for both is half the price of two gathers. Offset: const std::int32_t*, or SameOffset.
template <class Value, int N, class Offset>
PELLUCID_ALWAYS_INLINE void gather_pairs(const Value* const* base, Offset offset,
                                         Batch<float, N>& first, Batch<float, N>& second) noexcept {
  using Native = detail::Native<N>;
  using Float = Batch<float, N>;
  using Int = Batch<std::int32_t, N>;
  const auto number = [](Int x) __attribute__((always_inline)) {
    return convert<float>(x);
  };
  if constexpr (sizeof(Value) == 1) {
    const Int both{typename Int::Register(Native::bytes(base, offset))};
    if constexpr (std::is_signed_v<Value>) {
      first = number((both << 24) >> 24);
      second = number((both << 16) >> 24);
    } else {
      first = number(both & Int(0xff));
      second = number(both >> 8);
    }
  } else if constexpr (sizeof(Value) == 2) {
    const Int both{typename Int::Register(Native::words(base, offset))};
    if constexpr (std::is_signed_v<Value>) {
      first = number((both << 16) >> 16);
      second = number(both >> 16);
    } else {
      first = number(both & Int(0xffff));
      second = number((both >> 16) & Int(0xffff));
    }
  } else {
    typename Native::Float a, b;
    Native::pairs(base, offset, a, b);
    if constexpr (std::is_floating_point_v<Value>) {
      first = Float(typename Float::Register(a));
      second = Float(typename Float::Register(b));
    } else {
      const auto as_int = [](typename Native::Float x) __attribute__((always_inline)) {
        return reinterpret_cast<typename Native::Int>(x);
      };
      const auto as_number = [](typename Native::Int x) __attribute__((always_inline)) {
        return std::is_signed_v<Value> ? Native::to_float(x) : Native::unsigned_to_float(x);
      };
      first = Float(typename Float::Register(as_number(as_int(a))));
      second = Float(typename Float::Register(as_number(as_int(b))));
    }
  }
}

namespace detail {

template <int N, class Value>
constexpr bool has_pairs_in_rows() noexcept {
  return std::is_same_v<Value, float> && Native<N>::has_pairs_in_rows;
}

template <class Value, int N, std::size_t Rows>
PELLUCID_ALWAYS_INLINE void load_pairs_in_rows(const Value* const* base, const std::int32_t* offset,
                                               const std::ptrdiff_t (&row)[Rows],
                                               Batch<float, N>* out) noexcept {
  const Value* at[N];
  for (int l = 0; l < N; ++l) at[l] = base[l] + offset[l];
  // From memory: taking lanes out of registers costs more.
  asm("" : "+m"(at));
  for (std::size_t k = 0; k < Rows; ++k) {
    std::int32_t to_row[N];
    for (std::int32_t& to : to_row) to = static_cast<std::int32_t>(row[k]);
    gather_pairs(at, to_row, out[2 * k], out[2 * k + 1]);
  }
}

template <int N, std::size_t Rows>
PELLUCID_ALWAYS_INLINE void gather_pairs_in_rows(const float* const* base,
                                                 const std::int32_t* offset,
                                                 const std::ptrdiff_t (&row)[Rows],
                                                 Batch<float, N>* out) noexcept {
  typename Native<N>::Float pairs[2 * Rows];
  Native<N>::pairs_in_rows(base, offset, row, pairs);
  for (std::size_t k = 0; k < 2 * Rows; ++k) {
    out[k] = Batch<float, N>(typename Batch<float, N>::Register(pairs[k]));
  }
}

}  // namespace detail

/// Loads several rows as gather_pairs() does: base[l][offset[l] + row[k]] goes to lane l of out[2
/// k], and the value behind it to out[2 k + 1]; the numbers of rows are of 32 bits. By gathers
/// where the processor is good at them.
template <class Value, int N, std::size_t Rows>
PELLUCID_ALWAYS_INLINE void pairs_in_rows(const Value* const* base, const std::int32_t* offset,
                                          const std::ptrdiff_t (&row)[Rows],
                                          Batch<float, N>* out) noexcept {
  if constexpr (detail::has_pairs_in_rows<N, Value>()) {
    if (detail::Native<N>::gathers_are_fast()) {
      return detail::gather_pairs_in_rows<N>(base, offset, row, out);
    }
  }
  detail::load_pairs_in_rows<Value, N>(base, offset, row, out);
}

/// Sets out[k] = base[K index + k] of every lane, k < K, K a multiple of 4: rows are loaded and
/// transposed, which takes far less than K gathers. Reads nothing else.
template <int K, int N>
PELLUCID_ALWAYS_INLINE void load_records(const float* base, Batch<std::int32_t, N> index,
                                         Batch<float, N>* out) noexcept {
  static_assert(K > 0 && K % 4 == 0);
  using Native = detail::Native<N>;
  using Float = Batch<float, N>;
  std::int32_t row[N];
  index.store(row);
  for (int k = 0; k < K; k += 4) {
    typename Native::Float fields[4];
    Native::four_fields(base + k, K, row, fields);
    for (int j = 0; j < 4; ++j) out[k + j] = Float(typename Float::Register(fields[j]));
  }
}

/// Loads whole numbers likewise.
template <int K, int N>
PELLUCID_ALWAYS_INLINE void load_records(const std::int32_t* base, Batch<std::int32_t, N> index,
                                         Batch<std::int32_t, N>* out) noexcept {
  static_assert(K > 0 && K % 4 == 0);
  using Native = detail::Native<N>;
  using Int = Batch<std::int32_t, N>;
  std::int32_t row[N];
  index.store(row);
  for (int k = 0; k < K; k += 4) {
    typename Native::Float fields[4];
    Native::four_fields(reinterpret_cast<const float*>(base + k), K, row, fields);
    for (int j = 0; j < 4; ++j) {
      out[k + j] = Int(typename Int::Register(reinterpret_cast<typename Native::Int>(fields[j])));
    }
  }
}

/// Loads doubles likewise.
template <int K, int N>
PELLUCID_ALWAYS_INLINE void load_records(const double* base, Batch<std::int32_t, N> index,
                                         Batch<double, N>* out) noexcept {
  static_assert(K == 4);
  using Native = detail::Native<N>;
  using Number = Batch<double, N>;
  std::int32_t row[N];
  index.store(row);
  typename Native::Double low[4], high[4];
  Native::four_doubles(base, row, low, high);
  for (int j = 0; j < 4; ++j) out[j] = Number(low[j], high[j]);
}

/// Stores base[K index + k] = in[k] of every lane, each of another index. Writes nothing else.
template <int K, int N>
PELLUCID_ALWAYS_INLINE void store_records(const Batch<float, N>* in, float* base,
                                          Batch<std::int32_t, N> index) noexcept {
  static_assert(K > 0 && K % 4 == 0);
  std::int32_t row[N];
  index.store(row);
  for (int k = 0; k < K; k += 4) {
    typename detail::Native<N>::Float fields[4];
    for (int j = 0; j < 4; ++j) fields[j] = in[k + j].part[0];
    detail::Native<N>::store_four_fields(fields, base + k, K, row);
  }
}

/// Writes the numbers of the lanes in `mask` one behind the other. Up to N - 1 numbers behind them
/// are overwritten with anything.
template <class T, int N>
PELLUCID_ALWAYS_INLINE void store_packed(BatchMask<N> mask, Batch<T, N> x, T* to) noexcept {
  using Native = detail::Native<N>;
  if constexpr (Native::has_packing && Batch<T, N>::one_register) {
    Native::store_packed(mask.native, x.part[0], to);
  } else if constexpr (Native::has_packing) {
    Native::store_packed(mask.native, x.part[0], x.part[1], to);
  } else {
    T all[N];
    x.store(all);
    for (unsigned left = bits(mask); left != 0; left &= left - 1) *to++ = all[__builtin_ctz(left)];
  }
}

/// Returns `rest`, but in the lanes of `mask` the numbers from[0], from[1], … one after the other.
/// Reads N of them.
template <class T, int N>
PELLUCID_ALWAYS_INLINE Batch<T, N> load_spread(BatchMask<N> mask, const T* from,
                                               Batch<T, N> rest) noexcept {
  using Native = detail::Native<N>;
  if constexpr (Native::has_packing && Batch<T, N>::one_register) {
    return Batch<T, N>(
        typename Batch<T, N>::Register(Native::load_spread(mask.native, from, rest.part[0])));
  } else if constexpr (Native::has_packing) {
    Native::load_spread(mask.native, from, rest.part[0], rest.part[1]);
    return rest;
  } else {
    T all[N];
    rest.store(all);
    for (unsigned left = bits(mask); left != 0; left &= left - 1) {
      all[__builtin_ctz(left)] = *from++;
    }
    return Batch<T, N>::load(all);
  }
}

}  // namespace pellucid
#endif
