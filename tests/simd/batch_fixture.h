// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/simd/batch_operations.h"
#include "tests/simd/every_instruction_set.h"

namespace pellucid::test {

class BatchTest : public EveryInstructionSet {
 protected:
  static const batch_operations::Table& table() {
    return *choose(PELLUCID_ENTRIES(pellucid_batch_operations))();
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
