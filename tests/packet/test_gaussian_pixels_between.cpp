// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "tests/packet/seen_closely.h"
#include "tests/support/one_layer.h"

namespace pellucid {
namespace {

const std::vector<double> tolerances{3e-2, 1e-2, 1.0 / 512, 7e-4, 4.2e-4};

/// Several variables behind Gaussians, through which rays go in steps.
class GaussianPixelsBetween : public SeenClosely {
 protected:
  using Volumes = std::vector<std::shared_ptr<const Volume>>;

  static RenderOptions in_steps() {
    RenderOptions options;
    options.machine.gaussian_march = GaussianMarch::steps;
    return options;
  }
  template <class Make>
  Seen compare_scenes(int count, const Make& make) {
    return compare_random_scenes(
        count, tolerances,
        [&](unsigned seed) {
          random_.seed(seed);
          return make();
        },
        Promise::within_tolerance, in_steps());
  }

  static Scene behind(Scene scene, const Volumes& volumes,
                      std::vector<GaussianPrimitive> primitives) {
    std::vector<Channel> channels;
    for (const auto& volume : volumes) {
      channels.push_back({std::to_string(channels.size()), "", volume});
    }
    test::channels_of(scene).transfer_function =
        std::make_shared<const MultivariateTransferFunction>(static_cast<int>(channels.size()),
                                                             std::move(primitives));
    test::channels_of(scene).channels = std::make_shared<const Channels>(std::move(channels));
    return scene;
  }

  Scene seen_closely(const Volumes& volumes, std::vector<GaussianPrimitive> primitives) {
    const Vec3<double> direction =
        one_of(3) ? directions[random_() % std::size(directions)] : aside();
    Scene scene = behind(make_scene(volumes.front(), line(1, 40), direction, one_of(2)), volumes,
                         std::move(primitives));
    zoom(scene, power(0.05, 1.5));
    return scene;
  }

  /// Over so many channels whose data go from 0 to 1: of a depth where the data are `cells` wide.
  GaussianPrimitive primitive(int channels, double width, double depth, double cells) {
    GaussianPrimitive p;
    std::vector<double> widths;
    for (int c = 0; c < channels; ++c) {
      p.channels.push_back(c);
      p.center.push_back(uniform(-0.1, 1.1));
      widths.push_back(width * power(0.7, 1.5));
    }
    p.matrix = matrix_from_widths(widths);
    if (channels > 1 && one_of(2)) {
      for (std::vector<double>& row : p.matrix) {
        for (std::size_t c = 0; c < row.size(); ++c) row[c] = uniform(-1, 1) / widths[c];
      }
    }
    p.extinction = depth / cells;
    p.color = {uniform(0, 1), uniform(0, 1), uniform(0, 1)};
    return p;
  }
  std::vector<GaussianPrimitive> some_primitives(int channels, double narrowest, double cells) {
    const double depth = power(1e-3, 30);
    std::vector<GaussianPrimitive> all;
    for (int n = 1 + static_cast<int>(random_() % 4); n > 0; --n) {
      all.push_back(primitive(channels, narrowest * power(1, 4), depth, cells));
    }
    return all;
  }

  /// Data that are the same all along the rays, seen along z, so that pixels show what the
  /// primitives make of them and nothing else.
  Scene seen_edge_on(const Field& field, std::vector<GaussianPrimitive> primitives) {
    const auto volume = make_volume({60, 40, 30}, field);
    Scene scene = behind(make_scene(volume, line(1, 40), {0, 0, one_of(2) ? 1.0 : -1.0}, true),
                         {volume}, std::move(primitives));
    zoom(scene, power(0.1, 1.5));
    scene.camera.focal_point.z = scene.camera.position.z > 15 ? 0 : 30;
    scene.camera.focal_point.x = scene.camera.position.x = uniform(20, 40);
    scene.camera.focal_point.y = scene.camera.position.y = uniform(15, 25);
    scene.camera.up = {0, 1, 0};
    scene.size = {64, 64};
    return scene;
  }
};

TEST_F(GaussianPixelsBetween, AreWithinWhatTheySay) {
  const Seen seen = compare_scenes(20, [&] {
    const int channels = 1 + static_cast<int>(random_() % 3);
    Volumes volumes{of_waves(3, 60)};
    const std::array<int, 3> size = volumes.front()->description().dimensions;
    const Vec3<double> spacing = volumes.front()->description().placement.spacing;
    while (static_cast<int>(volumes.size()) < channels) {
      volumes.push_back(
          make_volume(size, waves(1 + static_cast<int>(uniform(0, 3)), power(9, 60)), spacing));
    }
    return seen_closely(volumes, some_primitives(channels, power(0.05, 1), 40));
  });
  expect_many(seen, 50);
}

TEST_F(GaussianPixelsBetween, OfSheetsSeenEdgeOnAreWithinWhatTheySay) {
  // About as narrow as pixels of a level are apart, or as it takes to be missed.
  const Seen seen = compare_scenes(30, [&] {
    const double bend = one_of(2) ? 0 : uniform(0, 1), tilt = one_of(2) ? 0 : uniform(0, 0.3);
    const Field field = [=](double x, double y, double) {
      const double t = (x + tilt * y) / 60;
      return bend * t * t + (1 - bend) * t;
    };
    return seen_edge_on(field, some_primitives(1, power(0.002, 0.3), 30));
  });
  expect_many(seen, 50);
}

TEST_F(GaussianPixelsBetween, OfDataThatTurnBackInATailAreWithinWhatTheySay) {
  // They come so near to a Gaussian of great depth that its tail shows, along a line of the picture
  // or at a place.
  const Seen seen = compare_scenes(30, [&] {
    const Vec3<double> top{uniform(20, 40), uniform(15, 25), 0};
    const double curved = power(1e-4, 1e-2), across = one_of(2) ? 0 : uniform(0, 1);
    const Field field = [=](double x, double y, double) {
      const double along_x = x - top.x, along_y = y - top.y;
      return curved * (along_x * along_x + across * along_y * along_y);
    };
    GaussianPrimitive p = primitive(1, power(0.01, 1), 1, 30);
    const double away = uniform(0, 3.5), width = 1 / p.matrix[0][0];
    p.center[0] = -away * width;
    p.extinction = power(1e-3, 30) * std::exp(away * away) / 30;
    return seen_edge_on(field, {p});
  });
  expect_many(seen, 50);
}

TEST_F(GaussianPixelsBetween, BesideTheBoxesEdgesAreWithinWhatTheySay) {
  // Of what hardly shows rays leave out nearly all that they may: all alike, but for those that
  // miss the box.
  const Seen seen = compare_scenes(20, [&] {
    GaussianPrimitive p = primitive(1, power(0.2, 1), power(3e-4, 1e-2), 30);
    Scene scene = seen_edge_on([](double x, double, double) { return x / 60; }, {p});
    scene.camera.parallel_scale = uniform(23, 40);
    return scene;
  });
  expect_many(seen, 50);
}

TEST_F(GaussianPixelsBetween, AreTheSameForAnyThreadsAndTiles) {
  random_.seed(5);
  Scene scene = seen_closely({make_volume({40, 36, 40}, waves(2, 30))}, {primitive(1, 0.5, 2, 40)});
  zoom(scene, 0.3);
  scene.size = {150, 83};
  scene.integration.tolerance = 1e-2;
  RenderOptions options;
  options.outputs.error = true;
  options.machine.threads = 1;
  const auto [whole, report] = render(scene, options);
  EXPECT_GT(report.pixels_interpolated, report.pixels / 4);
  EXPECT_LE(report.largest_error, 1e-2);
  options.machine.threads = 3;
  options.monitor.preview = 2;
  const Image other = render(scene, options).image;
  EXPECT_EQ(whole.pixels, other.pixels);
  EXPECT_EQ(whole.error, other.error);
}

TEST_F(GaussianPixelsBetween, AreNoneWhereTheyAreNotWanted) {
  random_.seed(5);
  const Field field = waves(2, 30);
  const GaussianPrimitive one = primitive(1, 0.5, 2, 40);
  Scene scene = seen_closely({make_volume({40, 36, 40}, field)}, {one});
  zoom(scene, 0.3);
  RenderOptions options = in_steps();
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
  const auto hole = make_volume({40, 36, 40}, [&](double x, double y, double z) {
    return x + y + z > 0 ? field(x, y, z) : std::numeric_limits<double>::quiet_NaN();
  });
  EXPECT_EQ(between(behind(scene, {hole}, {one})), 0u);
  options.outputs.depth = true;
  EXPECT_EQ(between(scene), 0u);
  options.outputs.depth = false;
  options.machine.gaussian_march = GaussianMarch::cells;
  EXPECT_EQ(between(scene), 0u);
}

}  // namespace
}  // namespace pellucid
