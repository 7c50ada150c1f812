// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "layer_projector.h"
#include "pellucid/math/rgb.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/scene/transfer_function.h"

namespace pellucid {

/// Returns the function of a layer that check_layer() lets be projected.
const TransferFunction& function_of(const Layer& layer);

/// The look of one projected value.
struct ShownValue {
  Rgb<double> radiance{};  ///< premultiplied
  double opacity = 0;
  double color_error = 0;    ///< proved bound on the error of any channel of the radiance
  double opacity_error = 0;  ///< and of the opacity
};

/// Shows projected values: the color of the transfer function, with the opacity extinction /
/// largest extinction. So the unit of length does not matter, and a ramp of extinction is one of
/// opacity.
class ValueColors {
 public:
  /// Shows values by a function, which must outlive the object.
  explicit ValueColors(const TransferFunction& function);

  /// Returns the color of a value. Its error is the largest change of the color between the bounds
  /// of the value, jumps included.
  ShownValue show(const RayValue& value) const;

 private:
  ShownValue at(const Material<double>& material) const;

  PiecewiseLinear<double> table_;
  double largest_extinction_ = 0, largest_color_ = 0;
};

/// Puts `over` in front of `behind`. An error of the opacity costs as much of what is seen behind.
ShownValue composite(const ShownValue& over, const ShownValue& behind);
/// Puts a value over what a ray gathers of layers that are not projected. `largest_color`: of all
/// layers and of the background, at least 1.
void put_over(const ShownValue& shown, double largest_color, RayResult& ray);

}  // namespace pellucid
