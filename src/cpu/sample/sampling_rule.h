// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/render/sample_ray.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// The rule of a method that marches at a fixed step and looks up no table of integrals.
SamplingRule sampling_rule(Method method) noexcept;

}  // namespace pellucid
