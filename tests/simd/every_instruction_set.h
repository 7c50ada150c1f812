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
  /// Of the entries of all sets, that of this one.
  template <class... Entry>
  static auto choose(Entry*... entry) {
    return entry_of(GetParam(), entry...);
  }
};

inline std::string name_of_parameter(const testing::TestParamInfo<InstructionSet>& info) {
  return name_of(info.param);
}

#define PELLUCID_EVERY_INSTRUCTION_SET(suite) \
  INSTANTIATE_TEST_SUITE_P(, suite, testing::ValuesIn(packet_sets), name_of_parameter)

}  // namespace pellucid::test
