// SPDX-License-Identifier: Apache-2.0
#include "tests/simd/determinants.h"

#include "pellucid/math/determinant.h"
#include "pellucid/simd/batch.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {
namespace {

template <class T>
void run(const T* const in[4], T* out) {
  using B = Batch<T, PELLUCID_LANES>;
  determinant(B::load(in[0]), B::load(in[1]), B::load(in[2]), B::load(in[3])).store(out);
}

constexpr simd_determinants::Table table = {PELLUCID_LANES, run<float>, run<double>};

}  // namespace
}  // namespace pellucid

extern "C" const simd_determinants::Table* PELLUCID_ENTRY(pellucid_simd_determinants)() {
  return &pellucid::table;
}
