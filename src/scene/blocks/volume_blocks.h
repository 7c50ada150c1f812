// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <mutex>
#include <vector>

#include "pellucid/traverse/block_records.h"

namespace pellucid {

/// The records of a volume's blocks and the planes between them, once they are built.
class VolumeBlocks {
 public:
  // A once_flag would do, but under the thread sanitizer it never is free again after an exception.
  std::mutex building;
  std::atomic<bool> built{false};
  std::vector<BlockRecord> record;
  std::array<std::vector<double>, 3> plane;
  BlockRecords view;
};

}  // namespace pellucid
