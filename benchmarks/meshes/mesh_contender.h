// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "benchmarks/frames/contender.h"

namespace pellucid::bench {

/// What rays met in a frame.
struct MeshCrossings {
  std::uint64_t segments = 0;    ///< pieces of rays in one tetrahedron
  std::uint64_t nan_pixels = 0;  ///< whose color was no number before it became 8 bits
};

/// A way of rendering a mesh.
struct MeshContender {
  std::string name;
  bool threaded = true;  ///< false: it runs on one thread whatever it is told
  std::function<TimedFrame(int threads)> render;
  std::function<MeshCrossings()> count{};  ///< a frame that is not timed; empty: TimedFrame::work
};

}  // namespace pellucid::bench
