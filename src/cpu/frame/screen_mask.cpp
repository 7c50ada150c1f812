// SPDX-License-Identifier: Apache-2.0
#include "screen_mask.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "pellucid/scene/internal/box_corners.h"

namespace pellucid {
namespace {

Vec3<double> plane(const BlockRecords& records, int i, int j, int k) {
  return {records.axis[0].plane(i), records.axis[1].plane(j), records.axis[2].plane(k)};
}

double depth_of(const CameraFrame<double>& camera, Vec3<double> world) noexcept {
  return camera.perspective ? dot(world - camera.position, camera.forward) : 1;
}

/// Returns the corners of the grid's box, in the world.
std::array<Vec3<double>, 8> corners_of(const Volume& volume, const BlockRecords& records) {
  const Vec3<double> least = plane(records, 0, 0, 0),
                     most = plane(records, records.axis[0].cells(), records.axis[1].cells(),
                                  records.axis[2].cells());
  return box_corners({least, most}, volume.world_from_grid());
}

/// A place on the screen in squares, and how many of them a world length is there at most.
struct Projected {
  double x, y, scale;
};

Projected project(const CameraFrame<double>& camera, int square, Vec3<double> world) noexcept {
  const Vec3<double> to = world - camera.position;
  const double share = 1 / depth_of(camera, world);
  const double right = dot(camera.right, camera.right), up = dot(camera.up, camera.up);
  const double x = dot(to, camera.right) / right * share, y = dot(to, camera.up) / up * share;
  const double width = camera.width / (2.0 * square), height = camera.height / (2.0 * square);
  return {(x + 1) * width, (1 - y) * height,
          share * std::max(width / std::sqrt(right), height / std::sqrt(up))};
}

}  // namespace

double farthest_depth(const CameraFrame<double>& camera, const Volume& volume,
                      const BlockRecords& records) noexcept {
  double farthest = 0;
  for (const Vec3<double>& corner : corners_of(volume, records)) {
    farthest = std::max(farthest, depth_of(camera, corner));
  }
  return farthest;
}

ScreenMask::ScreenMask(const CameraFrame<double>& camera, const Volume& volume,
                       const ClassifiedBlocks& blocks, int square,
                       const std::array<Vec3<double>, 8>* box)
    : square_(square),
      log2_of_square_(std::countr_zero(static_cast<unsigned>(square))),
      columns_((camera.width + square - 1) / square),
      rows_((camera.height + square - 1) / square),
      marked_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {
  const std::array<Vec3<double>, 8> corner =
      box != nullptr ? *box : corners_of(volume, blocks.records);
  const double farthest = farthest_depth(camera, volume, blocks.records);
  for (const Vec3<double>& c : corner) {
    // From inside, or nearly so, there is no saying what is beside what.
    const bool ahead = camera.perspective
                           ? depth_of(camera, c) > 1e-3 * farthest
                           : dot(c - camera.position, camera.forward) > 0;  // of where rays begin
    if (ahead) continue;
    std::fill(marked_.begin(), marked_.end(), std::uint8_t{1});
    return;
  }
  mark_edges(camera, corner);
  mark_blocks(camera, volume, blocks);
}

double ScreenMask::clear_share() const noexcept {
  const auto clear = std::count(marked_.begin(), marked_.end(), std::uint8_t{0});
  return static_cast<double>(clear) / static_cast<double>(std::max(marked_.size(), std::size_t{1}));
}

void ScreenMask::mark(double x0, double y0, double x1, double y1, int around) noexcept {
  const auto within = [](double place, int count) {
    return static_cast<int>(std::clamp(std::floor(place), -1.0, static_cast<double>(count)));
  };
  const int left = std::max(within(x0, columns_) - around, 0),
            right = std::min(within(x1, columns_) + around, columns_ - 1),
            top = std::max(within(y0, rows_) - around, 0),
            bottom = std::min(within(y1, rows_) + around, rows_ - 1);
  for (int y = top; y <= bottom; ++y) {
    if (right >= left) {
      std::fill_n(marked_.data() + index(left, y), right - left + 1, std::uint8_t{1});
    }
  }
}

void ScreenMask::mark_edges(const CameraFrame<double>& camera,
                            const std::array<Vec3<double>, 8>& corner) noexcept {
  for (std::size_t n = 0; n < 8; ++n) {
    for (std::size_t bit = 1; bit < 8; bit *= 2) {
      if ((n & bit) != 0) continue;
      const Projected from = project(camera, square_, corner[n]),
                      to = project(camera, square_, corner[n + bit]);
      const double parts = std::ceil(8 * std::hypot(to.x - from.x, to.y - from.y));
      // What is far outside of the image is not gone along.
      if (!(parts <= 64.0 * (columns_ + rows_))) {
        std::fill(marked_.begin(), marked_.end(), std::uint8_t{1});
        return;
      }
      for (double i = 0; i <= parts; ++i) {
        const double t = parts > 0 ? i / parts : 0;
        const double x = from.x + t * (to.x - from.x), y = from.y + t * (to.y - from.y);
        // No place of the edge is further from all of these: it may just touch a square. And what
        // is interpolated in a square lies between its first pixel and the next square's.
        constexpr double near = 1.0 / 16;
        const double pixel = 1.0 / square_;
        mark(x - near - pixel, y - near - pixel, x + near, y + near, 0);
      }
    }
  }
}

void ScreenMask::mark_blocks(const CameraFrame<double>& camera, const Volume& volume,
                             const ClassifiedBlocks& blocks) noexcept {
  const BlockRecords& records = blocks.records;
  const Affine<double>& world = volume.world_from_grid();
  const Vec3<double> first = plane(records, 0, 0, 0), second = plane(records, 1, 1, 1),
                     width = (second - first) *
                             (8.0 / 7.5);  // of blocks at the border half a cell less
  double radius = 0;
  for (int n = 0; n < 4; ++n) {
    const Vec3<double> half =
        world.vector({0.5 * width.x, (n & 1) != 0 ? -0.5 * width.y : 0.5 * width.y,
                      (n & 2) != 0 ? -0.5 * width.z : 0.5 * width.z});
    radius = std::max(radius, std::sqrt(dot(half, half)));
  }
  const double corner = dot(camera.right, camera.right) + dot(camera.up, camera.up);
  const double longer = camera.perspective ? std::max(2.0, std::sqrt(1 + corner)) : 1;
  for (int k = 0; k < records.axis[2].cells(); ++k) {
    for (int j = 0; j < records.axis[1].cells(); ++j) {
      for (int i = 0; i < records.axis[0].cells(); ++i) {
        if (blocks.classes[records.index(i, j, k)].kind != BlockKind::cells) continue;
        const Vec3<double> middle =
            world.point((plane(records, i, j, k) + plane(records, i + 1, j + 1, k + 1)) * 0.5);
        // Aside of the camera's axis a ball looks longer.
        const Projected p = project(camera, square_, middle);
        const double aside = longer * radius * p.scale;
        mark(p.x - aside, p.y - aside, p.x + aside, p.y + aside, 2);
      }
    }
  }
}

}  // namespace pellucid
