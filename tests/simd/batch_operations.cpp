// SPDX-License-Identifier: Apache-2.0
#include "tests/simd/batch_operations.h"

#include "pellucid/simd/batch.h"
#include "pellucid/simd/flush_to_zero.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {
namespace {

constexpr int width = PELLUCID_LANES;
using Float = Batch<float, width>;
using Double = Batch<double, width>;
using Int = Batch<std::int32_t, width>;
using Mask = BatchMask<width>;

static_assert(lanes<Float> == width && lanes<Double> == width && lanes<float> == 1);
static_assert(std::is_same_v<scalar_t<Double>, double> && is_single<Float> && !is_single<Double>);
static_assert(std::is_same_v<mask_t<Float>, Mask> && std::is_same_v<mask_t<Double>, Mask>);
static_assert(std::is_same_v<mask_t<float>, bool> && std::is_same_v<index_t<float>, int>);
static_assert(std::is_same_v<index_t<Float>, Int> && std::is_same_v<index_t<Double>, Int>);
static_assert(rounding_unit<Float> == rounding_unit<float>);
static_assert(sizeof(Float) == width * sizeof(float) && sizeof(Double) == width * sizeof(double));

template <class B, class F>
void each(const scalar_t<B>* a, const scalar_t<B>* b, const scalar_t<B>* c, scalar_t<B>* out, F f) {
  f(B::load(a), B::load(b), B::load(c)).store(out);
}

#define OPERATION(name, expression)                                                  \
  {                                                                                  \
    name, [](const T* pa, const T* pb, const T* pc, T* out) {                        \
      each<B>(pa, pb, pc, out,                                                       \
              []([[maybe_unused]] B a, [[maybe_unused]] B b, [[maybe_unused]] B c) { \
                return expression;                                                   \
              });                                                                    \
    }                                                                                \
  }

template <class B, class T = scalar_t<B>>
constexpr batch_operations::Operation<T> common[] = {
    OPERATION("a", a),
    OPERATION("zero", B()),
    OPERATION("7", B(T(7))),
    OPERATION("a + b", a + b),
    OPERATION("a - b", a - b),
    OPERATION("a * b", a* b),
    OPERATION("-a", -a),
    OPERATION("a += b", a += b),
    OPERATION("a -= b", a -= b),
    OPERATION("a *= b", a *= b),
    OPERATION("a + 1", a + T(1)),
    OPERATION("min(a, b)", min(a, b)),
    OPERATION("max(a, b)", max(a, b)),
    OPERATION("min(a, 1)", min(a, T(1))),
    OPERATION("abs(a)", abs(a)),
    OPERATION("clamp(a, b, c)", clamp(a, b, c)),
    OPERATION("a < b ? b : c", select(a < b, b, c)),
    OPERATION("a == b ? c : a", select(a == b, c, a)),
    OPERATION("if (a >= b) c = a", (assign(a >= b, c, a), c)),
};

template <class B, class T = scalar_t<B>>
constexpr batch_operations::Operation<T> floating[] = {
    OPERATION("a / b", a / b),
    OPERATION("a /= b", a /= b),
    OPERATION("1 / a", T(1) / a),
    OPERATION("2.0 / 3 * a", B(2.0 / 3) * a),
    OPERATION("sqrt(a)", sqrt(a)),
    OPERATION("floor(a)", floor(a)),
    OPERATION("nearest(a)", round_to_nearest(a)),
    OPERATION("copysign(a, b)", copysign(a, b)),
    OPERATION("fma(a, b, c)", fma(a, b, c)),
    OPERATION("multiply_add(a, b, c)", multiply_add(a, b, c)),
    OPERATION("a b + c", a* b + c),
    OPERATION("exp(a)", exp(a)),
    OPERATION("log(a)", log(a)),
    OPERATION("log1p(a)", log1p(a)),
};

using T = std::int32_t;
using B = Int;
constexpr batch_operations::Operation<T> integer[] = {
    OPERATION("a & b", a& b),    OPERATION("a | b", a | b),     OPERATION("a << 0", a << 0),
    OPERATION("a << 5", a << 5), OPERATION("a << 31", a << 31), OPERATION("a >> 0", a >> 0),
    OPERATION("a >> 5", a >> 5), OPERATION("a >> 31", a >> 31),
};
#undef OPERATION

#define COMPARISON(name, expression)                                           \
  {                                                                            \
    name, [](const S* pa, const S* pb) {                                       \
      const auto a = Batch<S, width>::load(pa), b = Batch<S, width>::load(pb); \
      return bits(expression);                                                 \
    }                                                                          \
  }
template <class S>
constexpr batch_operations::Comparison<S> comparisons[] = {
    COMPARISON("<", a < b),   COMPARISON("<=", a <= b), COMPARISON(">", a > b),
    COMPARISON(">=", a >= b), COMPARISON("==", a == b), COMPARISON("!=", a != b),
};
template <class S>
constexpr batch_operations::Comparison<S> floating_comparisons[] = {
    COMPARISON("<", a < b),
    COMPARISON("<=", a <= b),
    COMPARISON(">", a > b),
    COMPARISON(">=", a >= b),
    COMPARISON("==", a == b),
    COMPARISON("!=", a != b),
    COMPARISON("is_nan", is_nan(a) | (b != b)),
};
#undef COMPARISON

#define MASKS(name, expression)                                                       \
  {                                                                                   \
    name, [](unsigned bits_a, unsigned bits_b, unsigned bits_c) -> unsigned {         \
      [[maybe_unused]] Mask a = Mask::from_bits(bits_a), b = Mask::from_bits(bits_b), \
                            c = Mask::from_bits(bits_c);                              \
      return expression;                                                              \
    }                                                                                 \
  }
constexpr batch_operations::MaskOperation mask_operations[] = {
    MASKS("a", bits(a)),
    MASKS("a & b", bits(a& b)),
    MASKS("a | b", bits(a | b)),
    MASKS("a ^ b", bits(a ^ b)),
    MASKS("!a", bits(!a)),
    MASKS("a == b", bits(a == b)),
    MASKS("a != b", bits(a != b)),
    MASKS("a &= b", bits(a &= b)),
    MASKS("a |= b", bits(a |= b)),
    MASKS("a ^= b", bits(a ^= b)),
    MASKS("a ? b : c", bits(select(a, b, c))),
    MASKS("if (a) b = c", (assign(a, b, c), bits(b))),
    MASKS("any", any(a)),
    MASKS("all", all(a)),
    MASKS("none", none(a)),
    MASKS("all !a", all(!a)),
    MASKS("count", static_cast<unsigned>(count(a))),
    MASKS("[]", (a[0] ? 1u : 0u) | (a[width - 1] ? 2u : 0u)),
    MASKS("true", bits(Mask(true))),
    MASKS("false", bits(Mask(false)) | bits(Mask())),
    // From one width of numbers to the other and back.
    MASKS("through doubles", bits(select(a, Double(1.0), Double(2.0)) < Double(1.5))),
    MASKS("through floats", bits(select(a, Float(1.0f), Float(2.0f)) < Float(1.5f))),
    MASKS("through ints", bits(select(a, Int(1), Int(2)) == Int(1))),
};
#undef MASKS

/// Lists of two arrays, joined before main() is asked for them.
template <class Item, int First, int Second>
struct Joined {
  Item items[First + Second];
};
template <class Item, int First, int Second>
constexpr Joined<Item, First, Second> join(const Item (&first)[First],
                                           const Item (&second)[Second]) {
  Joined<Item, First, Second> joined{};
  for (int i = 0; i < First; ++i) joined.items[i] = first[i];
  for (int i = 0; i < Second; ++i) joined.items[First + i] = second[i];
  return joined;
}
constexpr auto float_operations = join(common<Float>, floating<Float>);
constexpr auto double_operations = join(common<Double>, floating<Double>);
constexpr auto int_operations = join(common<Int>, integer);

template <class Item, int Count>
constexpr batch_operations::List<Item> list(const Item (&items)[Count]) {
  return {items, Count};
}

template <class To, class From>
void conversion(const From* from, To* to) {
  convert<To>(Batch<From, width>::load(from)).store(to);
}
template <class S>
void gathering(const S* base, const std::int32_t* index, S* out) {
  gather(base, Int::load(index)).store(out);
}
template <int Entries, class S>
void looking_up(const S* from, const std::int32_t* index, S* out) {
  S entries[Entries];
  for (int i = 0; i < Entries; ++i) entries[i] = from[i];
  lookup(entries, Int::load(index)).store(out);
}
template <class Value>
void pairs(const Value* const* base, const std::int32_t* offset, float* first, float* second) {
  Float a, b;
  gather_pairs(base, offset, a, b);
  a.store(first);
  b.store(second);
}
template <class Value>
void rows(const Value* const* base, const std::int32_t* offset, const std::ptrdiff_t (&row)[4],
          float* out) {
  Float found[8];
  pairs_in_rows<Value, width>(base, offset, row, found);
  for (int k = 0; k < 8; ++k) found[k].store(out + k * width);
}
void loaded_rows(const float* const* base, const std::int32_t* offset,
                 const std::ptrdiff_t (&row)[4], float* out) {
  Float found[8];
  detail::load_pairs_in_rows<float, width>(base, offset, row, found);
  for (int k = 0; k < 8; ++k) found[k].store(out + k * width);
}
template <int N = width>
constexpr batch_operations::RowLoad<float> gathered_rows() {
  if constexpr (detail::has_pairs_in_rows<N, float>()) {
    return [](const float* const* base, const std::int32_t* offset, const std::ptrdiff_t(&row)[4],
              float* out) {
      Float found[8];
      detail::gather_pairs_in_rows<N>(base, offset, row, found);
      for (int k = 0; k < 8; ++k) found[k].store(out + k * width);
    };
  } else {
    return nullptr;
  }
}
template <int K, class T>
void records(const T* base, const std::int32_t* index, T* out) {
  Batch<T, width> fields[K];
  load_records<K>(base, Int::load(index), fields);
  for (int k = 0; k < K; ++k) fields[k].store(out + k * width);
}

template <int K>
void put_records(const float* in, float* base, const std::int32_t* index) {
  Float fields[K];
  for (int k = 0; k < K; ++k) fields[k] = Float::load(in + k * width);
  store_records<K>(fields, base, Int::load(index));
}
template <class T>
void pack(unsigned lanes, const T* in, T* to) {
  store_packed(BatchMask<width>::from_bits(lanes), Batch<T, width>::load(in), to);
}
template <class T>
void spread(unsigned lanes, const T* from, T* in_out) {
  load_spread(BatchMask<width>::from_bits(lanes), from, Batch<T, width>::load(in_out))
      .store(in_out);
}
void as_floats(const std::int32_t* in, float* out) {
  float_of_bits(Int::load(in)).store(out);
}
// Not to be moved before or behind what sets the mode.
[[gnu::noinline]] void product(const float* a, const float* b, float* out) {
  (Float::load(a) * Float::load(b)).store(out);
}
void flushed(const float* a, const float* b, float* out, float* out_behind) {
  {
    const FlushToZero mode;
    product(a, b, out);
  }
  product(a, b, out_behind);
}

constexpr batch_operations::Table table = {
    width,
    list(float_operations.items),
    list(double_operations.items),
    list(int_operations.items),
    list(floating_comparisons<float>),
    list(floating_comparisons<double>),
    list(comparisons<std::int32_t>),
    list(mask_operations),
    conversion<std::int32_t, float>,
    conversion<double, float>,
    conversion<std::int32_t, double>,
    conversion<float, double>,
    conversion<float, std::int32_t>,
    conversion<double, std::int32_t>,
    gathering<float>,
    gathering<double>,
    gathering<std::int32_t>,
    looking_up<16, float>,
    looking_up<16, double>,
    looking_up<16, std::int32_t>,
    looking_up<5, float>,
    pairs<std::uint8_t>,
    pairs<std::int8_t>,
    pairs<std::uint16_t>,
    pairs<std::int16_t>,
    pairs<std::uint32_t>,
    pairs<std::int32_t>,
    pairs<float>,
    pairs<double>,
    rows<std::uint16_t>,
    rows<float>,
    loaded_rows,
    gathered_rows(),
    records<4, float>,
    records<8, float>,
    records<16, float>,
    records<8, std::int32_t>,
    records<4, double>,
    put_records<8>,
    pack<float>,
    pack<double>,
    pack<std::int32_t>,
    spread<float>,
    spread<double>,
    spread<std::int32_t>,
    as_floats,
    fuses<Float>,
    FlushToZero::flushes,
    flushed,
};

}  // namespace
}  // namespace pellucid

extern "C" const batch_operations::Table* PELLUCID_ENTRY(pellucid_batch_operations)() {
  return &pellucid::table;
}
