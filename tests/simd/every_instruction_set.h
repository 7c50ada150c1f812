// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "tests/support/instruction_sets.h"

namespace pellucid {

inline void PrintTo(InstructionSet set, std::ostream* out) {
  *out << name_of(set);
}

}  // namespace pellucid

namespace pellucid::test {

/// A test that runs once per instruction set, skipped where this build or this machine does without
/// it.
class EveryInstructionSet : public testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    const InstructionSet set = GetParam();
    if (!is_built(set)) GTEST_SKIP() << name_of(set) << " is not built: not tested here";
    if (!is_supported(set)) {
      GTEST_SKIP() << "this processor has no " << name_of(set) << ": not tested here";
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
