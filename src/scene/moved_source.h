// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "pellucid/geometry/affine.h"
#include "pellucid/scene/stretch_source.h"

namespace pellucid {

/// Returns the field that has at to.point(p) what `source` has at p. Lengths of gradients need a
/// map that keeps_angles().
std::shared_ptr<const StretchSource> moved_source(std::shared_ptr<const StretchSource> source,
                                                  const Affine<double>& to);

/// Returns whether a map changes all lengths by one factor.
bool keeps_angles(const Mat3<double>& matrix) noexcept;

}  // namespace pellucid
