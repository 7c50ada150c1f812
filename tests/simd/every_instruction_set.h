// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "pellucid/simd/instruction_set.h"

namespace pellucid {

inline void PrintTo(InstructionSet set, std::ostream* out) {
  *out << name_of(set);
}

}  // namespace pellucid

namespace pellucid::test {

/// A test that runs once per instruction set, skipped where the machine has it not.
class EveryInstructionSet : public testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    if (!is_supported(GetParam())) {
      GTEST_SKIP() << "this processor has no " << name_of(GetParam()) << ": not tested here";
    }
  }
  /// Of three entries, the one of this set.
  template <class Entry>
  static Entry* choose(Entry* sse4, Entry* avx2, Entry* avx512) {
    return GetParam() == InstructionSet::avx512 ? avx512
           : GetParam() == InstructionSet::avx2 ? avx2
                                                : sse4;
  }
};

inline std::string name_of_parameter(const testing::TestParamInfo<InstructionSet>& info) {
  return name_of(info.param);
}

#define PELLUCID_EVERY_INSTRUCTION_SET(suite)                                              \
  INSTANTIATE_TEST_SUITE_P(                                                                \
      , suite,                                                                             \
      testing::Values(InstructionSet::sse4, InstructionSet::avx2, InstructionSet::avx512), \
      name_of_parameter)

}  // namespace pellucid::test
