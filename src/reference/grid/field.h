// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "chord.h"

namespace pellucid::reference {

/// A stretch of a ray on which every channel of the data is one polynomial.
struct Stretch {
  Real t_begin, t_end;        ///< world arc length
  std::vector<Chord> chords;  ///< one for each channel, then DerivedChannels; none: vacuum
};

/// Data along rays.
class Field {
 public:
  /// Receiver of stretches; returns whether more are wanted.
  using Visit = std::function<bool(const Stretch&)>;

  Field() = default;
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  virtual ~Field() = default;

  /// Visits the stretches of a ray (direction of length 1) at t >= 0, front to back. Returns the
  /// length of the ray on which the data have two values at once: of a mesh that overlaps itself.
  virtual Real visit(const RealRay& ray, const Visit& visit) const = 0;
};

}  // namespace pellucid::reference
