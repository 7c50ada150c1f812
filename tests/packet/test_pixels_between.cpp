// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "tests/packet/against_one_by_one.h"
#include "tests/packet/seen_closely.h"

namespace pellucid {
namespace {

class PixelsBetween : public SeenClosely {
 protected:
  Scene smooth_scene() {
    const auto volume = of_waves(4, 40);
    const double depth = power(0.1, 10);
    return seen_closely(volume, one_of(2) ? line(depth, 40) : table(depth, 40));
  }

  /// One of which most pixels lie between others; as many levels fit as previews have here.
  Scene mostly_between() {
    random_.seed(5);
    Scene scene =
        make_scene(make_volume({40, 36, 40}, waves(2, 20)), line(2, 40), {0.6, 0.5, -0.4}, true);
    zoom(scene, 0.2);
    scene.size = {208, 208};
    return scene;
  }
};

const std::vector<double> tolerances{3e-2, 1e-2, 1.0 / 512, 7e-4, 4.2e-4};

TEST_F(PixelsBetween, AreWithinWhatTheySay) {
  const Seen seen = compare_random_scenes(30, tolerances, [&](unsigned seed) {
    random_.seed(seed);
    return smooth_scene();
  });
  expect_many(seen, 100);
}

TEST_F(PixelsBetween, OfQuadraticsAreWithinWhatTheySay) {
  // What trilinear data are off by has one sign everywhere.
  const Seen seen = compare_random_scenes(30, tolerances, [&](unsigned seed) {
    random_.seed(seed);
    const std::array<int, 3> size = values();
    const auto share = [&] { return one_of(3) ? 0 : uniform(-1, 1); };
    const Vec3<double> k{share(), share(), share()};
    const auto volume = make_volume(size, [=](double x, double y, double z) {
      x = 2 * x / size[0] - 1;
      y = 2 * y / size[1] - 1;
      z = 2 * z / size[2] - 1;
      return 0.5 + 0.3 * (k.x * x * x + k.y * y * y + k.z * z * z);
    });
    return seen_closely(volume, line(power(0.3, 10), size[0]));
  });
  expect_many(seen, 100);
}

TEST_F(PixelsBetween, BehindCornersAreWithinWhatTheySay) {
  // Tops of waves that rise above where it begins to absorb lie between pixels.
  const Seen seen = compare_random_scenes(40, tolerances, [&](unsigned seed) {
    random_.seed(seed);
    const auto volume = of_waves(3, 200);
    return seen_closely(volume, corners(power(0.1, 10), volume->description().dimensions[0]));
  });
  expect_many(seen, 100);
}

TEST_F(PixelsBetween, OfCornersSeenEdgeOnAreWithinWhatTheySay) {
  // All along a ray the data are at a corner of the transfer function, so that pixels have a kink;
  // on a background that bends, in one channel or in all of them.
  const Seen seen = compare_random_scenes(60, tolerances, [&](unsigned seed) {
    random_.seed(seed);
    const double bend = uniform(0, 1), tilt = one_of(2) ? 0 : uniform(0, 0.3);
    const auto volume = make_volume({60, 40, 30}, [=](double x, double y, double) {
      const double t = (x + tilt * y) / 60;
      return bend * t * t + (1 - bend) * t;
    });
    const double corner = uniform(0.2, 0.8), e = power(0.1, 10) / 30;
    const auto color = [&] { return Rgb<double>{uniform(0, 1), uniform(0, 1), uniform(0, 1)}; };
    const bool of_color = one_of(2);
    Points points{{-0.5, of_color ? e : e * uniform(0, 2), color()},
                  {corner, e, color()},
                  {1.8, of_color ? e : e * uniform(0, 2), color()}};
    Scene scene = make_scene(volume, std::move(points), {0, 0, one_of(2) ? 1.0 : -1.0}, true);
    zoom(scene, power(0.1, 1.5));
    scene.camera.focal_point.z = scene.camera.position.z > 15 ? 0 : 30;
    scene.camera.focal_point.x = scene.camera.position.x = uniform(20, 40);
    scene.camera.focal_point.y = scene.camera.position.y = uniform(15, 25);
    scene.camera.up = {0, 1, 0};
    scene.size = {64, 64};
    return scene;
  });
  expect_many(seen, 100);
}

TEST_F(PixelsBetween, OfFacesSeenAtAGrazingAngleAreWithinWhatTheySay) {
  // From pixel to pixel rays meet such a face so far apart that waves of the data pass on it within
  // about as many pixels as those of a level are apart.
  const Seen seen = compare_random_scenes(40, tolerances, [&](unsigned seed) {
    random_.seed(seed);
    const double wave = uniform(12, 20), phase = uniform(0, 6), along_x = uniform(-0.1, 0.1);
    const auto volume = make_volume({50, 50, 90}, [=](double x, double, double z) {
      return 0.5 + 0.5 * std::sin(2 * std::numbers::pi / wave * (z + along_x * x) + phase);
    });
    const double pixel = uniform(0.3, 0.9), apart = one_of(2) ? 2 : 4;
    const double slope = apart * pixel / wave * uniform(0.9, 1.1);
    const double depth = power(0.3, 10) / (90 * slope);
    Points points = one_of(2) ? line(depth, 40)
                              : Points{{0.3, 0, {1, 0.5, 0.2}}, {1.1, depth / 20, {0.2, 0.5, 1}}};
    Scene scene = make_scene(volume, std::move(points), {0, slope, 1}, true);
    // To the middle of the face.
    const Vec3<double> aside = Vec3<double>{25, 50, 45} - scene.camera.focal_point;
    scene.camera.position = scene.camera.position + aside;
    scene.camera.focal_point = scene.camera.focal_point + aside;
    scene.camera.up = {0, 1, 0};
    scene.size = {64, 64};
    scene.camera.parallel_scale = 0.5 * pixel * 64;
    return scene;
  });
  EXPECT_LE(seen.over, 0u);
}

TEST_F(PixelsBetween, OfRaysThatBeginInTheVolumeAreWithinWhatTheySay) {
  const Seen seen = compare_random_scenes(10, tolerances, [&](unsigned seed) {
    random_.seed(seed);
    Scene scene = smooth_scene();
    const Vec3<double> middle = scene.camera.focal_point;
    scene.camera.position = middle + (scene.camera.position - middle) * uniform(0, 0.3);
    return scene;
  });
  EXPECT_LE(seen.over, 0u);
}

TEST_F(PixelsBetween, BesideThinLayersAndHolesAreWithinWhatTheySay) {
  // Blocks that are gone through cell by cell, a few of them, among smooth ones.
  const Seen seen = compare_random_scenes(30, tolerances, [&](unsigned seed) {
    random_.seed(seed);
    const std::array<int, 3> size = values();
    const Field field = waves(1 + static_cast<int>(uniform(0, 3)), power(15, 200));
    const Vec3<double> odd{uniform(0, size[0]), uniform(0, size[1]), uniform(0, size[2])};
    const bool hole = one_of(3);
    const double radius = uniform(0.5, 3), more = uniform(0.1, 2);
    const auto volume = make_volume(size, [=](double x, double y, double z) {
      const bool inside = length(Vec3<double>{x, y, z} - odd) < radius;
      if (inside && hole) return std::numeric_limits<double>::quiet_NaN();
      return field(x, y, z) + (inside ? more : 0);
    });
    Points points = line(power(0.1, 10), size[0]);
    points.push_back({1.15, power(0.01, 10), {0.3, 1, 0.4}});
    points.push_back({4, power(0.01, 10), {1, 1, 0.4}});
    Scene scene = make_scene(volume, std::move(points), aside(), one_of(2));
    zoom(scene, power(0.05, 1.5));
    return scene;
  });
  expect_many(seen, 20);
}

TEST_F(PixelsBetween, AreTheSameForAnyThreadsAndTiles) {
  random_.seed(5);
  const auto volume = make_volume({40, 36, 40}, waves(2, 20), {1, 0.8, 1.3});
  Scene scene = make_scene(volume, table(2, 40), {0.6, 0.5, -0.4}, false);
  zoom(scene, 0.4);
  scene.size = {150, 83};
  scene.integration.tolerance = 1e-2;
  for (const int samples : {1, 2}) {
    scene.samples = samples;
    RenderOptions options;
    options.outputs.error = true;
    options.machine.threads = 1;
    const auto [whole, report] = render(scene, options);
    const std::uint64_t rays_of_pixel = static_cast<std::uint64_t>(samples * samples);
    EXPECT_GT(report.pixels_interpolated, report.pixels / 4);
    EXPECT_EQ(report.rays, (report.pixels - report.pixels_interpolated) * rays_of_pixel);
    EXPECT_LE(report.largest_error, 1e-2);
    options.machine.threads = 3;
    for (const int preview : {0, 1, 2, 3, 5}) {
      options.monitor.preview = preview;
      std::uint64_t of_tiles = 0;
      double share = 0;
      options.monitor.tile = [&](const TileResult& result) {
        const Tile& tile = result.tile;
        for (int j = 0; j < tile.rows; ++j) {
          for (int i = 0; i < tile.columns; ++i) {
            const int column = tile.column + i * tile.stride, row = tile.row + j * tile.stride;
            EXPECT_EQ(result.image.at(column, row), whole.at(column, row));
            ++of_tiles;
          }
        }
        return true;
      };
      options.monitor.progress = [&](double now) {
        EXPECT_GT(now, share);
        share = now;
        return true;
      };
      const Image other = render(scene, options).image;
      EXPECT_EQ(whole.pixels, other.pixels);
      EXPECT_EQ(whole.error, other.error);
      EXPECT_EQ(of_tiles, report.pixels);
      EXPECT_EQ(share, 1);
    }
  }
}

TEST_F(PixelsBetween, AreNoneWhereTheyAreNotWanted) {
  random_.seed(5);
  const Field field = waves(2, 20);
  Scene scene = make_scene(make_volume({40, 36, 40}, field), line(2, 40), {0.6, 0.5, -0.4}, true);
  zoom(scene, 0.4);
  RenderOptions options;
  const auto between = [&](const Scene& of) {
    RenderReport report;
    report = render(of, options).report;
    EXPECT_EQ(report.rays + report.pixels_interpolated, report.pixels);
    return report.pixels_interpolated;
  };
  EXPECT_GT(between(scene), 0u);
  Scene proved = scene;
  proved.integration.grade = Grade::proved;
  EXPECT_EQ(between(proved), 0u);
  Scene far = scene;
  far.camera.parallel_scale *= 10;  // many voxels from pixel to pixel
  EXPECT_EQ(between(far), 0u);
  Scene hole = scene;
  test::volume_of(hole).volume = make_volume({40, 36, 40}, [&](double x, double y, double z) {
    return x + y + z > 0 ? field(x, y, z) : std::numeric_limits<double>::quiet_NaN();
  });
  EXPECT_EQ(between(hole), 0u);
  options.outputs.depth = true;
  EXPECT_EQ(between(scene), 0u);
}

TEST_F(PixelsBetween, AreToldOfAsTheyAreDone) {
  const Scene scene = mostly_between();
  RenderOptions options;
  options.machine.threads = 1;
  std::vector<double> shares;
  options.monitor.progress = [&](double share) {
    shares.push_back(share);
    return true;
  };
  RenderReport report;
  report = render(scene, options).report;
  ASSERT_GT(report.pixels_interpolated, report.pixels / 2);
  // Most of the work is in the pixels that others are taken from.
  const auto traced = static_cast<double>(report.rays) / static_cast<double>(report.pixels);
  const auto before = std::ranges::count_if(shares, [&](double share) { return share < traced; });
  EXPECT_GT(before, 5);
  EXPECT_LT(shares.front(), 0.1);
  EXPECT_EQ(shares.back(), 1);

  // Those that a preview shows first are among them.
  for (const int preview : {1, 2, 4}) {
    options.monitor.preview = preview;
    double share = 0;
    options.monitor.progress = [&](double now) {
      share = now;
      return true;
    };
    options.monitor.tile = [&](const TileResult& result) {
      if (result.tile.level == preview) {
        EXPECT_LE(share, std::pow(0.25, preview));
      }
      return true;
    };
    render(scene, options);
  }
}

TEST_F(PixelsBetween, CanBeCancelled) {
  const Scene scene = mostly_between();
  RenderOptions options;
  options.machine.threads = 2;
  int calls = 0;
  options.monitor.progress = [&](double share) {
    EXPECT_LT(share, 0.25) << "while the first levels are rendered";
    return ++calls < 3;
  };
  EXPECT_THROW(render(scene, options), Cancelled);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace pellucid
