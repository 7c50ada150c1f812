// SPDX-License-Identifier: Apache-2.0
//
// Rays through squares that are not marked against the box, and with those around them against its
// blocks, ray by ray.
#include "src/cpu/frame/screen_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "pellucid/scene/defaults.h"
#include "pellucid/scene/scene.h"

namespace pellucid::test_screen_mask {
namespace {

/// Through which faces a ray enters a box and leaves it: twice the axis, and 1 for the upper one;
/// -1 where it does not meet it.
struct Faces {
  int in = -1, out = -1;
  bool operator==(const Faces&) const = default;
};

Faces faces_of(const Ray<double>& ray, Vec3<double> least, Vec3<double> most) {
  Faces faces;
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const double lower = (least[a] - ray.origin[a]) / ray.direction[a],
                 upper = (most[a] - ray.origin[a]) / ray.direction[a];
    if (std::min(lower, upper) > from) {
      from = std::min(lower, upper);
      faces.in = 2 * a + (upper < lower ? 1 : 0);
    }
    if (std::max(lower, upper) < to) {
      to = std::max(lower, upper);
      faces.out = 2 * a + (upper > lower ? 1 : 0);
    }
  }
  return from < to ? faces : Faces{};
}

class ScreenMasks : public testing::Test {
 protected:
  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }

  /// A volume whose blocks are to be skipped, but for a few that are gone through cell by cell.
  void make_volume(double share_of_cells) {
    Volume::Description description;
    description.dimensions = {20 + static_cast<int>(uniform(0, 30)),
                              20 + static_cast<int>(uniform(0, 30)),
                              20 + static_cast<int>(uniform(0, 30))};
    description.placement.spacing = {1, uniform(0.5, 2), uniform(0.5, 2)};
    description.centering = uniform(0, 1) < 0.5 ? Centering::cell : Centering::point;
    std::vector<std::uint8_t> data(static_cast<std::size_t>(description.dimensions[0]) *
                                   static_cast<std::size_t>(description.dimensions[1]) *
                                   static_cast<std::size_t>(description.dimensions[2]));
    volume_ = std::make_shared<const Volume>(description, DataArray<std::uint8_t>(std::move(data)));
    records_ = volume_->block_records();
    classes_.assign(static_cast<std::size_t>(records_.count()), {0, BlockKind::skip, 0});
    for (BlockClass& one : classes_) {
      if (uniform(0, 1) < share_of_cells) one.kind = BlockKind::cells;
    }
  }

  CameraFrame<double> camera(ImageSize size) {
    Camera camera = default_camera(*volume_, size);
    const Vec3<double> middle = camera.focal_point;
    const double far = length(camera.position - middle);
    const Vec3<double> direction{uniform(-1, 1), uniform(-1, 1), uniform(0.2, 1)};
    camera.position = middle + direction * (far * uniform(0.8, 2) / length(direction));
    camera.focal_point = middle + Vec3<double>{uniform(-9, 9), uniform(-9, 9), 0};
    camera.up = {0, 1, 0.1};
    if (uniform(0, 1) < 0.5) {
      camera.projection = Projection::orthographic;
      camera.parallel_scale = uniform(5, 40);
    }
    return make_camera_frame(camera, size);
  }

  Vec3<double> plane(int i, int j, int k) const {
    return {records_.axis[0].plane(i), records_.axis[1].plane(j), records_.axis[2].plane(k)};
  }
  Ray<double> ray(const CameraFrame<double>& camera, int column, int row) const {
    const Ray<double> world = camera.ray(column, row);
    return {volume_->grid_from_world().point(world.origin),
            volume_->grid_from_world().vector(world.direction)};
  }
  Faces faces_of_box(const Ray<double>& ray) const {
    return faces_of(
        ray, plane(0, 0, 0),
        plane(records_.axis[0].cells(), records_.axis[1].cells(), records_.axis[2].cells()));
  }
  bool goes_through_cells(const Ray<double>& ray) const {
    for (int k = 0; k < records_.axis[2].cells(); ++k) {
      for (int j = 0; j < records_.axis[1].cells(); ++j) {
        for (int i = 0; i < records_.axis[0].cells(); ++i) {
          if (classes_[static_cast<std::size_t>(records_.index(i, j, k))].kind ==
                  BlockKind::cells &&
              faces_of(ray, plane(i, j, k), plane(i + 1, j + 1, k + 1)).in >= 0) {
            return true;
          }
        }
      }
    }
    return false;
  }

  std::mt19937 random_{1};
  std::shared_ptr<const Volume> volume_;
  BlockRecords records_;
  std::vector<BlockClass> classes_;
};

TEST_F(ScreenMasks, LeaveSquaresOutAroundWhichAllRaysAreAlike) {
  int clear = 0, all = 0;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    make_volume(n % 3 == 0 ? 0 : 0.01);
    const ImageSize size{60 + static_cast<int>(uniform(0, 40)),
                         60 + static_cast<int>(uniform(0, 40))};
    const CameraFrame<double> frame = camera(size);
    const int square = 1 << n % 4;
    const ScreenMask mask(frame, *volume_, {records_, {classes_.data()}}, square);
    std::vector<Faces> faces;
    std::vector<bool> in_cells;
    for (int row = 0; row < size.height; ++row) {
      for (int column = 0; column < size.width; ++column) {
        const Ray<double> one = ray(frame, column, row);
        faces.push_back(faces_of_box(one));
        in_cells.push_back(goes_through_cells(one));
      }
    }
    for (int row = 0; row < size.height; ++row) {
      for (int column = 0; column < size.width; ++column) {
        ++all;
        if (mask.marked(column, row)) continue;
        ++clear;
        const auto at = [&](int i, int j) { return static_cast<std::size_t>(j * size.width + i); };
        const int left = std::max((column / square - 1) * square, 0),
                  right = std::min((column / square + 2) * square, size.width) - 1,
                  top = std::max((row / square - 1) * square, 0),
                  bottom = std::min((row / square + 2) * square, size.height) - 1;
        for (int j = top; j <= bottom; ++j) {
          for (int i = left; i <= right; ++i) {
            ASSERT_FALSE(in_cells[at(i, j)])
                << i << ", " << j << " beside " << column << ", " << row;
            const auto is_beside = [&](int at_i, int at_column) {
              const int first = at_column / square * square;
              return at_i >= first && at_i <= first + square;
            };
            if (!is_beside(i, column) || !is_beside(j, row)) continue;
            ASSERT_EQ(faces[at(i, j)], faces[at(column, row)])
                << i << ", " << j << " with " << column << ", " << row;
          }
        }
      }
    }
  }
  EXPECT_GT(clear, all / 10);
}

TEST_F(ScreenMasks, MarkAllWhereTheEyeIsInside) {
  make_volume(0);
  Camera camera = default_camera(*volume_, {40, 40});
  camera.position = camera.focal_point + 0.1 * (camera.position - camera.focal_point);
  const ScreenMask mask(make_camera_frame(camera, {40, 40}), *volume_,
                        {records_, {classes_.data()}}, 2);
  EXPECT_EQ(mask.clear_share(), 0);
}

}  // namespace
}  // namespace pellucid::test_screen_mask
