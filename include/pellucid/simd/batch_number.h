// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch_mask.h"

#if PELLUCID_HAS_BATCH_4
namespace pellucid {

/// N numbers of type T (float, double or std::int32_t) that are computed on together: one register
/// of the width N's machine, two for double. The names and what they give in each lane are those of
/// simd/scalar.h; a kernel that is written with them takes either.
///
/// Integers wrap around. There are no approximate reciprocals.
template <class T, int N>
class Batch {
 public:
  using Native = detail::Native<N>;
  using Register = xsimd::batch<T, typename Native::Arch>;
  static constexpr int lanes = N;
  static constexpr bool is_floating = !std::is_same_v<T, std::int32_t>;
  static constexpr bool one_register = sizeof(T) == 4;
  static constexpr int registers = one_register ? 1 : 2;
  static_assert(std::is_same_v<T, float> || std::is_same_v<T, double> ||
                std::is_same_v<T, std::int32_t>);
  static_assert(static_cast<int>(Register::size) * registers == N);

  /// Makes a batch of zeros.
  PELLUCID_ALWAYS_INLINE Batch() noexcept : Batch(T(0)) {}
  PELLUCID_ALWAYS_INLINE Batch(T all_lanes) noexcept requires one_register
      : part{Register(all_lanes)} {}
  PELLUCID_ALWAYS_INLINE Batch(T all_lanes) noexcept requires(!one_register)
      : part{Register(all_lanes), Register(all_lanes)} {}
  /// Converts a number to all lanes: T(0.5), T(1.0 / 3), T(2 * n) mean the same for a batch as for
  /// a scalar T.
  template <class S>
  requires(std::is_arithmetic_v<S> && !std::is_same_v<S, T>) PELLUCID_ALWAYS_INLINE
      explicit Batch(S all_lanes) noexcept
      : Batch(static_cast<T>(all_lanes)) {}
  PELLUCID_ALWAYS_INLINE explicit Batch(Register whole) noexcept requires one_register
      : part{whole} {}
  PELLUCID_ALWAYS_INLINE Batch(Register low, Register high) noexcept requires(!one_register)
      : part{low, high} {}

  /// Loads N consecutive numbers, of any alignment.
  PELLUCID_ALWAYS_INLINE static Batch load(const T* from) noexcept {
    if constexpr (one_register) {
      return Batch(Register::load_unaligned(from));
    } else {
      return Batch(Register::load_unaligned(from), Register::load_unaligned(from + N / 2));
    }
  }
  PELLUCID_ALWAYS_INLINE void store(T* to) const noexcept {
    part[0].store_unaligned(to);
    if constexpr (!one_register) part[1].store_unaligned(to + N / 2);
  }
  /// Returns the number of a lane, through memory: for what is done now and then.
  PELLUCID_ALWAYS_INLINE T operator[](int lane) const noexcept {
    T all[N];
    store(all);
    return all[lane];
  }

  PELLUCID_ALWAYS_INLINE friend Batch operator+(Batch a, Batch b) noexcept {
    return zip(
        a, b, [](Register x, Register y) __attribute__((always_inline)) { return x + y; });
  }
  PELLUCID_ALWAYS_INLINE friend Batch operator-(Batch a, Batch b) noexcept {
    return zip(
        a, b, [](Register x, Register y) __attribute__((always_inline)) { return x - y; });
  }
  PELLUCID_ALWAYS_INLINE friend Batch operator*(Batch a, Batch b) noexcept {
    return zip(
        a, b, [](Register x, Register y) __attribute__((always_inline)) { return x * y; });
  }
  PELLUCID_ALWAYS_INLINE friend Batch operator/(Batch a, Batch b) noexcept requires is_floating {
    return zip(
        a, b, [](Register x, Register y) __attribute__((always_inline)) {
          return Register(Native::quotient(x, y));
        });
  }
  PELLUCID_ALWAYS_INLINE friend Batch operator-(Batch a) noexcept {
    if constexpr (is_floating) {
      const Register sign(T(-0.0));
      return map(
          a, [sign](Register x)
                 __attribute__((always_inline)) { return Register(Native::flip(x, sign)); });
    } else {
      return Batch(T(0)) - a;
    }
  }
  PELLUCID_ALWAYS_INLINE Batch& operator+=(Batch b) noexcept { return *this = *this + b; }
  PELLUCID_ALWAYS_INLINE Batch& operator-=(Batch b) noexcept { return *this = *this - b; }
  PELLUCID_ALWAYS_INLINE Batch& operator*=(Batch b) noexcept { return *this = *this * b; }
  PELLUCID_ALWAYS_INLINE Batch& operator/=(Batch b) noexcept requires is_floating {
    return *this = *this / b;
  }

  PELLUCID_ALWAYS_INLINE friend Batch operator&(Batch a, Batch b) noexcept requires(!is_floating) {
    return Batch(a.part[0] & b.part[0]);
  }
  PELLUCID_ALWAYS_INLINE friend Batch operator|(Batch a, Batch b) noexcept requires(!is_floating) {
    return Batch(a.part[0] | b.part[0]);
  }
  /// Shifts every lane by the same number of bits, 0 ... 31; to the right with the sign.
  PELLUCID_ALWAYS_INLINE friend Batch operator<<(Batch a, int n) noexcept requires(!is_floating) {
    return Batch(Register(Native::shift_left(a.part[0], n)));
  }
  PELLUCID_ALWAYS_INLINE friend Batch operator>>(Batch a, int n) noexcept requires(!is_floating) {
    return Batch(Register(Native::shift_right(a.part[0], n)));
  }

  PELLUCID_ALWAYS_INLINE friend BatchMask<N> operator<(Batch a, Batch b) noexcept {
    return compare(
        a, b, [](Register x, Register y) __attribute__((always_inline)) { return x < y; });
  }
  PELLUCID_ALWAYS_INLINE friend BatchMask<N> operator<=(Batch a, Batch b) noexcept {
    return compare(
        a, b, [](Register x, Register y) __attribute__((always_inline)) { return x <= y; });
  }
  PELLUCID_ALWAYS_INLINE friend BatchMask<N> operator==(Batch a, Batch b) noexcept {
    return compare(
        a, b, [](Register x, Register y) __attribute__((always_inline)) { return x == y; });
  }
  PELLUCID_ALWAYS_INLINE friend BatchMask<N> operator>(Batch a, Batch b) noexcept { return b < a; }
  PELLUCID_ALWAYS_INLINE friend BatchMask<N> operator>=(Batch a, Batch b) noexcept {
    return b <= a;
  }
  PELLUCID_ALWAYS_INLINE friend BatchMask<N> operator!=(Batch a, Batch b) noexcept {
    return !(a == b);  // true of NaN, which the library's own is not
  }

  PELLUCID_ALWAYS_INLINE friend Batch select(BatchMask<N> mask, Batch a, Batch b) noexcept {
    if constexpr (one_register) {
      return Batch(Register(Native::choose(mask.native, a.part[0], b.part[0])));
    } else {
      const auto wide = Native::widen(mask.native);
      return Batch(Register(Native::choose(wide.low, a.part[0], b.part[0])),
                   Register(Native::choose(wide.high, a.part[1], b.part[1])));
    }
  }
  PELLUCID_ALWAYS_INLINE friend void assign(BatchMask<N> mask, Batch& target,
                                            Batch value) noexcept {
    target = select(mask, value, target);
  }

  PELLUCID_ALWAYS_INLINE friend Batch min(Batch a, Batch b) noexcept {
    return zip(
        a, b, [](Register x, Register y) __attribute__((always_inline)) {
          return Register(Native::lesser(x, y));
        });
  }
  PELLUCID_ALWAYS_INLINE friend Batch max(Batch a, Batch b) noexcept {
    return zip(
        a, b, [](Register x, Register y) __attribute__((always_inline)) {
          return Register(Native::greater(x, y));
        });
  }
  PELLUCID_ALWAYS_INLINE friend Batch clamp(Batch x, Batch lo, Batch hi) noexcept {
    return min(max(x, lo), hi);
  }

  PELLUCID_ALWAYS_INLINE friend Batch abs(Batch a) noexcept {
    if constexpr (is_floating) {
      return copysign(a, Batch(T(0)));
    } else {
      return max(a, -a);
    }
  }
  PELLUCID_ALWAYS_INLINE friend Batch copysign(Batch x, Batch s) noexcept requires is_floating {
    const Register sign(T(-0.0));
    return zip(
        s, x, [sign](Register p, Register q) __attribute__((always_inline)) {
          return Register(Native::merge(sign, p, q));
        });
  }
  PELLUCID_ALWAYS_INLINE friend Batch sqrt(Batch a) noexcept requires is_floating {
    return map(
        a, [](Register x) __attribute__((always_inline)) { return Register(Native::root(x)); });
  }
  PELLUCID_ALWAYS_INLINE friend Batch floor(Batch a) noexcept requires is_floating {
    return map(
        a,
        [](Register x) __attribute__((always_inline)) { return Register(Native::round_down(x)); });
  }
  PELLUCID_ALWAYS_INLINE friend BatchMask<N> is_nan(Batch a) noexcept requires is_floating {
    return a != a;
  }

  /// Returns a b + c with one rounding. Lane by lane and slow where the machine has no such
  /// instruction (N = 4).
  PELLUCID_ALWAYS_INLINE friend Batch fma(Batch a, Batch b, Batch c) noexcept requires is_floating {
    if constexpr (one_register) {
      return Batch(Register(Native::fused(a.part[0], b.part[0], c.part[0])));
    } else {
      return Batch(Register(Native::fused(a.part[0], b.part[0], c.part[0])),
                   Register(Native::fused(a.part[1], b.part[1], c.part[1])));
    }
  }
  /// Returns a b + c with one rounding in one instruction or two in two, whichever there is: for
  /// sums whose stated error holds for either.
  PELLUCID_ALWAYS_INLINE friend Batch multiply_add(Batch a, Batch b,
                                                   Batch c) noexcept requires is_floating {
    if constexpr (Native::has_fma) {
      return fma(a, b, c);
    } else {
      return a * b + c;
    }
  }

  /// Rounds to the nearest whole number, ties to even.
  PELLUCID_ALWAYS_INLINE friend Batch round_to_nearest(Batch a) noexcept requires is_floating {
    return map(
        a, [](Register x)
               __attribute__((always_inline)) { return Register(Native::round_to_nearest(x)); });
  }
  /// Returns x 2^n, rounded once; n whole, |n| <= 2^8 (float), 2^11 (double), or x NaN.
  PELLUCID_ALWAYS_INLINE friend Batch scale_by_power_of_two(Batch x,
                                                            Batch n) noexcept requires is_floating {
    return zip(
        x, n, [](Register p, Register q) __attribute__((always_inline)) {
          return Register(Native::scale(p, q));
        });
  }

  /// For this folder alone.
  Register part[registers];

 private:
  template <class F>
  PELLUCID_ALWAYS_INLINE static Batch map(Batch a, F f) noexcept {
    if constexpr (one_register) {
      return Batch(f(a.part[0]));
    } else {
      return Batch(f(a.part[0]), f(a.part[1]));
    }
  }
  template <class F>
  PELLUCID_ALWAYS_INLINE static Batch zip(Batch a, Batch b, F f) noexcept {
    if constexpr (one_register) {
      return Batch(f(a.part[0], b.part[0]));
    } else {
      return Batch(f(a.part[0], b.part[0]), f(a.part[1], b.part[1]));
    }
  }
  template <class F>
  PELLUCID_ALWAYS_INLINE static BatchMask<N> compare(Batch a, Batch b, F f) noexcept {
    if constexpr (one_register) {
      return BatchMask<N>::from_native(Native::mask(f(a.part[0], b.part[0])));
    } else {
      return BatchMask<N>::from_native(
          Native::mask(f(a.part[0], b.part[0]), f(a.part[1], b.part[1])));
    }
  }
};

template <class T, int N>
struct ScalarOf<Batch<T, N>> {
  using type = T;
};
template <class T, int N>
struct MaskOf<Batch<T, N>> {
  using type = BatchMask<N>;
};
template <class T, int N>
struct IndexOf<Batch<T, N>> {
  using type = Batch<std::int32_t, N>;
};
template <class T, int N>
struct InFloat<Batch<T, N>> {
  using type = Batch<float, N>;
};
template <class T, int N>
inline constexpr int lanes<Batch<T, N>> = N;
template <class T, int N>
inline constexpr bool fuses<Batch<T, N>> = detail::Native<N>::has_fma;

/// Converts each lane like static_cast: to int towards zero, from double to float to the nearest.
/// What does not fit into an int gives the smallest one.
template <class To, class From, int N>
PELLUCID_ALWAYS_INLINE Batch<To, N> convert(Batch<From, N> x) noexcept {
  using Native = detail::Native<N>;
  if constexpr (std::is_same_v<To, From>) {
    return x;
  } else if constexpr (std::is_same_v<To, double>) {
    typename Native::Double low, high;
    Native::to_double(x.part[0], low, high);
    return Batch<double, N>(low, high);
  } else if constexpr (std::is_same_v<From, double>) {
    if constexpr (std::is_same_v<To, float>) {
      return Batch<float, N>(
          typename Batch<float, N>::Register(Native::to_float(x.part[0], x.part[1])));
    } else {
      return Batch<To, N>(typename Batch<To, N>::Register(Native::to_int(x.part[0], x.part[1])));
    }
  } else if constexpr (std::is_same_v<To, float>) {
    return Batch<float, N>(typename Batch<float, N>::Register(Native::to_float(x.part[0])));
  } else {
    return Batch<To, N>(typename Batch<To, N>::Register(Native::to_int(x.part[0])));
  }
}

/// Returns the floats whose bits these are.
template <int N>
PELLUCID_ALWAYS_INLINE Batch<float, N> float_of_bits(Batch<std::int32_t, N> x) noexcept {
  using Native = detail::Native<N>;
  const typename Native::Int bits = x.part[0];
  return Batch<float, N>(
      typename Batch<float, N>::Register(reinterpret_cast<typename Native::Float>(bits)));
}

}  // namespace pellucid
#endif
