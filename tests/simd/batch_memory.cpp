// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <type_traits>
#include <vector>

#include "tests/simd/batch_fixture.h"

/// Loads from many places at once: what they give, and that they read nothing else.
namespace pellucid::test {
namespace {

/// Memory that may be read, between two pages that may not: what ends at end() or begins at begin()
/// faults when it is read beyond.
class Guarded {
 public:
  Guarded() : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) {
    void* all =
        mmap(nullptr, 4 * page_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    EXPECT_NE(all, MAP_FAILED);
    all_ = static_cast<unsigned char*>(all);
    EXPECT_EQ(mprotect(all_, page_, PROT_NONE), 0);
    EXPECT_EQ(mprotect(all_ + 3 * page_, page_, PROT_NONE), 0);
  }
  ~Guarded() { munmap(all_, 4 * page_); }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

  template <class T>
  T* begin() const {
    return reinterpret_cast<T*>(all_ + page_);
  }
  template <class T>
  T* end() const {
    return reinterpret_cast<T*>(all_ + 3 * page_);
  }
  template <class T>
  std::int32_t count() const {
    return static_cast<std::int32_t>(2 * page_ / sizeof(T));
  }
  /// Every bit pattern that may be, but of floats only numbers.
  template <class T>
  void fill() const {
    std::mt19937_64 random(3);
    for (T* p = begin<T>(); p != end<T>(); ++p) {
      if constexpr (std::is_floating_point_v<T>) {
        *p = static_cast<T>(static_cast<double>(random()) * 0x1p-60 - 8.0);
      } else {
        *p = static_cast<T>(random());
      }
    }
  }

 private:
  std::size_t page_;
  unsigned char* all_ = nullptr;
};

/// Places for every lane, 0 … last: the ends in each lane in turn, else anything.
std::vector<std::vector<std::int32_t>> places(int lanes, std::int32_t last) {
  std::vector<std::vector<std::int32_t>> all;
  all.push_back(std::vector<std::int32_t>(static_cast<std::size_t>(lanes), last));
  all.push_back(std::vector<std::int32_t>(static_cast<std::size_t>(lanes), 0));
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int32_t> anywhere(0, last);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::int32_t> one;
    for (int lane = 0; lane < lanes; ++lane) {
      one.push_back(lane == round % lanes ? (round % 3 == 0 ? 0 : last) : anywhere(random));
    }
    all.push_back(one);
  }
  return all;
}

class BatchMemory : public BatchTest {};
PELLUCID_EVERY_INSTRUCTION_SET(BatchMemory);

template <class T>
void expect_gather(void (*gather)(const T*, const std::int32_t*, T*), int lanes) {
  const Guarded memory;
  memory.fill<T>();
  for (const auto& index : places(lanes, memory.count<T>() - 1)) {
    T out[16];
    gather(memory.begin<T>(), index.data(), out);
    for (std::size_t lane = 0; lane < index.size(); ++lane) {
      ASSERT_EQ(out[lane], memory.begin<T>()[index[lane]]) << lane;
    }
    // Backwards from the end.
    std::vector<std::int32_t> negative = index;
    for (std::int32_t& i : negative) i -= memory.count<T>();
    gather(memory.end<T>(), negative.data(), out);
    for (std::size_t lane = 0; lane < index.size(); ++lane) {
      ASSERT_EQ(out[lane], memory.end<T>()[negative[lane]]) << lane;
    }
  }
}
TEST_P(BatchMemory, GatherReadsEveryLaneAndNothingElse) {
  expect_gather(table().gather_floats, lanes());
  expect_gather(table().gather_doubles, lanes());
  expect_gather(table().gather_ints, lanes());
}

template <class T>
void expect_lookup(void (*lookup)(const T*, const std::int32_t*, T*), std::int32_t entries,
                   int lanes) {
  std::vector<T> table;
  for (std::int32_t i = 0; i < entries; ++i) table.push_back(T(1000 + 7 * i));
  for (const auto& index : places(lanes, entries - 1)) {
    T out[16];
    lookup(table.data(), index.data(), out);
    for (std::size_t lane = 0; lane < index.size(); ++lane) {
      ASSERT_EQ(out[lane], table[static_cast<std::size_t>(index[lane])]) << lane;
    }
  }
}
TEST_P(BatchMemory, SmallTablesAreLookedUp) {
  expect_lookup(table().lookup_floats, 16, lanes());
  expect_lookup(table().lookup_doubles, 16, lanes());
  expect_lookup(table().lookup_ints, 16, lanes());
  expect_lookup(table().lookup_of_five, 5, lanes());
}

template <class Value>
void expect_pairs(batch_operations::PairLoad<Value> load, int lanes) {
  const Guarded memory;
  memory.fill<Value>();
  for (const auto& place : places(lanes, memory.count<Value>() - 2)) {
    // A base of its own in every lane, in the middle of which the offset starts.
    const Value* base[16];
    std::int32_t offset[16];
    for (int lane = 0; lane < lanes; ++lane) {
      const std::int32_t start = (lane * 37) % memory.count<Value>();
      base[lane] = memory.begin<Value>() + start;
      offset[lane] = place[static_cast<std::size_t>(lane)] - start;
    }
    float first[16], second[16];
    load(base, offset, first, second);
    for (int lane = 0; lane < lanes; ++lane) {
      const Value* pair = memory.begin<Value>() + place[static_cast<std::size_t>(lane)];
      ASSERT_EQ(first[lane], static_cast<float>(pair[0])) << "lane " << lane;
      ASSERT_EQ(second[lane], static_cast<float>(pair[1])) << "lane " << lane;
    }
  }
}
TEST_P(BatchMemory, PairsAreReadInEveryTypeAndNothingElse) {
  expect_pairs(table().pairs_u8, lanes());
  expect_pairs(table().pairs_i8, lanes());
  expect_pairs(table().pairs_u16, lanes());
  expect_pairs(table().pairs_i16, lanes());
  expect_pairs(table().pairs_u32, lanes());
  expect_pairs(table().pairs_i32, lanes());
  expect_pairs(table().pairs_float, lanes());
  expect_pairs(table().pairs_double, lanes());
}

template <class Value>
void expect_rows(batch_operations::RowLoad<Value> load, int lanes) {
  const Guarded memory;
  memory.fill<Value>();
  const std::int32_t last = memory.count<Value>() - 2;
  // The last one is the other way round.
  for (const std::ptrdiff_t apart : {1, 5, last / 3, -(last / 3)}) {
    const std::ptrdiff_t row[4] = {0, apart, 2 * apart, 3 * apart};
    for (auto place : places(lanes, last - static_cast<std::int32_t>(std::abs(row[3])))) {
      const Value* base[16];
      std::int32_t offset[16];
      for (int lane = 0; lane < lanes; ++lane) {
        std::int32_t& at = place[static_cast<std::size_t>(lane)];
        if (apart < 0) at -= static_cast<std::int32_t>(row[3]);
        const std::int32_t start = (lane * 37) % memory.count<Value>();
        base[lane] = memory.begin<Value>() + start;
        offset[lane] = at - start;
      }
      float out[8 * 16];
      load(base, offset, row, out);
      for (int lane = 0; lane < lanes; ++lane) {
        for (int k = 0; k < 8; ++k) {
          const std::ptrdiff_t at = place[static_cast<std::size_t>(lane)] + row[k / 2] + k % 2;
          ASSERT_EQ(out[k * lanes + lane], static_cast<float>(memory.begin<Value>()[at]))
              << "lane " << lane << ", value " << k;
        }
      }
    }
  }
}
TEST_P(BatchMemory, PairsInRowsAreReadOneByOneAndByGathers) {
  expect_rows(table().rows_u16, lanes());
  expect_rows(table().rows_float, lanes());
  expect_rows(table().loaded_rows_float, lanes());
  if (table().gathered_rows_float == nullptr) {
    EXPECT_LT(lanes(), 16);
  } else {
    expect_rows(table().gathered_rows_float, lanes());
  }
}

/// Integers of 32 bits are rounded to float once: halfway cases and their neighbours.
TEST_P(BatchMemory, LargeIntegersAreRoundedOnce) {
  std::vector<std::uint32_t> values = {0u, 1u, 0x7fffffffu, 0x80000000u, 0xffffffffu};
  for (int shift = 0; shift < 8; ++shift) {
    for (std::uint32_t near = 0; near < 64; ++near) {
      values.push_back(((0x01000000u + near) << shift) - 3u);
      values.push_back(((0x00ffffe0u + near) << shift) + 129u);
    }
  }
  while (values.size() % 32 != 0) values.push_back(0u);
  const std::size_t step = 2 * static_cast<std::size_t>(lanes());
  for (std::size_t i = 0; i < values.size(); i += step) {
    const std::uint32_t* base[16];
    const std::int32_t* signed_base[16];
    std::vector<std::int32_t> as_signed(step);
    std::memcpy(as_signed.data(), &values[i], step * sizeof(std::int32_t));
    std::int32_t offset[16];
    for (int lane = 0; lane < lanes(); ++lane) {
      base[lane] = &values[i];
      signed_base[lane] = as_signed.data();
      offset[lane] = 2 * lane;
    }
    float first[16], second[16];
    table().pairs_u32(base, offset, first, second);
    for (int lane = 0; lane < lanes(); ++lane) {
      ASSERT_EQ(first[lane], static_cast<float>(base[0][offset[lane]])) << base[0][offset[lane]];
      ASSERT_EQ(second[lane], static_cast<float>(base[0][offset[lane] + 1]));
    }
    table().pairs_i32(signed_base, offset, first, second);
    for (int lane = 0; lane < lanes(); ++lane) {
      ASSERT_EQ(first[lane], static_cast<float>(as_signed[static_cast<std::size_t>(2 * lane)]));
    }
  }
}

template <class T>
void expect_records(void (*load)(const T*, const std::int32_t*, T*), int fields, int lanes) {
  const Guarded memory;
  memory.fill<T>();
  for (const auto& index : places(lanes, memory.count<T>() / fields - 1)) {
    T out[16 * 16];
    load(memory.begin<T>(), index.data(), out);
    for (int k = 0; k < fields; ++k) {
      for (int lane = 0; lane < lanes; ++lane) {
        ASSERT_EQ(out[k * lanes + lane],
                  memory.begin<T>()[fields * index[static_cast<std::size_t>(lane)] + k])
            << "field " << k << ", lane " << lane;
      }
    }
  }
}
TEST_P(BatchMemory, RecordsAreReadAndNothingElse) {
  expect_records(table().records_4, 4, lanes());
  expect_records(table().records_8, 8, lanes());
  expect_records(table().records_16, 16, lanes());
  expect_records(table().int_records_8, 8, lanes());
  expect_records(table().double_records_4, 4, lanes());
}

TEST_P(BatchMemory, RecordsAreWrittenAndNothingElse) {
  constexpr int fields = 8;
  const auto n = static_cast<std::size_t>(lanes());
  std::vector<float> in(fields * n);
  for (std::size_t i = 0; i < in.size(); ++i) in[i] = static_cast<float>(i + 1);
  std::mt19937 random(9);
  for (int round = 0; round < 100; ++round) {
    std::vector<std::int32_t> index(3 * n);
    std::iota(index.begin(), index.end(), 0);
    std::shuffle(index.begin(), index.end(), random);
    const Guarded memory;
    // The last record ends where the memory does.
    float* base = memory.end<float>() - fields * index.size();
    std::vector<float> expected(fields * index.size(), -1.0f);
    std::copy(expected.begin(), expected.end(), base);
    table().store_records_8(in.data(), base, index.data());
    for (std::size_t lane = 0; lane < n; ++lane) {
      for (std::size_t k = 0; k < fields; ++k) {
        expected[fields * static_cast<std::size_t>(index[lane]) + k] = in[k * n + lane];
      }
    }
    ASSERT_TRUE(std::equal(expected.begin(), expected.end(), base));
  }
}

template <class T>
void expect_packed(void (*store)(unsigned, const T*, T*), int lanes) {
  std::vector<T> in;
  for (int l = 0; l < lanes; ++l) in.push_back(T(100 + l));
  for (unsigned mask = 0; mask < 1u << lanes; ++mask) {
    // N numbers may be written, however few are asked for.
    const Guarded memory;
    T* to = memory.end<T>() - 2 * lanes + 1;
    to[-1] = T(7);
    store(mask, in.data(), to);
    for (int l = 0; l < lanes; ++l) {
      if ((mask >> l & 1) == 0) continue;
      ASSERT_EQ(*to++, in[static_cast<std::size_t>(l)]) << mask;
    }
    ASSERT_EQ((memory.end<T>() - 2 * lanes)[0], T(7));
    if (lanes == 16) mask += 30;
  }
}
TEST_P(BatchMemory, LanesArePackedInOrder) {
  expect_packed(table().store_packed_floats, lanes());
  expect_packed(table().store_packed_doubles, lanes());
  expect_packed(table().store_packed_ints, lanes());
}

template <class T>
void expect_spread(void (*load)(unsigned, const T*, T*), int lanes) {
  const Guarded memory;
  memory.fill<T>();
  const T* from = memory.end<T>() - lanes;
  for (unsigned mask = 0; mask < 1u << lanes; ++mask) {
    T lane[16];
    for (int l = 0; l < lanes; ++l) lane[l] = T(100 + l);
    load(mask, from, lane);
    const T* next = from;
    for (int l = 0; l < lanes; ++l) {
      ASSERT_EQ(lane[l], (mask >> l & 1) != 0 ? *next++ : T(100 + l)) << mask << ", " << l;
    }
    if (lanes == 16) mask += 30;
  }
}
TEST_P(BatchMemory, ConsecutiveNumbersAreSpreadOverLanes) {
  expect_spread(table().load_spread_floats, lanes());
  expect_spread(table().load_spread_doubles, lanes());
  expect_spread(table().load_spread_ints, lanes());
}

TEST_P(BatchMemory, BitsAreTakenForFloats) {
  std::int32_t bits[16];
  float expected[16], found[16];
  for (int l = 0; l < 16; ++l) {
    expected[l] = (l % 2 == 0 ? 1.0f : -1.0f) * std::ldexp(1.25f, 17 * l - 140);
    std::memcpy(&bits[l], &expected[l], sizeof(float));
  }
  table().float_of_bits(bits, found);
  for (int l = 0; l < lanes(); ++l) ASSERT_EQ(found[l], expected[l]);
}

/// That the guard guards.
TEST(BatchMemoryDeathTest, ReadingBeyondTheEndFaults) {
  const Guarded memory;
  EXPECT_DEATH(
      {
        volatile float value = *static_cast<volatile float*>(memory.end<float>());
        (void)value;
      },
      "");
}

}  // namespace
}  // namespace pellucid::test
