// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/scene_result.h"

namespace pellucid::bench {

const Curve* SceneResult::find(const std::string& curve_name) const {
  for (const Curve& curve : curves) {
    if (curve.name == curve_name) return &curve;
  }
  return nullptr;
}

}  // namespace pellucid::bench
