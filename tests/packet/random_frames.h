// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "pellucid/scene/channels.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/scene/scene.h"
#include "pellucid/scene/transfer_function.h"
#include "tests/packet/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid {

/// Has an orthographic camera look along x, with this scale.
inline void look_along_x(Scene& scene, double parallel_scale, double distance = 100) {
  scene.camera = default_camera(test::channels_of(scene).channels->grid(), scene.size);
  scene.camera.position = scene.camera.focal_point - Vec3<double>{distance, 0, 0};
  scene.camera.up = {0, 0, 1};
  scene.camera.projection = Projection::orthographic;
  scene.camera.parallel_scale = parallel_scale;
}

/// A ramp along x behind so many cells of nothing, and no wider than `points` across; seen along x
/// by four rays that lie in the grid's faces, two of them in the upper ones.
inline Scene ramp_seen_in_faces(int points, int empty) {
  const int along = 49;
  std::vector<float> data;
  for (int i = 0; i < along * points * points; ++i) {
    data.push_back(static_cast<float>(std::max(i % along - empty, 0)) / 30);
  }
  Volume::Description description;
  description.dimensions = {along, points, points};
  Scene scene;
  test::channels_of(scene).channels = std::make_shared<const Channels>(std::vector<Channel>{
      {"ramp", "", std::make_shared<Volume>(description, DataArray<float>(std::move(data)))}});
  scene.size = {2, 2};
  look_along_x(scene, points - 1);
  return scene;
}

/// Frames of random scenes, in packets.
class RandomFrames : public testing::Test {
 protected:
  explicit RandomFrames(unsigned seed) : random_(seed) {}
  void SetUp() override {
    if (no_packets()) GTEST_SKIP() << "this machine has no instruction set for packets";
  }

  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  /// As often of one order of magnitude as of another.
  double power(double a, double b) { return a * std::pow(b / a, uniform(0, 1)); }
  bool one_of(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)) == 0; }
  Vec3<double> aside() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }

  /// One to six ranges that absorb, some of them thin, with steep colors and jumps: over the data
  /// offset + width · [0, 1], of a field that is `scale` large.
  std::shared_ptr<const TransferFunction> table(double scale, double offset, double width) {
    const double most = power(0.05, one_of(4) ? 1000 : 20) / scale;
    const auto color = [&] { return Rgb<double>{uniform(0, 1), uniform(0, 1), uniform(0, 1)}; };
    const auto extinction = [&] { return one_of(6) ? most : uniform(0, most); };
    const bool jumps = one_of(10), steep = one_of(2), one_color = one_of(6);
    std::vector<TransferFunction::Point> all;
    double v = uniform(-0.2, 0.2);
    const auto add = [&](double e) { all.push_back({offset + width * v, e, color()}); };
    if (one_of(5)) add(extinction());
    const int ranges = 1 + static_cast<int>(random_() % 6);
    for (int n = 0; n < ranges; ++n) {
      v += one_of(2) ? power(1e-4, 0.1) : uniform(0.01, 0.3);
      const double size = one_of(2) ? power(3e-4, 0.05) : uniform(0.02, 0.3);
      add(0);
      const int inner = 1 + static_cast<int>(random_() % (one_of(3) ? 8 : 2));
      for (int i = 0; i < inner; ++i) {
        v += size / (inner + 1) * uniform(0.3, 1.7);
        add(extinction());
        if (steep && one_of(4)) {
          v += power(1e-4, 1e-2);
          add(extinction());
        }
        if (jumps && one_of(4)) add(extinction());
      }
      v += size / (inner + 1);
      add(0);
    }
    if (one_of(5)) add(extinction());
    for (std::size_t i = 1; i < all.size(); ++i) {
      all[i].value = std::max(all[i].value, all[i - 1].value);
      if (one_color) all[i].color = all[0].color;
    }
    return std::make_shared<const TransferFunction>(std::move(all));
  }

  /// Primitives over so many channels, their data offset + width · [0, 1], of a field that is
  /// `size` large: wide ones and narrow ones, some of which mix channels.
  std::vector<GaussianPrimitive> primitives(int channels, double offset, double width,
                                            double size) {
    const double narrowest = power(0.002, 0.5), depth = power(0.2, 20);
    std::vector<GaussianPrimitive> all;
    for (int n = std::array<int, 6>{1, 2, 3, 5, 12, 80}[random_() % 6]; n > 0; --n) {
      GaussianPrimitive p;
      std::vector<double> widths;
      for (int c = 0; c < channels; ++c) {
        if (c > 0 && one_of(3)) continue;
        p.channels.push_back(c);
        p.center.push_back(offset + width * uniform(0, 1));
        widths.push_back(narrowest * power(1, 4));
      }
      p.extinction = power(0.1, 1) * depth / (size * widths.front());
      for (double& w : widths) w *= width;
      p.matrix = matrix_from_widths(widths);
      if (widths.size() > 1 && one_of(2)) {
        // Rows of several channels, as many or one alone.
        const std::size_t rows = one_of(2) ? 1 : widths.size();
        p.matrix.assign(rows, {});
        for (std::vector<double>& row : p.matrix) {
          for (const double w : widths) row.push_back(uniform(-1, 1) / w);
        }
      }
      p.color = {uniform(0, 1), uniform(0, 1), uniform(0, 1)};
      all.push_back(p);
    }
    return all;
  }

  std::mt19937 random_;
};

}  // namespace pellucid
