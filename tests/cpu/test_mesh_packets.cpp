// SPDX-License-Identifier: Apache-2.0
//
// Rays through meshes in packets against the same rays one by one in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/defaults.h"
#include "tests/scene/tetrahedra/lattice_mesh.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_mesh_packets {
namespace {

using Place = Vec3<double>;
using MeshPointer = std::shared_ptr<const TetrahedralMesh>;

/// Cubes whose points are pushed aside, so that no faces are in line.
MeshPointer bent(int cubes) {
  TetrahedralMesh::Description mesh = lattice_mesh(cubes, 3);
  for (Place& p : mesh.points) {
    p = p + 0.2 * Place{std::sin(3 * p.y + p.z), std::sin(2 * p.z + p.x), std::sin(4 * p.x - p.y)};
  }
  return std::make_shared<const TetrahedralMesh>(std::move(mesh));
}

/// Walls across x, two hits each.
MeshPointer walls(int count) {
  return std::make_shared<const TetrahedralMesh>(
      lattice_mesh({2 * count, 3, 3}, 5, [](int i, int, int) { return i % 2 == 0; }));
}

double wave(const Place& p) {
  return 0.5 + 0.25 * std::sin(0.9 * p.x + 0.3 * p.y) + 0.2 * std::cos(0.8 * p.z - 0.5 * p.y);
}

std::shared_ptr<const MeshChannels> at_points(const MeshPointer& mesh) {
  std::vector<float> values;
  values.reserve(mesh->points().size());
  for (const Place& p : mesh->points()) values.push_back(static_cast<float>(wave(p)));
  return std::make_shared<const MeshChannels>(
      mesh, std::vector<MeshChannel>{{"f", "", Centering::point, std::move(values)}});
}

/// Every `vacuum`-th is empty; 0: none.
std::shared_ptr<const MeshChannels> at_tetrahedra(const MeshPointer& mesh, std::size_t vacuum) {
  std::vector<double> values;
  values.reserve(mesh->tetrahedra().size());
  for (const Tetrahedron& t : mesh->tetrahedra()) {
    Place middle;
    for (const std::int32_t p : t)
      middle = middle + 0.25 * mesh->points()[static_cast<std::size_t>(p)];
    const bool empty = vacuum != 0 && values.size() % vacuum == 0;
    values.push_back(empty ? std::numeric_limits<double>::quiet_NaN() : wave(middle));
  }
  return std::make_shared<const MeshChannels>(
      mesh, std::vector<MeshChannel>{{"f", "", Centering::cell, std::move(values)}});
}

/// The points' values, with NaN at every `vacuum`-th.
std::shared_ptr<const MeshChannels> with_holes(const MeshPointer& mesh, std::size_t vacuum) {
  std::vector<float> values;
  values.reserve(mesh->points().size());
  for (const Place& p : mesh->points()) {
    values.push_back(values.size() % vacuum == 0 ? std::numeric_limits<float>::quiet_NaN()
                                                 : static_cast<float>(wave(p)));
  }
  return std::make_shared<const MeshChannels>(
      mesh, std::vector<MeshChannel>{{"f", "", Centering::point, std::move(values)}});
}

/// Ramps, a narrow peak, a gap and, if asked for, a jump.
std::shared_ptr<const TransferFunction> ramps(bool jump) {
  std::vector<TransferFunction::Point> points{
      {0.1, 0, {0.1, 0.2, 0.8}},  {0.3, 0.6, {0.2, 0.7, 0.9}}, {0.45, 0.2, {0.3, 0.9, 0.4}},
      {0.5, 2, {1, 0.8, 0.2}},    {0.52, 0, {0.9, 0.3, 0.3}},  {0.58, 0, {0.9, 0.3, 0.3}},
      {0.7, 0.3, {0.9, 0.1, 0.5}}};
  if (jump) points.push_back({0.7, 1.2, {0.1, 0.9, 0.5}});
  points.push_back({0.95, 0, {0.8, 0.8, 0.8}});
  return std::make_shared<const TransferFunction>(std::move(points));
}

Scene scene_of(std::shared_ptr<const MeshChannels> mesh, bool jump = false) {
  Scene scene;
  test::mesh_of(scene).mesh = std::move(mesh);
  test::mesh_of(scene).transfer_function = ramps(jump);
  scene.size = {29, 23};
  const Box<double>& box = test::mesh_of(scene).mesh->mesh().bounds();
  scene.camera.focal_point = 0.5 * (box.lower + box.upper);
  scene.camera.position =
      scene.camera.focal_point + Place{1.1, -1.9, 1.3} * length(box.upper - box.lower);
  scene.camera.up = {0, 0, 1};
  return scene;
}

Image rendered(const Scene& scene, InstructionSet set, RenderReport& report, int threads = 0) {
  RenderOptions options;
  options.machine.instruction_set = set;
  options.outputs.error = true;
  options.machine.threads = threads;
  RenderResult frame = render(scene, options);
  report = std::move(frame.report);
  return std::move(frame.image);
}

/// Pixels are as near to those of rays in double as both say; none is over the tolerance.
void expect_same(Scene scene, const std::string& what) {
  for (const double tolerance : {1e-2, 1.0 / 512, 1e-5}) {
    scene.integration.tolerance = tolerance;
    RenderReport one, packets;
    const Image scalar = rendered(scene, InstructionSet::scalar, one);
    EXPECT_EQ(one.pixels_over_tolerance, 0u) << what;
    float most = 0;
    for (const auto& pixel : scalar.pixels) most = std::max(most, pixel[3]);
    EXPECT_GT(most, 0.2f) << what << " shows nothing";
    for (const InstructionSet set : packet_sets) {
      if (!PELLUCID_HAS_PACKETS || !test::runs_here(set)) continue;
      const Image image = rendered(scene, set, packets);
      const std::string where = what + ", " + name_of(set) + ", " + std::to_string(tolerance);
      EXPECT_EQ(packets.pixels_over_tolerance, 0u) << where;
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const float allowed = image.error[i] + scalar.error[i] + 1e-6f;
        for (std::size_t c = 0; c < 4; ++c) {
          ASSERT_NEAR(image.pixels[i][c], scalar.pixels[i][c], allowed)
              << where << ", pixel " << i << ", channel " << c;
        }
      }
    }
  }
}

TEST(MeshPackets, GiveWhatRaysOneByOneGive) {
  const MeshPointer mesh = bent(6);
  expect_same(scene_of(at_points(mesh)), "at points");
  expect_same(scene_of(at_points(mesh), true), "with a jump");
  expect_same(scene_of(at_tetrahedra(mesh, 0)), "in tetrahedra");
  expect_same(scene_of(at_tetrahedra(mesh, 0), true), "in tetrahedra, with a jump");
}

TEST(MeshPackets, PassThroughVacuum) {
  const MeshPointer mesh = bent(6);
  expect_same(scene_of(with_holes(mesh, 17)), "holes at points");
  expect_same(scene_of(at_tetrahedra(mesh, 7)), "holes in tetrahedra");
}

TEST(MeshPackets, BeginWhereTheEyeIs) {
  Scene scene = scene_of(at_points(bent(6)));
  for (const Place& eye : {Place{3.1, 2.9, 3.3}, Place{3, 3, 3}, Place{0.4, 5.5, 1}}) {
    scene.camera.position = eye;
    scene.camera.focal_point = eye + Place{0.3, 1, -0.4};
    expect_same(scene, "eye inside");
  }
}

/// Along the edges of the cubes and the diagonals of their faces, and with parallel rays.
TEST(MeshPackets, GoThroughEdgesAndPoints) {
  Scene scene = scene_of(at_points(std::make_shared<const TetrahedralMesh>(lattice_mesh(6, 4))));
  for (const Place& from : {Place{0, 0, 20}, Place{20, 0, 0}, Place{20, 0, 20}}) {
    scene.camera.position = scene.camera.focal_point + from;
    scene.camera.up = {0, 1, 0};
    expect_same(scene, "along the lattice");
  }
}

/// More hits than a lane has room for: such rays are for the scalar tracer.
TEST(MeshPackets, LeaveCrowdedRaysToTheScalarTracer) {
  Scene scene = scene_of(at_points(walls(40)));
  scene.camera.position = scene.camera.focal_point + Place{-90, 0.7, 0.4};
  // Rays that meet all eighty faces beside such as miss them all.
  scene.camera.up = {0, 0, 1};
  expect_same(scene, "walls");
  RenderReport report;
  const Image image = rendered(scene, InstructionSet::scalar, report);
  EXPECT_EQ(image.at(0, 0)[3], 0.0f);
}

TEST(MeshPackets, TakeAnyNumberOfRays) {
  Scene scene = scene_of(at_points(bent(4)));
  for (const ImageSize size :
       {ImageSize{1, 1}, ImageSize{17, 1}, ImageSize{1, 17}, ImageSize{5, 3}}) {
    scene.size = size;
    expect_same(scene, std::to_string(size.width) + " × " + std::to_string(size.height));
  }
}

TEST(MeshPackets, AreTheSameToTheBitForAnyNumberOfThreads) {
  const Scene scene = scene_of(at_points(bent(6)), true);
  for (const InstructionSet set : instruction_sets) {
    if (!test::runs_here(set)) continue;
    RenderReport report;
    const Image one = rendered(scene, set, report, 1);
    for (const int threads : {2, 3, 7}) {
      const Image other = rendered(scene, set, report, threads);
      EXPECT_TRUE(one.pixels == other.pixels) << name_of(set) << ", " << threads;
      EXPECT_TRUE(one.error == other.error) << name_of(set) << ", " << threads;
    }
  }
}

/// A component that lies inside of another overlaps it: no ray that meets both is taken for proved.
TEST(MeshPackets, SayWhereComponentsAreInsideOfOthers) {
  TetrahedralMesh::Description both = lattice_mesh(6, 3);
  const TetrahedralMesh::Description inner = lattice_mesh(1, 4);
  const auto first = static_cast<std::int32_t>(both.points.size());
  for (const Place& p : inner.points) both.points.push_back(p + Place{2.6, 2.7, 2.4});
  for (auto t : inner.tetrahedra) {
    for (std::int32_t& corner : t) corner += first;
    both.tetrahedra.push_back(t);
  }
  Scene scene = scene_of(at_points(std::make_shared<const TetrahedralMesh>(std::move(both))));
  test::mesh_of(scene).transfer_function = std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 0.01, {1, 1, 1}}, {1, 0.02, {1, 1, 1}}});
  scene.camera.position = Place{3.1, 3.2, -20};
  scene.camera.focal_point = Place{3.1, 3.2, 2.9};
  scene.camera.up = {0, 1, 0};
  for (const InstructionSet set : instruction_sets) {
    if (!test::runs_here(set)) continue;
    RenderReport report;
    const Image image = rendered(scene, set, report);
    const std::size_t middle = static_cast<std::size_t>(11 * scene.size.width + 14);
    EXPECT_GT(image.error[middle], 0.1f) << name_of(set);
    EXPECT_GT(report.pixels_over_tolerance, 0u) << name_of(set);
    EXPECT_LT(image.error[0], 1e-2f) << name_of(set);
  }
}

/// Meshes of any size: in units a billion times as large.
TEST(MeshPackets, TakeTinyMeshes) {
  constexpr double small = 1e-9;
  TetrahedralMesh::Description mesh = lattice_mesh(6, 3);
  std::vector<float> values;
  for (Place& p : mesh.points) {
    values.push_back(static_cast<float>(wave(p)));
    p = small * p;
  }
  const auto pointer = std::make_shared<const TetrahedralMesh>(std::move(mesh));
  Scene scene = scene_of(std::make_shared<const MeshChannels>(
      pointer, std::vector<MeshChannel>{{"f", "", Centering::point, std::move(values)}}));
  std::vector<TransferFunction::Point> points = test::mesh_of(scene).univariate()->points();
  for (TransferFunction::Point& p : points) p.extinction /= small;
  test::mesh_of(scene).transfer_function =
      std::make_shared<const TransferFunction>(std::move(points));
  expect_same(scene, "a billionth");
}

/// What is compared above is not the same code twice.
TEST(MeshPackets, DoMostOfTheWorkInBinary32) {
  const InstructionSet set = test::narrowest_set();
  if (!PELLUCID_HAS_PACKETS || set == InstructionSet::scalar) GTEST_SKIP() << "no packets";
  const Scene scene = scene_of(at_points(bent(6)));
  RenderReport scalar, packets;
  rendered(scene, InstructionSet::scalar, scalar);
  rendered(scene, set, packets);
  EXPECT_EQ(scalar.spans.in_double, scalar.spans.closed);
  EXPECT_GT(packets.spans.closed, 1000u);
  EXPECT_LT(packets.spans.in_double, packets.spans.closed / 10);
}

}  // namespace
}  // namespace pellucid::test_mesh_packets
