// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "pellucid/io/read_mesh.h"
#include "pellucid/scene/tetrahedralize.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/meshes.h"
#include "tests/support/test_data.h"

namespace pellucid::scenes {
namespace {

using Place = Vec3<double>;

constexpr double turn = 2 * std::numbers::pi;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Exhibit exhibit(MeshChannelsPointer mesh, Points points) {
  Exhibit result;
  result.cameras = three_cameras(mesh->mesh().bounds());
  result.mesh = std::move(mesh);
  result.transfer_function = transfer(std::move(points));
  return result;
}

Exhibit exhibit(MeshChannelsPointer mesh, std::vector<GaussianPrimitive> primitives,
                std::vector<ChannelTransferFunction> tables = {}) {
  Exhibit result;
  result.cameras = three_cameras(mesh->mesh().bounds());
  const int count = mesh->count();
  result.mesh = std::move(mesh);
  result.multivariate = std::make_shared<const MultivariateTransferFunction>(
      count, std::move(primitives), std::move(tables));
  return result;
}

GaussianPrimitive gaussian(std::vector<ChannelRef> channels, std::vector<double> center,
                           std::vector<std::vector<double>> matrix, double extinction,
                           Rgb<double> color) {
  return {std::move(channels), std::move(center), std::move(matrix), extinction, color};
}

/// In [0, 1] within [-1,1]³.
double wave(const Place& p) {
  return 0.5 + 0.28 * std::sin(2 * p.x + 1.7 * p.y) * std::cos(2.1 * p.z - 0.4) +
         0.2 * std::sin(1.3 * p.y - p.z);
}

double other_wave(const Place& p) {
  return 0.5 + 0.3 * std::cos(1.9 * p.x - 0.7 * p.z) + 0.19 * std::sin(2.3 * p.y + p.x);
}

/// Broad ramps with a peak, opacity and color at points of their own.
Points ramps() {
  return {{0.1, 0, {0.1, 0.2, 0.8}}, {0.3, 0.6, {0.2, 0.7, 0.9}},  {0.45, 0.2, {0.3, 0.9, 0.4}},
          {0.5, 2.5, {1, 0.8, 0.2}}, {0.55, 0.2, {0.9, 0.3, 0.3}}, {0.8, 1.5, {0.9, 0.1, 0.5}},
          {0.95, 0, {0.8, 0.8, 0.8}}};
}

MeshChannelsPointer with_field(TetrahedralMesh::Description mesh, const PlaceFunction& f) {
  const MeshPointer pointer = make_mesh(std::move(mesh));
  return on_mesh(pointer, {at_points(*pointer, "field", f)});
}

Exhibit linear_field(int) {
  return exhibit(
      with_field(box_of_cubes(6),
                 [](const Place& p) { return 0.5 + 0.21 * p.x - 0.13 * p.y + 0.15 * p.z; }),
      ramps());
}

Exhibit smooth_field(int) {
  return exhibit(with_field(box_of_cubes(10), wave), ramps());
}

/// Rays along the edges of the cubes, in their faces and the diagonals of these, through points and
/// out of one; none in the boundary, where there is no telling in from out.
Exhibit along_the_axes(int size) {
  constexpr int n = 17;
  const MeshChannelsPointer mesh =
      with_field(tetrahedralize({{n, n, n},
                                 [](int i, int j, int k) {
                                   return Place{1.0 * i, 1.0 * j, 1.0 * k};
                                 }}),
                 [](const Place& p) {
                   return wave(p * (2.0 / n) - Place{1, 1, 1});
                 });
  Points points = ramps();
  for (TransferFunction::Point& p : points) p.extinction *= 0.2;
  Exhibit result = exhibit(mesh, std::move(points));
  // Pixels at odd multiples of a half, of a sixth, … of a cube from the centre.
  const double scale = scale_of_pixels(size, 8.0 / size);
  result.cameras = {{"along z", parallel_camera({8.5, 8.5, 40}, {0, 0, -1}, scale)},
                    {"along x", parallel_camera({-30, 8.5, 8.5}, {1, 0, 0}, scale, {0, 0, 1})},
                    {"out of a point", perspective_camera({9, 8, 7}, {9, 8, 0}, 100)}};
  return result;
}

Exhibit delaunay(int) {
  return exhibit(with_field(random_delaunay(400, 7), wave), ramps());
}

/// Delaunay's, pressed flat: slivers of a thousandth of their length.
Exhibit pressed_slivers(int) {
  TetrahedralMesh::Description mesh = random_delaunay(250, 11);
  for (Place& p : mesh.points) p = {p.x + 0.2 * p.z, p.y, 1e-3 * p.z + 0.3 * p.x};
  return exhibit(with_field(std::move(mesh), wave), [] {
    Points points = ramps();
    for (TransferFunction::Point& p : points) p.extinction *= 3;
    return points;
  }());
}

/// A ring of `cubes` around the axis z.
TetrahedralMesh::Description ring(std::array<int, 3> cubes, double inner, double outer,
                                  double height, const Place& centre) {
  Lattice lattice;
  lattice.cubes = cubes;
  lattice.closed = true;
  lattice.place = [=](int i, int j, int k) {
    const double angle = turn * i / cubes[0];
    const double radius = inner + (outer - inner) * j / cubes[1];
    const double z = height * (1.0 * k / cubes[2] - 0.5);
    return centre + Place{radius * std::cos(angle), radius * std::sin(angle), z};
  };
  return tetrahedralize(lattice);
}

/// One goes through the other and does not touch it; a piece is missing from it.
Exhibit two_rings(int) {
  TetrahedralMesh::Description first = ring({24, 3, 3}, 0.5, 0.9, 0.4, {0, 0, 0});
  TetrahedralMesh::Description second = ring({20, 2, 3}, 0.35, 0.55, 0.3, {0, 0, 0});
  for (Place& p : second.points) p = {p.x + 0.9 * 0.75, p.z, p.y};
  std::erase_if(second.tetrahedra, [](const auto& t) { return t[0] % 20 < 3; });
  return exhibit(with_field(joined(std::move(first), second), wave), [] {
    Points points = ramps();
    for (TransferFunction::Point& p : points) p.extinction *= 3;
    return points;
  }());
}

/// Hollow, with holes; the last camera stands inside of the hollow.
Exhibit shell(int) {
  Lattice lattice;
  lattice.cubes = {26, 12, 2};
  lattice.closed = true;
  lattice.place = [](int i, int j, int k) {
    const double longitude = turn * i / 26, latitude = 0.47 * turn * (j / 12.0 - 0.5);
    const double radius = 0.8 + 0.1 * k;
    return Place{radius * std::cos(latitude) * std::cos(longitude),
                 radius * std::cos(latitude) * std::sin(longitude), radius * std::sin(latitude)};
  };
  lattice.keep = [](int i, int j, int k) { return (5 * i + 3 * j + 2 * k) % 11 > 1; };
  return exhibit(with_field(tetrahedralize(lattice), wave), [] {
    Points points = ramps();
    for (TransferFunction::Point& p : points) p.extinction *= 6;
    return points;
  }());
}

Exhibit constant_cells(int) {
  const MeshPointer mesh = make_mesh(random_delaunay(300, 3));
  return exhibit(on_mesh(mesh, {at_cells(*mesh, "field", wave)}), ramps());
}

/// NaN at points, and in cells.
Exhibit vacuum(int) {
  const MeshPointer mesh = make_mesh(random_delaunay(500, 5));
  const auto holes = [](const Place& p) {
    return std::abs(std::sin(17 * p.x) + std::cos(23 * p.y) + std::sin(11 * p.z)) < 0.25;
  };
  std::vector<MeshChannel> channels{
      at_points(*mesh, "points", [&](const Place& p) { return holes(p) ? nan : wave(p); }),
      at_cells(*mesh, "cells", [&](const Place& p) { return holes(p) ? nan : other_wave(p); })};
  return exhibit(on_mesh(mesh, std::move(channels)), {},
                 {{0, TransferFunction(ramps())},
                  {1, TransferFunction({{0.3, 0, {0, 1, 0}}, {0.7, 2, {1, 1, 0}}})}});
}

Exhibit two_variables(int) {
  const MeshPointer mesh = make_mesh(box_of_cubes(8));
  return exhibit(
      on_mesh(mesh, {at_points(*mesh, "first", wave), at_points(*mesh, "second", other_wave)}),
      {gaussian({0, 1}, {0.5, 0.5}, matrix_from_widths({0.02, 0.3}), 20, {1, 0.5, 0.1}),
       gaussian({0, 1}, {0.35, 0.6}, matrix_from_widths({0.2, 0.01}), 30, {0.1, 0.5, 1}),
       gaussian({1}, {0.4}, {{3}}, 0.4, {0.3, 1, 0.4})});
}

/// Linear data over three variables, one of them constant in the cells: turned and rank-deficient
/// Gaussians, and a table.
Exhibit three_variables(int) {
  const MeshPointer mesh = make_mesh(random_delaunay(250, 13));
  return exhibit(
      on_mesh(mesh, {at_points(*mesh, "first", wave), at_points(*mesh, "second", other_wave),
                     at_cells(*mesh, "third", [](const Place& p) { return 100 + 50 * p.z; })}),
      {gaussian({0, 1}, {0.5, 0.45}, {{30, -40}, {15, -20}}, 8, {1, 0.5, 0}),
       gaussian({0, 1, 2}, {0.4, 0.6, 110}, {{6, 4, 0}, {-4, 6, 0.01}, {0, 0.3, 0.02}}, 5,
                {0, 0.5, 1}),
       gaussian({2, 0}, {80, 0.5}, matrix_from_widths({20, 0.004}), 40, {0.4, 1, 0.4})},
      {{1, TransferFunction({{0.5, 0, {1, 0, 1}}, {0.55, 1, {1, 1, 1}}, {0.6, 0, {1, 1, 1}}})}});
}

/// Features of a 500th of the range and of a 50,000th.
Exhibit spikes(int) {
  return exhibit(with_field(box_of_cubes(7), wave), {{0.1, 0.05, {0.2, 0.3, 0.8}},
                                                     {0.499, 0.1, {0.3, 0.6, 0.8}},
                                                     {0.5, 80, {1, 0.7, 0.1}},
                                                     {0.501, 0.1, {0.3, 0.8, 0.6}},
                                                     {0.62, 0.1, {0.5, 0.6, 0.4}},
                                                     {0.62001, 5e3, {0.9, 0.1, 0.9}},
                                                     {0.62002, 0.1, {0.5, 0.5, 0.5}},
                                                     {0.9, 0.3, {1, 1, 1}}});
}

Exhibit jumps(int) {
  return exhibit(with_field(random_delaunay(300, 17), wave), {{0.3, 0, {0, 0, 0}},
                                                              {0.3, 1.2, {0.1, 0.4, 1}},
                                                              {0.5, 0.4, {0.1, 1, 0.6}},
                                                              {0.5, 3, {1, 0.2, 0.1}},
                                                              {0.56, 3, {1, 0.9, 0.1}},
                                                              {0.56, 0, {1, 1, 1}},
                                                              {0.7, 0, {1, 1, 1}},
                                                              {0.7, 9, {0.7, 0.1, 0.9}}});
}

/// Up to a million depths in a tetrahedron, a veil in front.
Exhibit deep(int) {
  return exhibit(with_field(random_delaunay(300, 19), wave), {{0.2, 0.2, {0.3, 0.4, 0.9}},
                                                              {0.45, 0.3, {0.2, 0.9, 0.3}},
                                                              {0.55, 3e3, {0.9, 0.5, 0.1}},
                                                              {0.6, 1e6, {1, 0.1, 0.1}},
                                                              {0.8, 4e6, {1, 1, 1}}});
}

Exhibit bright_colors(int) {
  Points points = ramps();
  for (TransferFunction::Point& p : points) p.color = p.color * 50;
  return exhibit(with_field(random_delaunay(300, 23), wave), std::move(points));
}

/// A million and a hundredth of it.
Exhibit far_from_zero(int) {
  Points points = ramps();
  for (TransferFunction::Point& p : points) p.value = 1e6 + 0.01 * (2 * p.value - 1);
  return exhibit(with_field(random_delaunay(300, 29),
                            [](const Place& p) { return 1e6 + 0.01 * (2 * wave(p) - 1); }),
                 std::move(points));
}

/// The same picture in other units, somewhere else.
Exhibit scaled(double unit, const Place& origin) {
  TetrahedralMesh::Description mesh = random_delaunay(300, 31);
  for (Place& p : mesh.points) p = origin + p * unit;
  Points points = ramps();
  for (TransferFunction::Point& p : points) p.extinction /= unit;
  return exhibit(
      with_field(std::move(mesh), [=](const Place& p) { return wave((p - origin) * (1 / unit)); }),
      std::move(points));
}

Exhibit tiny(int) {
  return scaled(1e-5, {0, 0, 0});
}

Exhibit huge(int) {
  return scaled(1e6, {3e6, -1e6, 2e6});
}

/// Coordinates of six of their digits alike.
Exhibit far_away(int) {
  return scaled(1, {1e6, -2e6, 5e5});
}

/// Simulations and what comes with VTK (the data folder beside the sources), by an array of theirs.
struct RealMesh {
  const char *name, *file, *array;
  double extinction;  ///< times the size of the mesh: largest
  /// As that of GalleryEntry. The can is crushed into itself: rays there cannot know.
  double min_tolerance = 0;
};

constexpr RealMesh real_meshes[] = {
    {"post", "post.vtk", "Pressure", 6},
    {"aneurysm", "output_fem.vtu", "Umag", 40},
    {"disk", "disk_out_ref.ex2", "Temp", 8},
    {"crushed can", "can.vtu", "EQPS", 40, 2},
    {"hexahedra", "hexa.vtk", "scalars", 5},
    {"96 tetrahedra", "Tetrahedron.vtu", "", 5},
    {"notch", "notch_disp.vtu", "displacement", 10},
};

GalleryEntry entry_of(const RealMesh& real) {
  const std::filesystem::path file = test_data_folder() / "unstructured" / real.file;
  const auto make = [=](int) {
    const MeshFile read = read_mesh(file);
    const bool there = std::any_of(read.grid.arrays.begin(), read.grid.arrays.end(),
                                   [&](const MeshArray& a) { return a.name == real.array; });
    MeshArrayChoice choice;
    choice.array = there ? real.array : default_array(read).name;
    choice.name = "field";
    const MeshChannelsPointer mesh = cut_into_tetrahedra(read.grid, std::vector{choice});
    // The ramps over the range of the data, their depth by the size of the mesh.
    const VolumeStatistics& range = mesh->statistics(0);
    const Box<double>& box = mesh->mesh().bounds();
    const double unit = length(box.upper - box.lower) / real.extinction;
    Points points = ramps();
    for (TransferFunction::Point& p : points) {
      p.value = range.minimum + p.value * (range.maximum - range.minimum);
      p.extinction /= unit;
    }
    return exhibit(mesh, std::move(points));
  };
  return {std::string("mesh: ") + real.name, make, file, real.min_tolerance};
}

}  // namespace

Gallery mesh_gallery() {
  Gallery entries{
      {"tetrahedra, linear field", linear_field},
      {"tetrahedra, smooth field", smooth_field},
      {"tetrahedra along the axes", along_the_axes},
      {"Delaunay's tetrahedra", delaunay},
      {"Delaunay's tetrahedra, pressed to slivers", pressed_slivers},
      {"two rings of tetrahedra", two_rings},
      {"a shell of tetrahedra with holes", shell},
      {"tetrahedra of constant data", constant_cells},
      {"tetrahedra, vacuum at points and in cells", vacuum},
      {"Gaussians over two variables of tetrahedra", two_variables},
      {"Gaussians and a table over three variables of tetrahedra", three_variables},
      {"tetrahedra, spikes of 1/500 and 1/50000 of the range", spikes, {}, 1e-3},
      {"tetrahedra, jumps", jumps},
      {"tetrahedra of a million depths", deep, {}, 1e-5},
      {"tetrahedra, colors of 50", bright_colors, {}, 1e-5},
      {"tetrahedra, data of a million and a hundredth", far_from_zero, {}, 1e-4},
      {"tetrahedra of 1e-5 units", tiny},
      {"tetrahedra of a million units", huge},
      {"tetrahedra a million units away", far_away, {}, 1e-4},
  };
  for (const RealMesh& real : real_meshes) entries.push_back(entry_of(real));
  return entries;
}

}  // namespace pellucid::scenes
