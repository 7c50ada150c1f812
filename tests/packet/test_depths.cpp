// SPDX-License-Identifier: Apache-2.0
//
// The depth of half of the opacity, of rays in packets: by the reference, how much of a ray's
// optical depth is in front of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/reference/render.h"
#include "pellucid/render/camera.h"
#include "pellucid/scene/defaults.h"
#include "tests/packet/random_frames.h"
#include "tests/scene/tetrahedra/lattice_mesh.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid {
namespace {

class Depths : public RandomFrames {
 protected:
  Depths() : RandomFrames(5) {}

  /// Waves, and noise on them.
  std::shared_ptr<const Volume> volume(double longest, double noise, bool rectilinear,
                                       std::array<int, 3> dimensions) {
    Volume::Description description;
    description.dimensions = dimensions;
    if (rectilinear) {
      for (int i = 0; i < 30; ++i) description.coordinates[1].push_back(i + 0.01 * i * i);
    }
    const Vec3<double> d = aside(), k = d * (6.3 / (longest * length(d)));
    std::vector<float> values;
    for (int z = 0; z < description.dimensions[2]; ++z) {
      for (int y = 0; y < description.dimensions[1]; ++y) {
        for (int x = 0; x < description.dimensions[0]; ++x) {
          const double wave = std::sin(dot(k, Vec3<double>{x + 0.0, y + 0.0, z + 0.0}));
          values.push_back(static_cast<float>(0.5 + 0.45 * wave + noise * uniform(-1, 1)));
        }
      }
    }
    return std::make_shared<const Volume>(description, DataArray<float>(std::move(values)));
  }

  std::array<int, 3> some_values() { return {24 + static_cast<int>(random_() % 9), 30, 27}; }

  Scene of_volume(double longest, double noise, bool peaks) {
    Scene scene;
    test::volume_of(scene).volume = volume(longest, noise, false, some_values());
    const double e = power(0.05, 20) / 27;
    test::volume_of(scene).transfer_function =
        peaks ? table(27, 0, 1)
              : std::make_shared<const TransferFunction>(TransferFunction(
                    {{-0.1, 0.4 * e, {1, 0.2, 0.1}}, {1.1, 1.6 * e, {0.1, 0.7, 0.9}}}));
    const auto data = test::volume_of(scene).volume;
    return seen(std::move(scene), *data);
  }
  Scene of_channels(double longest, bool rectilinear, bool with_table) {
    Scene scene;
    std::vector<Channel> channels;
    const auto first = volume(longest, 0, rectilinear, some_values());
    channels.push_back({"0", "", first});
    test::channels_of(scene).channels = std::make_shared<const Channels>(std::move(channels));
    std::vector<ChannelTransferFunction> tables;
    if (with_table) tables.push_back({0, *table(27, 0, 1)});
    test::channels_of(scene).transfer_function =
        std::make_shared<const MultivariateTransferFunction>(1, primitives(1, 0, 1, 27),
                                                             std::move(tables));
    return seen(std::move(scene), *first);
  }
  /// Rays along so many cells, in each of which something absorbs.
  Scene of_many_cells(int cells, bool gaussians) {
    const auto data = volume(9, 0.05, false, {cells + 1, 5, 5});
    Scene scene;
    scene.size = {8, 8};
    if (gaussians) {
      test::channels_of(scene).channels =
          std::make_shared<const Channels>(std::vector<Channel>{{"0", "", data}});
      std::vector<GaussianPrimitive> one(1);
      one[0].channels = {0};
      one[0].center = {0.5};
      one[0].matrix = matrix_from_widths({0.2});
      one[0].extinction = 3.0 / cells;
      test::channels_of(scene).transfer_function =
          std::make_shared<const MultivariateTransferFunction>(1, std::move(one));
    } else {
      test::volume_of(scene).volume = data;
      const double e = 3.0 / cells;
      test::volume_of(scene).transfer_function =
          std::make_shared<const TransferFunction>(std::vector<TransferFunction::Point>{
              {-0.1, 0, {1, 1, 1}}, {0.5, e, {1, 0, 0}}, {1.1, 0.2 * e, {0, 0, 1}}});
    }
    scene.camera = default_camera(*data, scene.size);
    scene.camera.position = scene.camera.focal_point - Vec3<double>{1.0 * cells, 0.3, 0.2};
    scene.camera.up = {0, 0, 1};
    scene.camera.projection = Projection::orthographic;
    scene.camera.parallel_scale = 1.5;
    return scene;
  }
  Scene of_mesh(bool several) {
    TetrahedralMesh::Description all = lattice_mesh(2 + static_cast<int>(random_() % 3), 7);
    const auto mesh = std::make_shared<const TetrahedralMesh>(std::move(all));
    std::vector<MeshChannel> channels;
    for (int c = 0; c < (several ? 2 : 1); ++c) {
      const Vec3<double> k = 3.0 * aside();
      std::vector<double> values;
      for (const Vec3<double>& p : mesh->points())
        values.push_back(0.5 + 0.5 * std::sin(dot(k, p)));
      channels.push_back({std::to_string(c), "", Centering::point, std::move(values)});
    }
    Scene scene;
    test::mesh_of(scene).mesh = std::make_shared<const MeshChannels>(mesh, std::move(channels));
    if (several) {
      test::mesh_of(scene).transfer_function =
          std::make_shared<const MultivariateTransferFunction>(2, primitives(2, 0, 1, 1));
    } else {
      test::mesh_of(scene).transfer_function = table(1, 0, 1);
    }
    scene.size = {8, 8};
    const auto& box = mesh->bounds();
    scene.camera.focal_point = 0.5 * (box.lower + box.upper);
    scene.camera.position =
        scene.camera.focal_point + aside() * (1.5 * length(box.upper - box.lower));
    scene.camera.up = {0.1, 0.2, 1};
    return scene;
  }

  /// Of all instruction sets, that half of the opacity is where they say, but for what pixels say
  /// that they are off by: of the opacity, and of that up to the half.
  void expect_half(Scene scene, double tolerance, RenderOptions options = {}) {
    options.outputs.depth = options.outputs.error = true;
    scene.integration.tolerance = tolerance;
    const ReferenceRays reference(scene);
    const CameraFrame<double> camera = make_camera_frame(scene.camera, scene.size);
    for (const InstructionSet set : packet_sets) {
      if (!test::runs_here(set)) continue;
      SCOPED_TRACE(testing::Message() << name_of(set) << " at " << tolerance);
      options.machine.instruction_set = set;
      options.monitor.preview = 0;
      const Image image = render(scene, options).image;
      options.monitor.preview = 3;  // other rays beside each other
      ASSERT_EQ(image.depth, render(scene, options).image.depth);
      for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
        const double opacity{image.pixels[i][3]}, depth{image.depth[i]};
        ASSERT_EQ(opacity > 0, std::isfinite(depth)) << "pixel " << i;
        // Of rays that end in the dark the reference does not know all of the depth.
        if (!(opacity > 0) || opacity > 0.99) continue;
        const int pixel = static_cast<int>(i);
        const Ray<double> ray = camera.ray(pixel % scene.size.width, pixel / scene.size.width);
        const ReferencePixel whole = reference(ray.origin, ray.direction),
                             behind = reference(ray.origin + depth * ray.direction, ray.direction);
        const double front = -std::expm1(behind.optical_depth - whole.optical_depth);
        // Depths are rounded to binary32.
        const double off = std::fabs(front - 0.5 * opacity),
                     said = 2 * double{image.error[i]} + 1e-5;
        ASSERT_LE(off, said) << "pixel " << i << " of opacity " << opacity;
        worst_ = std::max(worst_, off / said);
        ++seen_;
      }
    }
  }
  /// `pixels`: to be seen with three instruction sets.
  void report(int pixels) {
    std::printf("%d pixels, at most %.3f of what they say\n", seen_, worst_);
    EXPECT_GE(3 * seen_, pixels * set_count());
  }

 private:
  Scene seen(Scene scene, const Volume& grid) {
    scene.size = {8, 8};
    scene.camera = default_camera(grid, scene.size);
    return scene;
  }

  int seen_ = 0;
  double worst_ = 0;
};

TEST_F(Depths, OfSmoothData) {
  for (int n = 0; n < 20; ++n) expect_half(of_volume(30, 0, false), n % 2 == 0 ? 1e-2 : 1e-4);
  report(300);
}
TEST_F(Depths, OfCells) {
  for (int n = 0; n < 40; ++n) expect_half(of_volume(9, 0.1, true), n % 2 == 0 ? 1e-2 : 1e-4);
  report(300);
}
/// More segments than are kept.
TEST_F(Depths, OfManySegments) {
  for (const int cells : {300, 700}) {
    for (const bool gaussians : {false, true}) {
      RenderOptions options;
      options.machine.gaussian_march = GaussianMarch::cells;
      expect_half(of_many_cells(cells, gaussians), 1e-4, options);
    }
  }
  report(200);
}
TEST_F(Depths, OfGaussians) {
  for (int n = 0; n < 20; ++n) {
    const Scene scene = of_channels(12, false, false);
    for (const GaussianMarch march : {GaussianMarch::steps, GaussianMarch::cells}) {
      RenderOptions options;
      options.machine.gaussian_march = march;
      expect_half(scene, n % 2 == 0 ? 1e-2 : 1e-4, options);
    }
  }
  report(300);
}
TEST_F(Depths, OfGaussiansBesideTablesAndOnRectilinearGrids) {
  for (int n = 0; n < 10; ++n) {
    expect_half(of_channels(12, false, true), 1e-3);
    expect_half(of_channels(12, true, false), 1e-3);
  }
  report(300);
}
TEST_F(Depths, OfMeshes) {
  for (int n = 0; n < 40; ++n) expect_half(of_mesh(false), n % 2 == 0 ? 1e-2 : 1e-4);
  report(300);
}
TEST_F(Depths, OfMeshesWithSeveralVariables) {
  for (int n = 0; n < 40; ++n) expect_half(of_mesh(true), n % 2 == 0 ? 1e-2 : 1e-4);
  report(300);
}

}  // namespace
}  // namespace pellucid
