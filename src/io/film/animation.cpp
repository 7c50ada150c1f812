// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/animation.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

int frame_count(const Animation& animation) {
  return static_cast<int>(
      std::clamp(std::round(animation.seconds * animation.fps), 1.0, double(most_frames)));
}

}  // namespace pellucid
