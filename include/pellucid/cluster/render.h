// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/cluster/brick_tree.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// Statistics of a frame that ranks rendered. All ranks get it.
struct RankReport {
  /// Sums over the ranks, but for the seconds, which are those of the slowest, and the threads,
  /// which are those of one rank.
  RenderReport frame;
  std::vector<double> render_seconds;     ///< of each rank, without waiting
  std::vector<double> composite_seconds;  ///< of each rank, from the moment that all have rendered
  int most_bricks = 0;                    ///< that any ray meets
  /// Parts of rays that were rendered again, because all parts of a ray reported more than the
  /// tolerance together.
  std::uint64_t parts_again = 0;
};

/// A frame of ranks and how it was made.
struct RankResult {
  Image image;
  RankReport report;
};

/// Renders a frame of a scene whose data lie on several ranks: on rank n in brick n of the tree,
/// which is the same on all ranks. `own` is the scene with this rank's data: every layer is there
/// on each rank, with the same functions, and has at least the values around the brick
/// (sub_scene()). Rank 0 returns the image, as render() would of the whole; the others an image of
/// no size. Each pixel is within the scene's tolerance.
///
/// `options.monitor.progress` is called on each rank, on rank 0 with the fraction that all have
/// done. If it returns false on any, or one rank fails, all of them stop and throw: Cancelled, or
/// Error with the rank and its message. Throws Error if the ranks disagree about the frame or the
/// version. The options' preview, tiles and region are not used.
RankResult render(Communicator& ranks, const BrickTree& tree, const Scene& own,
                  const RenderOptions& options = {});

/// Returns the same of a scene that every rank has whole. Each renders its brick without a copy of
/// the rest: for tests, and data that are mapped files.
RankResult render(Communicator& ranks, const Scene& whole, const RenderOptions& options = {});

/// An error that all ranks know of: each throws the same.
class AgreedError : public Error {
 public:
  using Error::Error;
};

/// Does work on each rank, and throws on all of them if it throws on any: Cancelled if it was
/// cancelled, else AgreedError with the first rank that failed and its message.
void agreed(Communicator& ranks, const std::function<void()>& work);

/// Throws AgreedError on all ranks unless the texts of all are equal; `what` names what they are
/// of: "the version". A difference is reported with both.
void check_equal(Communicator& ranks, const std::string& what, const std::string& own);
/// Compares several texts likewise, each behind what it is of. Ranks exchange a checksum of them,
/// and the texts themselves if it differs.
void check_equal(Communicator& ranks, const std::vector<std::pair<std::string, std::string>>& own);

}  // namespace pellucid
