// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/scene.h"

namespace pellucid {

/// Returns the scene by the method `midpoint`, at steps of a voxel: for pictures while something
/// moves, of unknown error.
Scene sampled_scene(Scene scene);

/// Chooses which pictures that have to be there in time are sampled: the exact method may take as
/// long or less, and an exact picture in time is better than a sampled one. Learns from the
/// pictures of a program.
class MovingPictures {
 public:
  /// Notes how long pixels of a picture took, side by side or apart.
  void note(bool sampled, double seconds, double pixels) noexcept;
  /// Returns whether pictures of so many pixels are better sampled, if they have so many seconds.
  /// Both kinds are tried before one is preferred, the sampled one first.
  bool are_sampled(double pixels, double seconds) const noexcept;

 private:
  double exact_ = 0, sampled_ = 0;  ///< seconds per pixel; 0: not known
};

}  // namespace pellucid
