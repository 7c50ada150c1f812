// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/scene/scene.h"
#include "pixel.h"

namespace pellucid {

/// Error of the cubic through four pixels of a lattice, in the middle between the two inner ones:
/// by fourth and second differences of the pixels around, the largest of the channels, so many
/// times that it holds for a kink between any two of the six. Infinite where these are not in the
/// lattice.
class CubicErrors {
 public:
  /// Computes the errors from the pixels whose columns and rows are multiples of `stride`, a power
  /// of two.
  CubicErrors(const ImageView& image, ImageSize size, int stride, int threads);

  /// Return the error between the lattice's pixel and the next one of its row; of its column.
  float across(int column, int row) const noexcept { return across_[index(column, row)]; }
  float down(int column, int row) const noexcept { return down_[index(column, row)]; }

 private:
  /// Returns where the lattice's pixel is in the lists. `column`, `row`: of the image.
  std::size_t index(int column, int row) const noexcept {
    return static_cast<std::size_t>(row >> log2_of_stride_) * columns_ +
           static_cast<std::size_t>(column >> log2_of_stride_);
  }

  int log2_of_stride_;
  std::size_t columns_, rows_;
  std::vector<float> across_, down_;
};

}  // namespace pellucid
