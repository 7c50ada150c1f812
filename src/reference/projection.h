// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "layer_data.h"
#include "pellucid/reference/render.h"

namespace pellucid::reference {

/// A projected layer: its value along a ray, and the look of that value.
class Projection {
 public:
  /// Projects a layer, which is in its place and must outlive the object.
  Projection(const Layer& layer, const std::vector<Clip>& of_scene);

  /// Returns the value along a ray with a direction of length 1, up to `end`: NaN without data, but
  /// 0 for a sum. Adds the number of cells crossed to `cells`, and the length on which the data
  /// have two values to `overlap`.
  ///
  /// Extremes: samples of each chord, then golden section around the best three. Sums: Simpson's
  /// rule, adaptive. All of it in extended precision.
  Real value(const RealRay& ray, Real end, bool& has_data, std::uint64_t& cells,
             Real& overlap) const;
  /// Puts the layer over the pixel.
  void put_over(const RealRay& ray, Real end, std::uint64_t& cells, ReferencePixel& pixel) const;

 private:
  LayerProjection kind_;
  const std::vector<TransferFunction::Point>& points_;
  LayerData data_;
};

}  // namespace pellucid::reference
