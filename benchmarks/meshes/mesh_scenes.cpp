// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/meshes/mesh_scenes.h"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "benchmarks/support/document.h"
#include "benchmarks/vtk/delaunay.h"
#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/tetrahedralize.h"
#include "tests/scenes/peers.h"
#include "tests/support/one_layer.h"

namespace pellucid::bench {
namespace {

/// The formula of scene/builtin_fields.h, for points that are on no grid.
double marschner_lobb(const Vec3<double>& p) {
  constexpr double pi = std::numbers::pi;
  const double r = std::hypot(p.x, p.y);
  return ((1 - std::sin(pi * p.z / 2)) + 0.25 * (1 + std::cos(12 * pi * std::cos(pi * r / 2)))) /
         2.5;
}

UnstructuredGrid delaunay_grid(int count) {
  std::mt19937 random(1);
  const auto draw = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  std::vector<Vec3<double>> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double x = draw(), y = draw();
    points.push_back({x, y, draw()});
  }
  UnstructuredGrid grid;
  grid.name = "Delaunay";
  grid.corners = delaunay_tetrahedra(points);
  grid.shapes.assign(grid.corners.size() / 4, CellShape::tetrahedron);
  std::vector<float> values;
  values.reserve(points.size());
  for (const Vec3<double>& p : points) values.push_back(static_cast<float>(marschner_lobb(p)));
  grid.points = std::move(points);
  grid.arrays.push_back({"value", Centering::point, 1, DataArray<float>(std::move(values))});
  return grid;
}

MeshSource grid_source(int points, bool large) {
  return {format("grid %d³", points),
          [=] { return to_unstructured(make_builtin_field("marschner_lobb", points)); }, large};
}

constexpr double peak_values[] = {0.3, 0.5, 0.7};
constexpr double half_width = 0.006, tip = 100;

scenes::TransferPointer ramp() {
  return scenes::transfer({{0.1, 0, {0.1, 0.2, 0.9}}, {1, 2, {1, 0.8, 0.2}}});
}

scenes::TransferPointer peaks() {
  const Rgb<double> colors[] = {{0.2, 0.4, 1}, {0.3, 0.9, 0.3}, {1, 0.5, 0.1}};
  scenes::Points points;
  for (std::size_t i = 0; i < 3; ++i) {
    points.push_back({peak_values[i] - half_width, 0, colors[i]});
    points.push_back({peak_values[i], tip, colors[i]});
    points.push_back({peak_values[i] + half_width, 0, colors[i]});
  }
  return scenes::transfer(std::move(points));
}

/// Colors that are linear over the whole range.
scenes::TransferPointer peaks_apart() {
  const auto color = [](double v) { return Rgb<double>{v, 0.5, 1 - v}; };
  scenes::Points points{{0, 0, color(0)}};
  for (const double v : peak_values) {
    points.push_back({v - half_width, 0, color(v - half_width)});
    points.push_back({v, tip, color(v)});
    points.push_back({v + half_width, 0, color(v + half_width)});
  }
  points.push_back({1, 0, color(1)});
  return scenes::transfer(std::move(points));
}

}  // namespace

std::vector<MeshSource> mesh_sources(bool tiny) {
  std::vector<MeshSource> list{grid_source(tiny ? 12 : 48, false)};
  if (has_delaunay()) {
    list.push_back({"Delaunay", [=] { return delaunay_grid(tiny ? 300 : 20000); }, false});
  }
  list.push_back(grid_source(tiny ? 16 : 128, true));
  return list;
}

std::vector<MeshScene> mesh_scenes(const MeshSource& source,
                                   const scenes::MeshChannelsPointer& mesh, ImageSize size) {
  using scenes::View;
  struct Shown {
    const char* name;
    scenes::TransferPointer transfer_function;
    bool colors_apart, also_of_large;
  };
  const Shown shown[] = {{"ramp", ramp(), false, true},
                         {"haze", scenes::haze_transfer(), false, false},
                         {"peaks", peaks(), false, true},
                         {"peaks between colors", peaks_apart(), true, false}};
  std::vector<MeshScene> list;
  for (const View view : {View::oblique, View::axis}) {
    for (const Shown& one : shown) {
      if (source.large && !one.also_of_large) continue;
      Scene scene;
      test::mesh_of(scene).mesh = mesh;
      test::mesh_of(scene).transfer_function = one.transfer_function;
      scene.camera = scenes::view_camera(view);
      scene.size = size;
      list.push_back({std::string(one.name) + ", " + scenes::view_name(view), std::move(scene),
                      one.colors_apart, view == View::axis});
    }
  }
  return list;
}

}  // namespace pellucid::bench
