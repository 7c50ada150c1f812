// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "pellucid/simd/scalar.h"
#include "tests/simd/batch_fixture.h"

/// Every operation of a batch against the same one on plain numbers, lane by lane and bit by bit.
namespace pellucid::test {
namespace {

template <class T>
using Limits = std::numeric_limits<T>;

/// Zeros, denormals, ties, the ends of the ranges, infinities and NaN, and some of no account.
template <class T>
std::vector<T> special_floats() {
  std::vector<T> all;
  for (const T x : {T(0),
                    Limits<T>::denorm_min(),
                    Limits<T>::min() / 2,
                    Limits<T>::min(),
                    Limits<T>::epsilon(),
                    T(0.1),
                    T(0.5),
                    T(1) - Limits<T>::epsilon() / 2,
                    T(1),
                    T(1) + Limits<T>::epsilon(),
                    T(1.5),
                    T(2),
                    T(2.5),
                    T(3),
                    T(7.75),
                    T(87),
                    T(1e10),
                    T(0x1p23) + T(0.5),
                    T(0x1p31),
                    T(1e30),
                    Limits<T>::max() / 2,
                    Limits<T>::max(),
                    Limits<T>::infinity()}) {
    all.push_back(x);
    all.push_back(-x);
  }
  all.push_back(Limits<T>::quiet_NaN());
  all.push_back(-Limits<T>::quiet_NaN());
  return all;
}
std::vector<std::int32_t> special_ints() {
  constexpr std::int32_t most = Limits<std::int32_t>::max(), least = Limits<std::int32_t>::min();
  return {0,        1,      -1,       2,    -2,    3,        31,        32,
          255,      256,    -255,     -256, 65535, 65536,    -65536,    46341,
          16777217, 123456, -7654321, most, least, most - 1, least + 1, most / 2};
}
template <class T>
std::vector<T> special() {
  if constexpr (std::is_same_v<T, std::int32_t>) {
    return special_ints();
  } else {
    return special_floats<T>();
  }
}

template <class T>
bool same(T a, T b) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  }
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Arithmetic of ints that wraps.
template <class T>
T plus(T a, T b) {
  return a + b;
}
template <>
std::int32_t plus(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
template <class T>
T minus(T a, T b) {
  return a - b;
}
template <>
std::int32_t minus(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
template <class T>
T times(T a, T b) {
  return a * b;
}
template <>
std::int32_t times(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}
template <class T>
T negative(T a) {
  return -a;
}
template <>
std::int32_t negative(std::int32_t a) {
  return minus(0, a);
}
template <class T>
T magnitude(T a) {
  return std::fabs(a);
}
template <>
std::int32_t magnitude(std::int32_t a) {
  return a < 0 ? minus(0, a) : a;
}
std::int32_t shifted_left(std::int32_t a, int n) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) << n);
}

template <class T>
using Truth = std::function<T(T, T, T)>;

template <class T>
std::map<std::string, Truth<T>> truths() {
  std::map<std::string, Truth<T>> all = {
      {"a", [](T a, T, T) { return a; }},
      {"zero", [](T, T, T) { return T(0); }},
      {"7", [](T, T, T) { return T(7); }},
      {"a + b", [](T a, T b, T) { return plus(a, b); }},
      {"a - b", [](T a, T b, T) { return minus(a, b); }},
      {"a * b", [](T a, T b, T) { return times(a, b); }},
      {"-a", [](T a, T, T) { return negative(a); }},
      {"a += b", [](T a, T b, T) { return plus(a, b); }},
      {"a -= b", [](T a, T b, T) { return minus(a, b); }},
      {"a *= b", [](T a, T b, T) { return times(a, b); }},
      {"a + 1", [](T a, T, T) { return plus(a, T(1)); }},
      {"min(a, b)", [](T a, T b, T) { return a < b ? a : b; }},
      {"max(a, b)", [](T a, T b, T) { return a > b ? a : b; }},
      {"min(a, 1)", [](T a, T, T) { return a < T(1) ? a : T(1); }},
      {"abs(a)", [](T a, T, T) { return magnitude(a); }},
      {"clamp(a, b, c)",
       [](T a, T b, T c) {
         const T raised = a > b ? a : b;
         return raised < c ? raised : c;
       }},
      {"a < b ? b : c", [](T a, T b, T c) { return a < b ? b : c; }},
      {"a == b ? c : a", [](T a, T b, T c) { return a == b ? c : a; }},
      {"if (a >= b) c = a", [](T a, T b, T c) { return a >= b ? a : c; }},
  };
  if constexpr (std::is_floating_point_v<T>) {
    all.insert({
        {"a / b", [](T a, T b, T) { return a / b; }},
        {"a /= b", [](T a, T b, T) { return a / b; }},
        {"1 / a", [](T a, T, T) { return T(1) / a; }},
        {"2.0 / 3 * a", [](T a, T, T) { return T(2.0 / 3) * a; }},
        {"sqrt(a)", [](T a, T, T) { return std::sqrt(a); }},
        {"floor(a)", [](T a, T, T) { return std::floor(a); }},
        {"nearest(a)", [](T a, T, T) { return std::nearbyint(a); }},
        {"copysign(a, b)", [](T a, T b, T) { return std::copysign(a, b); }},
        {"fma(a, b, c)", [](T a, T b, T c) { return std::fma(a, b, c); }},
        {"a b + c", [](T a, T b, T c) { return a * b + c; }},
        {"log(a)", [](T a, T, T) { return std::log(a); }},
        {"log1p(a)", [](T a, T, T) { return std::log1p(a); }},
    });
  } else {
    all.insert({
        {"a & b", [](T a, T b, T) { return a & b; }},
        {"a | b", [](T a, T b, T) { return a | b; }},
        {"a << 0", [](T a, T, T) { return a; }},
        {"a << 5", [](T a, T, T) { return shifted_left(a, 5); }},
        {"a << 31", [](T a, T, T) { return shifted_left(a, 31); }},
        {"a >> 0", [](T a, T, T) { return a; }},
        {"a >> 5", [](T a, T, T) { return a >> 5; }},
        {"a >> 31", [](T a, T, T) { return a >> 31; }},
    });
  }
  return all;
}

/// Triples of numbers, `lanes` at a time: every pair of the special ones with a third, so that each
/// comes to stand in many lanes; and random bit patterns.
template <class T>
struct Triples {
  std::vector<T> a, b, c;
  explicit Triples(int lanes) {
    const std::vector<T> all = special<T>();
    std::mt19937_64 random(20261121);
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < all.size(); ++j) {
        add(all[i], all[j], all[(i * 7 + j * 3) % all.size()]);
      }
    }
    for (int i = 0; i < 20000; ++i) {
      add(pattern(random()), pattern(random()), pattern(random()));
      // Of like size, where sums cancel and products do not overflow.
      const T x = pattern(random());
      add(x, times(x, T(3)), negative(x));
    }
    while (a.size() % static_cast<std::size_t>(lanes) != 0) add(all[0], all[1], all[2]);
  }
  void add(T x, T y, T z) {
    a.push_back(x);
    b.push_back(y);
    c.push_back(z);
  }
  static T pattern(std::uint64_t bits) {
    T x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
  }
};

template <class T>
void expect_operations(const batch_operations::List<batch_operations::Operation<T>>& operations,
                       int lanes) {
  const Triples<T> triples(lanes);
  const auto all = truths<T>();
  std::size_t checked = 0;
  for (const auto& operation : operations) {
    const auto truth = all.find(operation.name);
    if (truth == all.end()) continue;
    ++checked;
    int failures = 0;
    for (std::size_t i = 0; i < triples.a.size(); i += static_cast<std::size_t>(lanes)) {
      T out[16];
      operation.run(&triples.a[i], &triples.b[i], &triples.c[i], out);
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(lanes); ++lane) {
        const T a = triples.a[i + lane], b = triples.b[i + lane], c = triples.c[i + lane];
        const T expected = truth->second(a, b, c);
        if (!same(out[lane], expected) && ++failures <= 3) {
          ADD_FAILURE() << operation.name << " in lane " << lane << ": a = " << a << ", b = " << b
                        << ", c = " << c << " gives " << out[lane] << " instead of " << expected;
        }
      }
    }
    EXPECT_EQ(failures, 0) << operation.name;
  }
  EXPECT_EQ(checked, all.size()) << "a truth has no operation of its name";
}

class Batches : public BatchTest {};
PELLUCID_EVERY_INSTRUCTION_SET(Batches);

TEST_P(Batches, FloatsAreThoseOfOneLane) {
  expect_operations(table().floats, lanes());
}
TEST_P(Batches, DoublesAreThoseOfOneLane) {
  expect_operations(table().doubles, lanes());
}
TEST_P(Batches, IntsAreThoseOfOneLane) {
  expect_operations(table().ints, lanes());
}

/// Fused or not, nothing else.
template <class T>
void expect_multiply_add(const batch_operations::List<batch_operations::Operation<T>>& operations,
                         int lanes, bool fused) {
  const Triples<T> triples(lanes);
  const auto* operation = find(operations, "multiply_add(a, b, c)");
  ASSERT_NE(operation, nullptr);
  for (std::size_t i = 0; i < triples.a.size(); i += static_cast<std::size_t>(lanes)) {
    T out[16];
    operation->run(&triples.a[i], &triples.b[i], &triples.c[i], out);
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(lanes); ++lane) {
      const T a = triples.a[i + lane], b = triples.b[i + lane], c = triples.c[i + lane];
      const T expected = fused ? std::fma(a, b, c) : a * b + c;
      ASSERT_TRUE(same(out[lane], expected)) << a << " " << b << " " << c;
    }
  }
}
TEST_P(Batches, ResultsBelowNormalNumbersAreZeroWhileTheyAreFlushed) {
  EXPECT_EQ(table().flushes, GetParam() != InstructionSet::neon64);
  const auto count = static_cast<std::size_t>(lanes());
  const std::vector<float> a(count, 1e-20f), tiny(count, 3e-20f), normal(count, 2e-18f);
  std::vector<float> within(count), behind(count);
  table().flushed(a.data(), tiny.data(), within.data(), behind.data());
  EXPECT_EQ(within, std::vector<float>(count, table().flushes ? 0.0f : 1e-20f * 3e-20f));
  EXPECT_EQ(behind, std::vector<float>(count, 1e-20f * 3e-20f));
  EXPECT_GT(behind[0], 0.0f);
  table().flushed(a.data(), normal.data(), within.data(), behind.data());
  EXPECT_EQ(within, std::vector<float>(count, 1e-20f * 2e-18f));
  // What is given is taken as it is.
  const std::vector<float> denormal(count, 1e-40f), large(count, 1e10f);
  table().flushed(denormal.data(), large.data(), within.data(), behind.data());
  EXPECT_EQ(within, behind);
  EXPECT_GT(within[0], 0.0f);
}

TEST_P(Batches, MultiplyAddIsFusedWhereThatIsOneInstruction) {
  EXPECT_EQ(table().fuses, GetParam() != InstructionSet::sse4);
  expect_multiply_add(table().floats, lanes(), table().fuses);
  expect_multiply_add(table().doubles, lanes(), table().fuses);
}

template <class T>
void expect_comparisons(const batch_operations::List<batch_operations::Comparison<T>>& comparisons,
                        int lanes) {
  std::map<std::string, std::function<bool(T, T)>> truths = {
      {"<", [](T a, T b) { return a < b; }},   {"<=", [](T a, T b) { return a <= b; }},
      {">", [](T a, T b) { return a > b; }},   {">=", [](T a, T b) { return a >= b; }},
      {"==", [](T a, T b) { return a == b; }}, {"!=", [](T a, T b) { return a != b; }},
  };
  if constexpr (std::is_floating_point_v<T>) {
    truths["is_nan"] = [](T a, T b) { return std::isnan(a) || std::isnan(b); };
  }
  const Triples<T> triples(lanes);
  for (const auto& [name, truth] : truths) {
    const auto* comparison = find(comparisons, name);
    ASSERT_NE(comparison, nullptr) << name;
    for (std::size_t i = 0; i < triples.a.size(); i += static_cast<std::size_t>(lanes)) {
      unsigned expected = 0;
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(lanes); ++lane) {
        if (truth(triples.a[i + lane], triples.b[i + lane])) expected |= 1u << lane;
      }
      ASSERT_EQ(comparison->run(&triples.a[i], &triples.b[i]), expected)
          << name << ", first lane: " << triples.a[i] << " " << triples.b[i];
    }
  }
}
TEST_P(Batches, ComparisonsAreThoseOfOneLane) {
  expect_comparisons(table().compare_floats, lanes());
  expect_comparisons(table().compare_doubles, lanes());
  expect_comparisons(table().compare_ints, lanes());
}

TEST_P(Batches, MasksAreBits) {
  const unsigned every = (1u << lanes()) - 1;
  const std::map<std::string, std::function<unsigned(unsigned, unsigned, unsigned)>> truths = {
      {"a", [](unsigned a, unsigned, unsigned) { return a; }},
      {"a & b", [](unsigned a, unsigned b, unsigned) { return a & b; }},
      {"a | b", [](unsigned a, unsigned b, unsigned) { return a | b; }},
      {"a ^ b", [](unsigned a, unsigned b, unsigned) { return a ^ b; }},
      {"!a", [=](unsigned a, unsigned, unsigned) { return every & ~a; }},
      {"a == b", [=](unsigned a, unsigned b, unsigned) { return every & ~(a ^ b); }},
      {"a != b", [](unsigned a, unsigned b, unsigned) { return a ^ b; }},
      {"a &= b", [](unsigned a, unsigned b, unsigned) { return a & b; }},
      {"a |= b", [](unsigned a, unsigned b, unsigned) { return a | b; }},
      {"a ^= b", [](unsigned a, unsigned b, unsigned) { return a ^ b; }},
      {"a ? b : c", [](unsigned a, unsigned b, unsigned c) { return (a & b) | (~a & c); }},
      {"if (a) b = c", [](unsigned a, unsigned b, unsigned c) { return (a & c) | (~a & b); }},
      {"any", [](unsigned a, unsigned, unsigned) { return a != 0 ? 1u : 0u; }},
      {"all", [=](unsigned a, unsigned, unsigned) { return a == every ? 1u : 0u; }},
      {"none", [](unsigned a, unsigned, unsigned) { return a == 0 ? 1u : 0u; }},
      {"all !a", [](unsigned a, unsigned, unsigned) { return a == 0 ? 1u : 0u; }},
      {"count",
       [](unsigned a, unsigned, unsigned) {
         unsigned sum = 0;
         for (int i = 0; i < 32; ++i) sum += (a >> i) & 1u;
         return sum;
       }},
      {"[]", [=](unsigned a, unsigned,
                 unsigned) { return (a & 1u) | ((a & (every + 1) / 2) ? 2u : 0u); }},
      {"true", [=](unsigned, unsigned, unsigned) { return every; }},
      {"false", [](unsigned, unsigned, unsigned) { return 0u; }},
      {"through doubles", [](unsigned a, unsigned, unsigned) { return a; }},
      {"through floats", [](unsigned a, unsigned, unsigned) { return a; }},
      {"through ints", [](unsigned a, unsigned, unsigned) { return a; }},
  };
  EXPECT_EQ(static_cast<int>(truths.size()), table().masks.count);
  std::mt19937 random(1);
  for (const auto& [name, truth] : truths) {
    const auto* operation = find(table().masks, name);
    ASSERT_NE(operation, nullptr) << name;
    for (unsigned a = 0; a <= every; ++a) {
      const unsigned b = static_cast<unsigned>(random()) & every,
                     c = static_cast<unsigned>(random()) & every;
      ASSERT_EQ(operation->run(a, b, c), truth(a, b, c))
          << name << " " << a << " " << b << " " << c;
    }
  }
}

template <class To, class From>
void expect_conversion(void (*conversion)(const From*, To*), int lanes) {
  const Triples<From> triples(lanes);
  int converted = 0;
  for (std::size_t i = 0; i < triples.a.size(); i += static_cast<std::size_t>(lanes)) {
    To out[16];
    conversion(&triples.a[i], out);
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(lanes); ++lane) {
      const From x = triples.a[i + lane];
      if constexpr (std::is_same_v<To, std::int32_t>) {
        if (!(x > From(-2147483649.0) && x < From(2147483648.0))) {
          ASSERT_EQ(out[lane], Limits<To>::min()) << x;
          continue;
        }
      }
      ++converted;
      ASSERT_TRUE(same(out[lane], static_cast<To>(x))) << x << " gives " << out[lane];
    }
  }
  EXPECT_GT(converted, 1000);
}
TEST_P(Batches, ConversionsAreThoseOfOneLane) {
  expect_conversion(table().float_to_int, lanes());
  expect_conversion(table().float_to_double, lanes());
  expect_conversion(table().double_to_int, lanes());
  expect_conversion(table().double_to_float, lanes());
  expect_conversion(table().int_to_float, lanes());
  expect_conversion(table().int_to_double, lanes());
}

}  // namespace
}  // namespace pellucid::test
