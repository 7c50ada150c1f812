// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/animation.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

bool Animation::moves_data() const noexcept {
  return time || by_steps ||
         std::any_of(tracks.begin(), tracks.end(),
                     [](const AnimationTrack& track) { return track.target == time_target; });
}

int frame_count(const Animation& animation) {
  return static_cast<int>(
      std::clamp(std::round(animation.seconds * animation.fps), 1.0, double(most_frames)));
}

}  // namespace pellucid
