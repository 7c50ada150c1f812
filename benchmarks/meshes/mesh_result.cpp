// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/meshes/mesh_result.h"

#include "benchmarks/support/interleave.h"

namespace pellucid::bench {

double MeshWay::median_seconds() const {
  return median(seconds);
}

const MeshWay* MeshResult::find(const std::string& way, int threads) const {
  for (const MeshWay& one : ways) {
    if (one.name == way && one.threads == threads) return &one;
  }
  return nullptr;
}

const MeshWay* MeshResult::find(const std::string& way) const {
  const MeshWay* least = nullptr;
  for (const MeshWay& one : ways) {
    if (one.name == way && (least == nullptr || one.threads < least->threads)) least = &one;
  }
  return least;
}

}  // namespace pellucid::bench
