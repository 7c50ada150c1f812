// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pellucid/render/camera.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// Returns the largest depth of the volume from the eye, along the camera's axis; 1 for parallel
/// rays.
double farthest_depth(const CameraFrame<double>& camera, const Volume& volume,
                      const BlockRecords& records) noexcept;

/// Mask of the squares of the screen in which rays may differ from those beside them: where one
/// goes through a block that is gone through cell by cell, or past an edge of the volume's box. In
/// squares of pixels: rays through one that is not marked, and through the first pixels of the next
/// ones, enter the box by one face and leave it by one, and with those through the squares around
/// have all between them in blocks that are smooth, of one material, or empty. An edge of the box
/// is a kink of the picture, or a step, as CubicErrors hold for.
class ScreenMask {
 public:
  /// Marks the squares. `square`: pixels, a power of two. `box`: the corners of the only part of
  /// the volume that is shown, a box as well; null: all of it is.
  ScreenMask(const CameraFrame<double>& camera, const Volume& volume,
             const ClassifiedBlocks& blocks, int square,
             const std::array<Vec3<double>, 8>* box = nullptr);

  bool marked(int column, int row) const noexcept {
    return marked_[index(column >> log2_of_square_, row >> log2_of_square_)] != 0;
  }
  /// Returns the share of the squares that are not marked.
  double clear_share() const noexcept;

 private:
  void mark(double x0, double y0, double x1, double y1, int around) noexcept;
  void mark_edges(const CameraFrame<double>& camera,
                  const std::array<Vec3<double>, 8>& corner) noexcept;
  void mark_blocks(const CameraFrame<double>& camera, const Volume& volume,
                   const ClassifiedBlocks& blocks) noexcept;
  std::size_t index(int x, int y) const noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }

  int square_, log2_of_square_, columns_, rows_;
  std::vector<std::uint8_t> marked_;
};

}  // namespace pellucid
