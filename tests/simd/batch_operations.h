// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/simd/instruction_set.h"

/// What batch_operations.cpp, compiled once per instruction set, gives to the test, which is
/// compiled for none: plain functions on `lanes` numbers each.
namespace batch_operations {

template <class T>
struct Operation {
  const char* name;
  void (*run)(const T* a, const T* b, const T* c, T* out);
};
/// A mask's bits.
template <class T>
struct Comparison {
  const char* name;
  unsigned (*run)(const T* a, const T* b);
};
struct MaskOperation {
  const char* name;
  unsigned (*run)(unsigned a, unsigned b, unsigned c);
};
template <class Item>
struct List {
  const Item* items;
  int count;
  const Item* begin() const { return items; }
  const Item* end() const { return items + count; }
};

template <class Value>
using PairLoad = void (*)(const Value* const* base, const std::int32_t* offset, float* first,
                          float* second);
template <class Value>
using RowLoad = void (*)(const Value* const* base, const std::int32_t* offset,
                         const std::ptrdiff_t (&row)[4], float* out);

struct Table {
  int lanes;
  List<Operation<float>> floats;
  List<Operation<double>> doubles;
  List<Operation<std::int32_t>> ints;
  List<Comparison<float>> compare_floats;
  List<Comparison<double>> compare_doubles;
  List<Comparison<std::int32_t>> compare_ints;
  List<MaskOperation> masks;

  void (*float_to_int)(const float*, std::int32_t*);
  void (*float_to_double)(const float*, double*);
  void (*double_to_int)(const double*, std::int32_t*);
  void (*double_to_float)(const double*, float*);
  void (*int_to_float)(const std::int32_t*, float*);
  void (*int_to_double)(const std::int32_t*, double*);

  void (*gather_floats)(const float* base, const std::int32_t* index, float* out);
  void (*gather_doubles)(const double* base, const std::int32_t* index, double* out);
  void (*gather_ints)(const std::int32_t* base, const std::int32_t* index, std::int32_t* out);
  /// Tables of 16, and one of 5.
  void (*lookup_floats)(const float* table, const std::int32_t* index, float* out);
  void (*lookup_doubles)(const double* table, const std::int32_t* index, double* out);
  void (*lookup_ints)(const std::int32_t* table, const std::int32_t* index, std::int32_t* out);
  void (*lookup_of_five)(const float* table, const std::int32_t* index, float* out);
  PairLoad<std::uint8_t> pairs_u8;
  PairLoad<std::int8_t> pairs_i8;
  PairLoad<std::uint16_t> pairs_u16;
  PairLoad<std::int16_t> pairs_i16;
  PairLoad<std::uint32_t> pairs_u32;
  PairLoad<std::int32_t> pairs_i32;
  PairLoad<float> pairs_float;
  PairLoad<double> pairs_double;
  /// rows[] of four; out[k * lanes + lane], k < 8.
  RowLoad<std::uint16_t> rows_u16;
  RowLoad<float> rows_float, loaded_rows_float, gathered_rows_float;  ///< the last: may be null
  /// out[k * lanes + lane]
  void (*records_4)(const float* base, const std::int32_t* index, float* out);
  void (*records_8)(const float* base, const std::int32_t* index, float* out);
  void (*records_16)(const float* base, const std::int32_t* index, float* out);
  void (*int_records_8)(const std::int32_t* base, const std::int32_t* index, std::int32_t* out);
  void (*double_records_4)(const double* base, const std::int32_t* index, double* out);
  /// in[k * lanes + lane]
  void (*store_records_8)(const float* in, float* base, const std::int32_t* index);
  /// Of the lanes whose bit is set.
  void (*store_packed_floats)(unsigned lanes, const float* in, float* to);
  void (*store_packed_doubles)(unsigned lanes, const double* in, double* to);
  void (*store_packed_ints)(unsigned lanes, const std::int32_t* in, std::int32_t* to);
  void (*load_spread_floats)(unsigned lanes, const float* from, float* in_out);
  void (*load_spread_doubles)(unsigned lanes, const double* from, double* in_out);
  void (*load_spread_ints)(unsigned lanes, const std::int32_t* from, std::int32_t* in_out);
  void (*float_of_bits)(const std::int32_t* in, float* out);
  /// Whether multiply_add() is fused, and whether FlushToZero does anything.
  bool fuses, flushes;
  /// a · b while there is a FlushToZero, and when it is gone.
  void (*flushed)(const float* a, const float* b, float* out, float* out_behind);
};

}  // namespace batch_operations

extern "C" {
PELLUCID_DECLARE_ENTRIES(const batch_operations::Table*, pellucid_batch_operations, ());
}
