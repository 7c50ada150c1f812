// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "pellucid/cluster/brick_tree.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/cpu/renderer.h"

namespace pellucid {

/// A frame of which each rank has rendered its part.
struct RenderedParts {
  const BrickTree& tree;
  Renderer& renderer;                ///< that rendered the part
  const Scene& rays;                 ///< scene_of_rays()
  const RenderOptions& options;      ///< of the part
  int place = 0;                     ///< of the part, from the camera on
  int most_bricks = 1;               ///< among which `rays` divides the tolerance
  std::vector<RayPixel>& own;        ///< what the part gathers
  std::vector<RayPixel>& composite;  ///< on rank 0, of all parts
};

/// Renders rays again whose parts report more than the tolerance together. Bricks share the
/// tolerance of a ray equally at first, and a rule may fail to keep to a small share:
///
/// 1. Bricks that exceeded their share get all that the others left.
/// 2. If that is not enough, the others get what these leave of the tolerance.
///
/// A part is replaced where it reports less than before. `over`, on rank 0: indices of rays. The
/// first few of them are tried alone; if none comes within the tolerance, the rest is left. Returns
/// how many parts of rays were rendered again, on all ranks. All ranks call it. `together` does
/// work on all of them, and throws on all if it fails on one.
std::uint64_t look_again(Communicator& ranks, const RenderedParts& parts,
                         const std::vector<std::size_t>& over,
                         const std::function<void(const std::function<void()>&)>& together);

}  // namespace pellucid
