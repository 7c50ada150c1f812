// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/scene/layer.h"
#include "tests/scenes/makers.h"

namespace pellucid::bench {

/// A volume and how it is shown.
struct Subject {
  std::string name;
  scenes::VolumePointer volume;
  scenes::TransferPointer function;
  double surface;  ///< value of an isosurface
};

inline Layer in_light(Layer layer, GradientKind gradient) {
  layer.shading = Shading{};
  layer.shading->gradient = gradient;
  return layer;
}

/// An opaque isosurface without a medium, unlit.
inline Layer surface_of(const Subject& subject) {
  Layer layer{VolumeContent{subject.volume, scenes::transfer({{0, 0, {0, 0, 0}}}), nullptr}};
  layer.isosurfaces = {{subject.surface, 1, {0.9, 0.8, 0.7}}};
  return layer;
}

}  // namespace pellucid::bench
