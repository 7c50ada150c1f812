// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "pellucid/geometry/vec3.h"
#include "pellucid/math/rgb.h"
#include "pellucid/scene/opacity_table.h"
#include "pellucid/scene/transfer_function.h"

namespace pellucid {

/// Surface on which the reconstructed data of a layer have one value. Rays are cut there, and the
/// surface is put over what is behind it. Lit as the layer's shading says.
struct Isosurface {
  double value = 0;
  double opacity = 1;  ///< in [0, 1]
  Rgb<double> color{1, 1, 1};
  /// Gives the color by a variable of the layer in place of `color`; may be null.
  std::shared_ptr<const TransferFunction> colors{};
  ChannelRef channel{};        ///< variable that has the value, of several
  ChannelRef color_channel{};  ///< and the one that `colors` sees
  /// A preset or an opacity table of a file; make_scene() makes `colors` of it. May be null.
  std::shared_ptr<const TransferFunctionDescription> written_colors{};

  bool operator==(const Isosurface&) const = default;
};

/// A plane that shows the data of a layer in colors, put over what is behind it. Unlit. It is
/// absent where the layer is: outside of the data, in vacuum, and where clips cut it away.
struct Slice {
  Vec3<double> point{};          ///< in the scene's world
  Vec3<double> normal{0, 0, 1};  ///< any length but 0
  double opacity = 1;            ///< in [0, 1]
  /// The color of each value; null: that of the layer's function of one variable.
  std::shared_ptr<const TransferFunction> colors{};
  ChannelRef channel{};  ///< variable that is shown, of several
  /// A preset or an opacity table of a file; make_scene() makes `colors` of it. May be null.
  std::shared_ptr<const TransferFunctionDescription> written_colors{};

  bool operator==(const Slice&) const = default;
};

}  // namespace pellucid
