// SPDX-License-Identifier: Apache-2.0
//
// The methods for comparison against the exact one, over layers of all kinds: each tends to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <string>

#include "pellucid/scene/error.h"
#include "tests/packet/random_layers.h"

namespace pellucid {
namespace {

constexpr Method methods[] = {Method::rectangle, Method::taylor,        Method::midpoint,
                              Method::trapezoid, Method::simpson,       Method::linear,
                              Method::kniss,     Method::preintegrated, Method::gaussian};

bool is_accepted(const Scene& scene) {
  try {
    check_method(scene);
  } catch (const Error&) {
    return false;
  }
  return true;
}

/// Mean square difference of all channels.
double square_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double off = static_cast<double>(a.pixels[i][c]) - static_cast<double>(b.pixels[i][c]);
      EXPECT_TRUE(std::isfinite(off)) << "pixel " << i;
      sum += off * off;
    }
  }
  return sum / (4.0 * static_cast<double>(a.pixels.size()));
}

TEST(SampledFrames, TendToTheExactOne) {
  struct Sums {
    int scenes = 0;
    double coarse = 0, fine = 0;
  };
  std::map<Method, Sums> sums;
  for (unsigned n = 1; n <= 40; ++n) {
    Scene scene = RandomLayers(n).scene();
    scene.integration.tolerance = 1e-5;
    const Image exact = render(scene).image;
    for (const Method method : methods) {
      SCOPED_TRACE(testing::Message() << "scene " << n << ", " << method_name(method));
      scene.integration.method = method;
      if (is_accepted(scene) && !takes_cells(scene)) {
        Sums& of = sums[method];
        ++of.scenes;
        scene.integration.step = 0.4;
        of.coarse += square_difference(render(scene).image, exact);
        scene.integration.step = 0.05;
        of.fine += square_difference(render(scene).image, exact);
      }
      scene.integration.method = Method::exact;
    }
  }
  for (const auto& [method, of] : sums) {
    const double coarse = std::sqrt(of.coarse / of.scenes), fine = std::sqrt(of.fine / of.scenes);
    std::printf("%s %d scenes: RMS %.2e at 0.4 voxels, %.2e at 0.05\n",
                std::string(method_name(method)).c_str(), of.scenes, coarse, fine);
    EXPECT_GE(of.scenes, 4) << method_name(method);
    EXPECT_LT(fine, 0.3 * coarse) << method_name(method);
    EXPECT_LT(fine, 3e-3) << method_name(method);
  }
  EXPECT_EQ(sums.size(), std::size(methods));
}

/// Steps are those of the finest layer that is there: rays end, however fine another one is.
TEST(SampledFrames, EndBesideAMuchFinerLayer) {
  const auto layer = [](double size) {
    const auto volume = scenes::make_volume<float>(
        scenes::grid_description({5, 5, 5}, {-size, -size, -size},
                                 {0.5 * size, 0.5 * size, 0.5 * size}),
        [](int i, int j, int k) { return 0.1F * static_cast<float>(i + j + k); });
    return Layer{VolumeContent{volume, scenes::transfer({{0, 0.5, {1, 0.5, 0}}}), nullptr}};
  };
  Scene scene;
  scene.layers = {layer(1)};
  scene.camera.position = {0.3, 0.2, 5};
  scene.camera.focal_point = {0, 0, 0};
  scene.camera.vertical_angle = 30;
  scene.size = {6, 6};
  scene.integration.method = Method::midpoint;
  const Image alone = render(scene).image;
  for (const double size : {1e-3, 1e-12, 1e-25}) {
    scene.layers.resize(1);
    scene.layers.push_back(layer(size));
    EXPECT_LT(square_difference(render(scene).image, alone), 1e-6) << size;
  }
}

}  // namespace
}  // namespace pellucid
