// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/simd/batch_operations.h"
#include "tests/simd/every_instruction_set.h"

namespace pellucid::test {

class BatchTest : public EveryInstructionSet {
 protected:
  static const batch_operations::Table& table() {
    return *choose(pellucid_batch_operations_sse4, pellucid_batch_operations_avx2,
                   pellucid_batch_operations_avx512)();
  }
  static int lanes() { return table().lanes; }
};

template <class Item>
const Item* find(const batch_operations::List<Item>& list, const std::string& name) {
  for (const Item& item : list) {
    if (item.name == name) return &item;
  }
  return nullptr;
}

}  // namespace pellucid::test
