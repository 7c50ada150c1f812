// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/classical.h"
#include "pellucid/segment/linear.h"
#include "pellucid/segment/partial_preintegration.h"
#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// How a cell renderer treats the part of a ray inside one cell, for comparison with the integral.
/// The data are linear there, but the transfer function is sampled at one or two positions only:
/// control points and Gaussians between them are missed. docs/explanation/theory.md names the
/// sources.
enum class CellModel {
  homogeneous,  ///< the material at the mean of the data
  average,      ///< the mean of extinction and color at both ends
  linear,       ///< extinction and color linear between the ends: Moreland's integral
  partial       ///< the same by a table: partial_segment()
};

namespace detail {

template <class T>
PELLUCID_HD Material<T> material_of(const PiecewiseLinear<T>& transfer, const T* values) noexcept {
  return transfer.evaluate(values[0]);
}
template <class T>
PELLUCID_HD Material<T> material_of(const MultivariateTransfer<T>& transfer,
                                    const T* values) noexcept {
  return transfer.evaluate(values);
}

}  // namespace detail

/// Returns the segment by a model, from the values of `channels` variables at its front and back.
/// Over smooth data and a smooth function all models are of second order in the cell size; asserted
/// in tests/cpu. `psi` is used by the model partial only.
template <class T, class Transfer>
PELLUCID_HD SegmentResult<T> cell_segment(CellModel model, const PsiTable& psi,
                                          const Transfer& transfer, int channels, const T* front,
                                          const T* back, T length) noexcept {
  if (model == CellModel::homogeneous) {
    T middle[max_channels];
    for (int c = 0; c < channels; ++c) middle[c] = T(0.5) * front[c] + T(0.5) * back[c];
    return midpoint_segment(detail::material_of(transfer, middle), length);
  }
  const Material<T> f = detail::material_of(transfer, front),
                    b = detail::material_of(transfer, back);
  if (model == CellModel::average) return average_segment(f, b, length);
  if (model == CellModel::partial) return partial_segment(psi, f, b, length);
  return linear_segment(f.extinction, b.extinction, f.color, b.color, length);
}

}  // namespace pellucid
