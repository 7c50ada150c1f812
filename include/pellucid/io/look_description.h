// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/transfer_function_description.h"
#include "pellucid/scene/light.h"

namespace pellucid {

/// Reflection of light by a layer, as written.
struct ShadingDescription {
  Shading values;       ///< its `channel` is ignored
  std::string channel;  ///< empty: the first variable
};

/// A gradient opacity as written.
struct GradientOpacityDescription {
  std::vector<GradientOpacity::Point> points;
  GradientOpacity::Unit unit = GradientOpacity::Unit::world;
  std::string channel;  ///< empty: the first variable
};

/// An isosurface as written.
struct IsosurfaceDescription {
  double value = 0;
  double opacity = 1;
  Rgb<double> color{1, 1, 1};
  /// In place of `color`; of one variable. Its extinctions and opacities are ignored.
  std::optional<TransferFunctionDescription> colors;
  std::string channel, color_channel;  ///< empty: the first variable
};

/// A slice as written.
struct SliceDescription {
  Vec3<double> point{};
  Vec3<double> normal{0, 0, 1};
  double opacity = 1;
  /// Function of one variable. None: the layer's function, or if that is of several variables a
  /// grey ramp over the range of the data.
  std::optional<TransferFunctionDescription> colors;
  std::string channel;  ///< empty: the first variable
};

/// A transfer function with what may stand beside it in a file of its own.
struct LookDescription {
  TransferFunctionDescription transfer_function;
  std::optional<ShadingDescription> shading;
  std::optional<GradientOpacityDescription> gradient_opacity;
};

}  // namespace pellucid
