// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "pellucid/reference/render.h"
#include "pellucid/scene/error.h"
#include "src/reference/mesh/mesh.h"
#include "tests/scenes/makers.h"
#include "tests/scenes/meshes.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_meshes {
namespace {

using scenes::at_cells;
using scenes::at_points;
using scenes::make_mesh;
using scenes::MeshPointer;
using scenes::on_mesh;
using Place = Vec3<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Scene scene_of(const MeshPointer& mesh, MeshChannel channel, scenes::Points points) {
  Scene scene;
  test::mesh_of(scene).mesh = on_mesh(mesh, {std::move(channel)});
  test::mesh_of(scene).transfer_function = scenes::transfer(std::move(points));
  return scene;
}

MeshPointer corner_tetrahedron() {
  return make_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, "corner"});
}

/// A ray with a direction of length 1 in extended precision.
reference::RealRay ray_through(const Place& origin, const Place& direction) {
  const long double length =
      std::hypot(static_cast<long double>(direction.x), static_cast<long double>(direction.y),
                 static_cast<long double>(direction.z));
  return {{origin.x, origin.y, origin.z},
          {static_cast<long double>(direction.x) / length,
           static_cast<long double>(direction.y) / length,
           static_cast<long double>(direction.z) / length}};
}

/// The data are x, the extinction 3 x, along x from 0 to 1/2: 3/8 deep.
TEST(ReferenceMesh, ARampInOneTetrahedron) {
  const MeshPointer mesh = corner_tetrahedron();
  const Scene scene = scene_of(mesh, at_points(*mesh, "x", [](const Place& p) { return p.x; }),
                               {{0, 0, {1, 0.5, 0.25}}, {1, 3, {1, 0.5, 0.25}}});
  const ReferencePixel pixel = reference_ray(scene, {-2, 0.25, 0.25}, {4, 0, 0});
  EXPECT_NEAR(pixel.optical_depth, 0.375, 1e-15);
  EXPECT_NEAR(pixel.opacity, -std::expm1(-0.375), 1e-15);
  EXPECT_NEAR(pixel.radiance.g, -0.5 * std::expm1(-0.375), 1e-15);
  EXPECT_EQ(pixel.overlap, 0);
  // 1.5 x² = -log(1 - opacity/2), two units behind the origin of the ray.
  const double half = std::sqrt(-std::log1p(-0.5 * pixel.opacity) / 1.5);
  EXPECT_NEAR(pixel.half_opacity_depth, 2 + half, 1e-13);
  // From within: 1.5 (1/4 - 1/16) of it is ahead.
  EXPECT_NEAR(reference_ray(scene, {0.25, 0.25, 0.25}, {1, 0, 0}).optical_depth, 0.28125, 1e-15);
  EXPECT_EQ(reference_ray(scene, {0.6, 0.25, 0.25}, {1, 0, 0}).optical_depth, 0);
  EXPECT_EQ(reference_ray(scene, {-2, 0.6, 0.6}, {1, 0, 0}).optical_depth, 0);
}

/// Extinction k, the color running from red to green: ∫ k u e^(-ku) du is what green gathers.
TEST(ReferenceMesh, ARampOfColorInOneTetrahedron) {
  const MeshPointer mesh = corner_tetrahedron();
  for (const double k : {1e-3, 1.0, 40.0, 1e5}) {
    const Scene scene =
        scene_of(mesh, at_points(*mesh, "x", [](const Place& p) { return 2 * p.x; }),
                 {{0, k, {1, 0, 0}}, {1, k, {0, 1, 0}}});
    const ReferencePixel pixel = reference_ray(scene, {-1, 0.25, 0.25}, {1, 0, 0});
    const long double depth = 0.5L * k;
    const long double opacity = -std::expm1(-depth);
    const long double green = opacity / depth - std::exp(-depth);
    EXPECT_NEAR(pixel.opacity, static_cast<double>(opacity), 1e-15) << k;
    EXPECT_NEAR(pixel.radiance.g, static_cast<double>(green), 1e-12) << k;
    EXPECT_NEAR(pixel.radiance.r, static_cast<double>(opacity - green), 1e-12) << k;
  }
}

/// In six tetrahedra of a cube, from any side, along its edges' directions and its diagonal.
TEST(ReferenceMesh, ConstantDataInACubeAreASlab) {
  const MeshPointer mesh = make_mesh(scenes::box_of_cubes(1));
  const Scene points = scene_of(mesh, at_points(*mesh, "one", [](const Place&) { return 1.0; }),
                                {{0, 0, {0, 0, 0}}, {2, 1, {1, 2, 3}}});
  Scene cells = points;
  test::mesh_of(cells).mesh =
      on_mesh(mesh, {at_cells(*mesh, "one", [](const Place&) { return 1.0; })});
  const struct {
    Place origin, direction;
    double length;
  } rays[] = {{{-3, 0.3, -0.2}, {1, 0, 0}, 2},
              {{0.1, 5, 0.4}, {0, -2, 0}, 2},
              {{0, 0, 3}, {0, 0, -1}, 2},
              {{0.5, 0.5, 3}, {0, 0, -1}, 2},
              {{-2, -2, -2}, {1, 1, 1}, std::sqrt(12)},
              {{-2, -2, 0}, {1, 1, 0}, std::sqrt(8)},
              {{0, 0, 0}, {0, 1, 0}, 1},
              {{-2, 0, -1.5}, {1, 0, 1}, std::sqrt(4.5)},
              {{-1, -1, 1}, {1, 1, -1}, std::sqrt(12)},
              {{3, 3, 0}, {1, 1, 0}, 0}};
  for (const auto& ray : rays) {
    for (const Scene& scene : {points, cells}) {
      const ReferencePixel pixel = reference_ray(scene, ray.origin, ray.direction);
      EXPECT_NEAR(pixel.optical_depth, 0.5 * ray.length, 1e-15);
      EXPECT_NEAR(pixel.radiance.b, -1.5 * std::expm1(-0.5 * ray.length), 3e-15);
      EXPECT_LT(pixel.overlap, 1e-17);
    }
  }
}

/// Linear data are the same in cells of either kind; so are pictures with any transfer function.
TEST(ReferenceMesh, LinearDataOnAGridAreThoseOfItsTetrahedra) {
  constexpr int n = 6;
  const auto field = [](double x, double y, double z) { return 0.1 + 0.5 * x - 0.25 * y + z; };
  const scenes::VolumePointer volume =
      scenes::make_volume<double>(scenes::grid_description({n + 1, n + 1, n + 1}),
                                  [&](int i, int j, int k) { return field(i, j, k); });
  const MeshPointer mesh =
      make_mesh(scenes::tetrahedralize({{n, n, n}, [](int i, int j, int k) {
                                          return Place{1.0 * i, 1.0 * j, 1.0 * k};
                                        }}));
  Scene grid;
  test::volume_of(grid).volume = volume;
  test::volume_of(grid).transfer_function = scenes::transfer({{0, 0, {1, 0, 0}},
                                                              {2, 0.3, {0.2, 1, 0}},
                                                              {2, 0.1, {0, 0.2, 1}},
                                                              {4.001, 0.1, {1, 1, 1}},
                                                              {4.003, 90, {1, 0, 1}},
                                                              {4.005, 0.2, {0.5, 1, 1}},
                                                              {7, 2, {3, 1, 0}}});
  Scene tetrahedra;
  test::mesh_of(tetrahedra).mesh =
      on_mesh(mesh, {at_points(*mesh, "f", [&](const Place& p) { return field(p.x, p.y, p.z); })});
  test::mesh_of(tetrahedra).transfer_function = test::volume_of(grid).transfer_function;

  Scene grid_of_two, mesh_of_two;
  test::channels_of(grid_of_two).channels = std::make_shared<const Channels>(std::vector<Channel>{
      {"f", "", volume},
      {"g", "",
       scenes::make_volume<double>(scenes::grid_description({n + 1, n + 1, n + 1}),
                                   [&](int i, int j, int k) { return field(k, i, j); })}});
  test::mesh_of(mesh_of_two).mesh =
      on_mesh(mesh, {at_points(*mesh, "f", [&](const Place& p) { return field(p.x, p.y, p.z); }),
                     at_points(*mesh, "g", [&](const Place& p) { return field(p.z, p.x, p.y); })});
  GaussianPrimitive gaussian;
  gaussian.channels = {0, 1};
  gaussian.center = {3, 3.5};
  gaussian.matrix = {{9, -5}, {0.5, 0.5}};
  gaussian.extinction = 3;
  gaussian.color = {1, 0.5, 0.2};
  const auto both = std::make_shared<const MultivariateTransferFunction>(
      2, std::vector{gaussian},
      std::vector<ChannelTransferFunction>{{1, *test::volume_of(grid).transfer_function}});
  test::channels_of(grid_of_two).transfer_function = both;
  test::mesh_of(mesh_of_two).transfer_function = both;

  std::mt19937 random(3);
  const auto draw = [&] { return static_cast<double>(random()) / 4294967296.0 * n; };
  double largest = 0;
  for (const auto& [first, second] :
       {std::pair{grid, tetrahedra}, std::pair{grid_of_two, mesh_of_two}}) {
    const ReferenceRays in_grid(first), in_mesh(second);
    double lit = 0;
    for (int i = 0; i < 100; ++i) {
      const Place to{draw(), draw(), draw()};
      const Place from =
          i % 5 == 0 ? Place{draw(), draw(), draw()} : Place{draw() - n, 2 * draw() - n, -draw()};
      const ReferencePixel p = in_grid(from, to - from), q = in_mesh(from, to - from);
      for (const double off : {p.radiance.r - q.radiance.r, p.radiance.g - q.radiance.g,
                               p.radiance.b - q.radiance.b, p.opacity - q.opacity}) {
        largest = std::max(largest, std::abs(off));
      }
      if (p.opacity > 0) {
        EXPECT_NEAR(p.half_opacity_depth, q.half_opacity_depth, 1e-11);
      }
      EXPECT_LT(q.overlap, 1e-17);
      lit += p.opacity;
    }
    EXPECT_GT(lit, 30);
  }
  std::printf("[ accuracy ] linear data, grid and tetrahedra: %.1e apart\n", largest);
  EXPECT_LT(largest, 2e-12);
}

/// NaN at a point, or in the cell: the tetrahedra that have it are vacuum.
TEST(ReferenceMesh, NaNIsVacuum) {
  const MeshPointer mesh =
      make_mesh(scenes::tetrahedralize({{3, 1, 1}, [](int i, int j, int k) {
                                          return Place{1.0 * i, 1.0 * j, 1.0 * k};
                                        }}));
  const Scene at_point =
      scene_of(mesh, at_points(*mesh, "f", [](const Place& p) { return p.x > 2.5 ? nan : 1.0; }),
               {{0, 1, {1, 1, 1}}});
  EXPECT_NEAR(reference_ray(at_point, {-1, 0.4, 0.3}, {1, 0, 0}).optical_depth, 2, 1e-15);
  const Scene in_cell = scene_of(
      mesh, at_cells(*mesh, "f", [](const Place& p) { return p.x > 1 && p.x < 2 ? nan : 1.0; }),
      {{0, 1, {1, 1, 1}}});
  EXPECT_NEAR(reference_ray(in_cell, {-1, 0.4, 0.3}, {1, 0, 0}).optical_depth, 2, 1e-15);
}

/// Whatever it meets, a ray through a box of tetrahedra is in one of them all of the way, and
/// leaves nothing out.
TEST(ReferenceMesh, RaysThroughPointsEdgesAndFacesAreInOneTetrahedronAtATime) {
  constexpr int n = 4;
  const MeshPointer mesh =
      make_mesh(scenes::tetrahedralize({{n, n, n}, [](int i, int j, int k) {
                                          return Place{1.0 * i, 1.0 * j, 1.0 * k};
                                        }}));
  const reference::Mesh own(*mesh);
  std::vector<Place> targets;  // Those of every third tetrahedron.
  for (std::size_t n_th = 0; n_th < mesh->tetrahedra().size(); n_th += 3) {
    const Tetrahedron& t = mesh->tetrahedra()[n_th];
    const auto at = [&](int i) { return mesh->points()[static_cast<std::size_t>(t[i])]; };
    for (int i = 0; i < 4; ++i) {
      targets.push_back(at(i));
      for (int j = 0; j < i; ++j) targets.push_back(0.5 * (at(i) + at(j)));
      const int b = (i + 1) % 4, c = (i + 2) % 4;
      targets.push_back(0.25 * at(i) + 0.25 * at(b) + 0.5 * at(c));
    }
  }
  int rays = 0;
  for (const Place& direction :
       {Place{1, 0, 0}, {0, 0, -1}, {1, 1, 0}, {-1, 1, 1}, {3, 2, 1}, {0.3, -0.7, 0.2}}) {
    for (const Place& target : targets) {
      // Where the ray is in the box by its own planes; not those that run within a side of it.
      const reference::RealRay ray = ray_through(target - 64 * direction, direction);
      long double begin = -1e9L, end = 1e9L;
      bool outside = false;
      for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        if (ray.direction[axis] == 0) {
          outside = outside || target[a] == 0 || target[a] == n;
          continue;
        }
        const long double p = -ray.origin[axis] / ray.direction[axis],
                          q = (n - ray.origin[axis]) / ray.direction[axis];
        begin = std::max(begin, std::min(p, q));
        end = std::min(end, std::max(p, q));
      }
      if (outside || end - begin < 1e-6L) continue;
      ++rays;
      const auto crossings = own.crossings(ray);
      long double inside = 0;
      for (const auto& c : crossings) inside += c.t_end - c.t_begin;
      ASSERT_NEAR(static_cast<double>(inside), static_cast<double>(end - begin), 1e-15);
      ASSERT_LT(reference::overlap_of(crossings), 1e-16L);
      ASSERT_LT(reference::gap_of(crossings), 1e-16L);
    }
  }
  EXPECT_GT(rays, 3000);
}

/// Slivers of a Delaunay mesh, and of one that is a thousand times flatter.
TEST(ReferenceMesh, SliversNeitherOverlapNorGape) {
  for (const double flatness : {1.0, 1e-3, 1e-9}) {
    TetrahedralMesh::Description description = scenes::random_delaunay(200, 3);
    for (Place& p : description.points) p.z *= flatness;
    const MeshPointer mesh = make_mesh(std::move(description));
    const reference::Mesh own(*mesh);
    std::mt19937 random(1);
    const auto draw = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
    std::size_t met = 0;
    for (int i = 0; i < 400; ++i) {
      const Place target = i % 2 == 0 ? Place{draw(), draw(), draw() * flatness}
                                      : 0.5 * mesh->points()[static_cast<std::size_t>(i / 2)];
      const Place direction{draw(), draw(), draw() * (i % 3 == 0 ? 1 : flatness)};
      const auto crossings = own.crossings(ray_through(target - 10 * direction, direction));
      met += crossings.size();
      ASSERT_LT(reference::overlap_of(crossings), 1e-16L) << flatness << ", ray " << i;
      // The middle half of the points is far from the boundary: none is left out.
      ASSERT_LT(reference::gap_of(crossings), 1e-16L) << flatness << ", ray " << i;
    }
    EXPECT_GT(met, 3000u);
  }
}

TEST(ReferenceMesh, OverlapIsTold) {
  // A cube's six tetrahedra twice, the second time half an edge farther along x.
  TetrahedralMesh::Description first = scenes::box_of_cubes(1), second = first;
  for (Place& p : second.points) p.x += 1;
  const MeshPointer mesh = make_mesh(scenes::joined(std::move(first), second));
  const Scene scene =
      scene_of(mesh, at_points(*mesh, "f", [](const Place&) { return 1.0; }), {{0, 1, {1, 1, 1}}});
  EXPECT_NEAR(reference_ray(scene, {-3, 0.4, 0.3}, {1, 0, 0}).overlap, 1, 1e-15);
  EXPECT_EQ(reference_ray(scene, {-0.5, -3, 0.3}, {0, 1, 0}).overlap, 0);
}

TEST(ReferenceMesh, ImagesAreTheirRays) {
  const MeshPointer mesh = make_mesh(scenes::box_of_cubes(2));
  Scene scene = scene_of(mesh, at_points(*mesh, "f", [](const Place& p) { return p.x * p.y; }),
                         {{-1, 0, {1, 0, 0}}, {1, 3, {0, 1, 1}}});
  scene.camera.position = {3, 4, 5};
  scene.size = {9, 7};
  const auto [image, report] = render_reference(scene);
  EXPECT_GT(report.cells, 40u);
  const ReferenceRays rays(scene);
  const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 9; ++column) {
      const Ray<double> ray = frame.ray(column, row);
      const ReferencePixel pixel = rays(ray.origin, ray.direction);
      EXPECT_NEAR(static_cast<double>(image.at(column, row)[1]), pixel.radiance.g, 1e-7);
      EXPECT_NEAR(static_cast<double>(image.at(column, row)[3]), pixel.opacity, 1e-7);
    }
  }
  EXPECT_GT(image.at(4, 3)[3], 0.1f);
  EXPECT_THROW(rays({0, 0, 0}, {0, 0, 0}), Error);
}

}  // namespace
}  // namespace pellucid::test_meshes
