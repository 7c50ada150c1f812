// SPDX-License-Identifier: Apache-2.0
//
// Random meshes behind random functions, in packets against rays one by one.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "tests/packet/against_one_by_one.h"
#include "tests/packet/random_frames.h"
#include "tests/scene/tetrahedra/lattice_mesh.h"
#include "tests/support/one_layer.h"

namespace pellucid {
namespace {

using Place = Vec3<double>;

class MeshFrames : public RandomFrames {
 protected:
  MeshFrames() : RandomFrames(1) {}

  std::shared_ptr<const TetrahedralMesh> mesh(unsigned seed, double scale) {
    TetrahedralMesh::Description all = lattice_mesh(1 + static_cast<int>(random_() % 5), seed);
    const double moved = one_of(4) ? 0 : uniform(0, 0.14);
    for (Place& p : all.points) p = scale * (p + moved * aside());
    return std::make_shared<const TetrahedralMesh>(std::move(all));
  }

  /// Variables around `offset`, at points or in tetrahedra, with holes or without.
  std::shared_ptr<const MeshChannels> channels(const std::shared_ptr<const TetrahedralMesh>& mesh,
                                               int count, double scale, double offset,
                                               double width) {
    std::vector<MeshChannel> all;
    for (int c = 0; c < count; ++c) {
      all.push_back(channel(*mesh, scale, offset, width));
      all.back().name = std::to_string(c);
    }
    return std::make_shared<const MeshChannels>(mesh, std::move(all));
  }
  MeshChannel channel(const TetrahedralMesh& mesh, double scale, double offset, double width) {
    const bool noise = one_of(3), per_cell = one_of(4);
    const double holes = one_of(4) ? uniform(0, 0.1) : 0;
    const Place k = (1 / scale) * (aside() * 2.5);
    const auto value = [&](const Place& p) {
      if (uniform(0, 1) < holes) return std::numeric_limits<double>::quiet_NaN();
      const double v =
          noise ? uniform(0, 1) : 0.5 + 0.5 * std::sin(dot(k, p)) * std::cos(k.y * p.x);
      return offset + width * (one_of(20) ? 0.5 : v);
    };
    std::vector<double> values;
    if (per_cell) {
      for (const Tetrahedron& t : mesh.tetrahedra()) {
        Place middle;
        for (const std::int32_t p : t) {
          middle = middle + 0.25 * mesh.points()[static_cast<std::size_t>(p)];
        }
        values.push_back(value(middle));
      }
    } else {
      for (const Place& p : mesh.points()) values.push_back(value(p));
    }
    const Centering centering = per_cell ? Centering::cell : Centering::point;
    MeshChannel result{"", "", centering, values};
    if (one_of(2)) result.values = std::vector<float>(values.begin(), values.end());
    return result;
  }

  Scene scene(unsigned seed) {
    random_.seed(seed);
    const double scale = one_of(4) ? power(1e-4, 1e4) : 1;
    const double offset = one_of(2) ? power(1, 1e4) * (one_of(2) ? 1 : -1) : 0,
                 width = one_of(4) ? power(1e-3, 1e3) : 1;
    const auto bodies = mesh(seed, scale);
    Scene scene;
    set_data(scene, bodies, scale, offset, width);
    scene.size = {12, 9};
    const auto& box = bodies->bounds();
    const double size = length(box.upper - box.lower);
    scene.camera.focal_point = 0.5 * (box.lower + box.upper) + 0.1 * size * aside();
    scene.camera.position =
        scene.camera.focal_point + aside() * (size * (one_of(4) ? 0.2 : uniform(0.9, 2.5)));
    scene.camera.up = {0.1, 0.2, 1};
    return scene;
  }

  virtual void set_data(Scene& scene, const std::shared_ptr<const TetrahedralMesh>& bodies,
                        double scale, double offset, double width) {
    test::mesh_of(scene).mesh = channels(bodies, 1, scale, offset, width);
    test::mesh_of(scene).transfer_function = table(scale, offset, width);
  }

  void expect_to_be_the_same_in_other_packets() {
    for (unsigned seed = 1; seed <= 400; ++seed) {
      SCOPED_TRACE(testing::Message() << "scene " << seed);
      Scene one = scene(seed);
      // One variable is seen in double, and in binary32.
      one.integration.tolerance = seed % 4 == 0 ? 1e-4 : 1e-2;
      RenderOptions options;
      options.machine.threads = 1;
      options.outputs.error = true;
      const Image whole = render(one, options).image;
      options.monitor.preview = 3;  // other pixels beside each other
      const Image other = render(one, options).image;
      ASSERT_EQ(whole.pixels, other.pixels);
      ASSERT_EQ(whole.error, other.error);
    }
  }
};

TEST_F(MeshFrames, AreWithinWhatTheySay) {
  expect_honest_scenes(120, [&](unsigned seed) { return scene(seed); });
}
TEST_F(MeshFrames, AreTheSameWhateverElseIsInAPacket) {
  expect_to_be_the_same_in_other_packets();
}

/// Several variables, behind Gaussians, and tables of single ones.
class MultivariateMeshFrames : public MeshFrames {
 protected:
  void set_data(Scene& scene, const std::shared_ptr<const TetrahedralMesh>& bodies, double scale,
                double offset, double width) override {
    const int count = std::array<int, 6>{1, 1, 2, 3, 5, 8}[random_() % 6];
    test::mesh_of(scene).mesh = channels(bodies, count, scale, offset, width);
    std::vector<ChannelTransferFunction> tables;
    std::vector<GaussianPrimitive> gaussians;
    if (!one_of(8)) gaussians = primitives(count, offset, width, scale);
    if (gaussians.empty() || one_of(4)) {
      const int channel = static_cast<int>(random_() % static_cast<unsigned>(count));
      tables.push_back({channel, *table(scale, offset, width)});
    }
    test::mesh_of(scene).transfer_function = std::make_shared<const MultivariateTransferFunction>(
        count, std::move(gaussians), std::move(tables));
  }
};

TEST_F(MultivariateMeshFrames, GoInPackets) {
  const Scene one = scene(3);
  RenderOptions options;
  options.outputs.error = true;
  const Image lanes = render(one, options).image;
  options.machine.instruction_set = InstructionSet::scalar;
  const Image alone = render(one, options).image;
  // Lanes charge for what they pass over.
  std::size_t others = 0, opaque = 0;
  for (std::size_t i = 0; i < lanes.pixels.size(); ++i) {
    others += lanes.error[i] != alone.error[i];
    opaque += lanes.pixels[i][3] > 0;
  }
  EXPECT_GT(opaque, 10U);
  EXPECT_GE(others, opaque / 2);
}
TEST_F(MultivariateMeshFrames, AreWithinWhatTheySay) {
  expect_honest_scenes(60, [&](unsigned seed) { return scene(seed); });
}
TEST_F(MultivariateMeshFrames, AreTheSameWhateverElseIsInAPacket) {
  expect_to_be_the_same_in_other_packets();
}

}  // namespace
}  // namespace pellucid
