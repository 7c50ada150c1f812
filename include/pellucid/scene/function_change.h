// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pellucid/scene/color_map.h"
#include "pellucid/scene/mesh_channels.h"
#include "pellucid/scene/opacity_table.h"
#include "pellucid/scene/surfaces.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// One end of a range of data: a value, or the percentage of the data's values that are below it.
struct RangeEnd {
  double number = 0;
  bool is_percent = false;

  bool operator==(const RangeEnd&) const = default;
};
using RangeEnds = std::array<RangeEnd, 2>;

/// Returns the values of a range, of up to 2^18 of the data's finite values. 0 % is the least of
/// them but for the outermost 0.1 %, and so is 100 % at the other end. Throws Error if the ends do
/// not ascend, if percentages are not from 0 to 100, or data of one value have none.
std::array<double, 2> value_range(const RangeEnds& range, const Volume& volume);
/// Returns the same for a mesh's first channel, with values weighted by the volume that they fill.
std::array<double, 2> value_range(const RangeEnds& range, const MeshChannels& mesh);

/// Changes of a function that are made once its data are known.
struct FunctionChange {
  ColorMap colors;                 ///< in place of the function's; empty: they stay
  std::optional<RangeEnds> range;  ///< to where its first and last points move
  double opacity = 1;              ///< a factor of the extinctions, >= 0

  bool is_none() const noexcept { return colors.empty() && !range && opacity == 1; }
};

/// Returns the value_range() of a change's range; none: it has none. Throws Error as that does.
std::optional<std::array<double, 2>> range_of(const FunctionChange& change, const Volume& volume);
std::optional<std::array<double, 2>> range_of(const FunctionChange& change,
                                              const MeshChannels& mesh);

/// Returns the changed function: moved_to_range(), then with_colors() over the range, or without
/// one over absorbing_range(), then with_opacity(). `range`: range_of() the change, whose
/// own is ignored. Throws Error as they do.
TransferFunction changed(const TransferFunction& function, const FunctionChange& change,
                         const std::optional<std::array<double, 2>>& range);
TransferFunction changed(const TransferFunction& function, const FunctionChange& change,
                         const Volume& volume);
TransferFunction changed(const TransferFunction& function, const FunctionChange& change,
                         const MeshChannels& mesh);
/// Changes the points of an opacity table likewise, but for its opacity, which is a matter of its
/// unit distance.
std::vector<OpacityPoint> changed(const std::vector<OpacityPoint>& points,
                                  const FunctionChange& change,
                                  const std::optional<std::array<double, 2>>& range);

/// Changes surfaces likewise: a range has them lie within it, the outermost at a tenth of it from
/// its ends; their colors are those of the map at these places, or between the first and the last
/// of them; and opacities are times the factor, or if it is above 1 transparencies to its power.
std::vector<Isosurface> changed(std::vector<Isosurface> surfaces, const FunctionChange& change,
                                const std::optional<std::array<double, 2>>& range);

}  // namespace pellucid
