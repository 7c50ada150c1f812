// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>

#include "pellucid/scene/value_noise.h"

namespace pellucid {

/// What Volume::noise() returns, once somebody asked.
class VolumeNoise {
 public:
  std::mutex building;
  std::optional<ValueNoise> found;
};

}  // namespace pellucid
