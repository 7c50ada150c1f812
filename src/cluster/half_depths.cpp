// SPDX-License-Identifier: Apache-2.0
#include "half_depths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pellucid/cluster/render.h"
#include "pellucid/cpu/internal/find_depths.h"

namespace pellucid {
namespace {

/// Opacity that rounding may hide from each of two bricks between which the half lies.
constexpr double beside = 1e-5;
/// Rays whose depths are reduced at once, in double.
constexpr std::size_t max_at_once = std::size_t{1} << 20;

}  // namespace

std::vector<float> half_depths(Communicator& ranks, int place, const Scene& rays,
                               const RenderOptions& options, const std::vector<RayPixel>& composite,
                               const std::vector<RayPixel>& own) {
  std::vector<float> opacity(own.size());
  if (ranks.rank() == 0) {
    std::ranges::transform(composite, opacity.begin(), &RayPixel::opacity);
  }
  ranks.broadcast(opacity);
  std::vector<RayPixel> in_front = own;
  ranks.composite_in_front(in_front, place);

  std::vector<float> depth(own.size(), std::numeric_limits<float>::infinity());
  std::vector<DepthRequest> requests;
  std::vector<std::size_t> of;
  const auto width = static_cast<std::size_t>(rays.size.width);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const double half = 0.5 * double{opacity[i]}, front = double{in_front[i].opacity};
    const double behind = front + (1 - front) * double{own[i].opacity};
    if (!(own[i].opacity > 0) || front >= half || behind < half * (1 - beside)) continue;
    // There the transparency is 1 - half.
    const double optical_depth = std::max(std::log1p(-front) - std::log1p(-half), 0.0);
    requests.push_back({static_cast<int>(i % width), static_cast<int>(i / width), optical_depth});
    of.push_back(i);
  }
  agreed(ranks, [&] {
    const std::vector<double> found = find_depths(rays, options, requests);
    for (std::size_t i = 0; i < of.size(); ++i) depth[of[i]] = static_cast<float>(found[i]);
  });
  // The nearest, where two bricks meet.
  std::vector<double> some;
  for (std::size_t first = 0; first < depth.size(); first += max_at_once) {
    const auto begin = depth.begin() + static_cast<std::ptrdiff_t>(first);
    const std::size_t count = std::min(max_at_once, depth.size() - first);
    some.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    ranks.reduce_all(some, Communicator::Reduction::minimum);
    std::ranges::transform(some, begin, [](double one) { return static_cast<float>(one); });
  }
  return depth;
}

}  // namespace pellucid
