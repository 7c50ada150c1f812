// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>

#include "pellucid/scene/internal/value_noise.h"

namespace pellucid {

/// Result of Volume::noise(), once it was asked for.
class VolumeNoise {
 public:
  std::mutex building;
  std::optional<ValueNoise> found;
};

}  // namespace pellucid
