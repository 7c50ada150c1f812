// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "benchmarks/frames/curve.h"
#include "pellucid/scene/scene.h"

namespace pellucid::bench {

/// The curves of all contenders on one scene.
struct SceneResult {
  std::string name;
  ImageSize size;
  std::string data;        ///< dimensions and type
  std::size_t pixels = 0;  ///< of the image, that were compared
  std::vector<Curve> curves;
  std::vector<std::string> left_out;  ///< contenders that could not run, and why

  const Curve* find(const std::string& name) const;  ///< null: not measured
};

}  // namespace pellucid::bench
