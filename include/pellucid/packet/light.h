// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/shading.h"
#include "pellucid/transfer/binned.h"

namespace pellucid {

/// The light of one variable on a grid, and its gradient opacity, as packets see them. Plain
/// numbers, the same for every instruction set.
struct PacketLight {
  static constexpr int max_lights = 8;

  Reflection<float> reflection;
  LightSource<float> light[max_lights];  ///< positions from the middle of the grid
  int lights = 0;
  int points = 0;      ///< of these, point lights
  float farthest = 0;  ///< of the grid or a light from that middle, world length
  int of_field = 0;    ///< 1: the gradient of the field itself, else `smooth`
  /// Factors of the extinction by the magnitude of the `smooth` gradient, as extinctions; null: 1.
  const BinnedTransfer* factor = nullptr;
  float largest_factor = 1;
  float world_gradient[3][3]{};    ///< [c][a]: world component c by grid component a
  double world_direction[3][3]{};  ///< the same for directions
  double world_origin[3]{};        ///< the grid's coordinates 0, from its middle in the world
};

}  // namespace pellucid
