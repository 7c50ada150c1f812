// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "mixed_mesh.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/tetrahedralize_step.h"
#include "quadratic_mesh.h"

namespace pellucid::test_tetrahedralize_step {
namespace {

const std::vector<MeshArrayChoice> all{{"p", {}, "p"}, {"v", {}, "length"}, {"c", 1, "c"}};

/// Gives a mesh arrays at points and cells, other ones for each seed.
UnstructuredGrid with_values(UnstructuredGrid grid, unsigned seed) {
  std::mt19937 random(seed);
  const auto numbers = [&](std::size_t count) {
    std::vector<float> values(count);
    for (float& value : values) value = static_cast<float>(random() % 1000);
    return values;
  };
  grid.name = "mesh";
  grid.arrays = {{"p", Centering::point, 1, numbers(grid.points.size())},
                 {"v", Centering::point, 3, numbers(3 * grid.points.size())},
                 {"c", Centering::cell, 2, numbers(2 * grid.shapes.size())}};
  return grid;
}

/// A mesh whose cut adds points.
UnstructuredGrid quadratic() {
  return QuadraticMesh(MixedMesh(3, 5, false).grid(), 3 * MixedMesh::side, 40, true, 6).grid();
}

/// A cube as a polyhedron beside a pyramid.
UnstructuredGrid polyhedral() {
  UnstructuredGrid g;
  g.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},  {0, 0, 1},
              {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {2, .5, .5}};
  g.shapes = {CellShape::polyhedron, CellShape::pyramid};
  g.corners = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6,
               5, 2, 3, 7, 6, 3, 0, 4, 7, 1, 2, 6, 5, 8};
  g.layouts = {24, 6, 4, 4, 4, 4, 4, 4};
  return g;
}

std::vector<double> values_of(const MeshChannels& mesh, int channel) {
  const std::size_t count = mesh[channel].centering == Centering::point
                                ? mesh.mesh().points().size()
                                : mesh.mesh().tetrahedra().size();
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = mesh.value(channel, i);
  return values;
}

TEST(CutSteps, ValuesAloneAreNew) {
  for (const UnstructuredGrid& cells :
       {MixedMesh(4, 1, false).grid(), MixedMesh(3, 2, true).grid(), quadratic(), polyhedral()}) {
    const auto first = tetrahedralize_step(with_values(cells, 1), all, nullptr);
    const auto second = tetrahedralize_step(with_values(cells, 2), all, first.get());
    const auto alone = cut_into_tetrahedra(with_values(cells, 2), all);
    EXPECT_EQ(second->shared_mesh(), first->shared_mesh());
    EXPECT_NE(alone->shared_mesh(), first->shared_mesh());
    EXPECT_EQ(second->mesh().statistics().cells, alone->mesh().statistics().cells);
    EXPECT_EQ(second->mesh().statistics().volume, alone->mesh().statistics().volume);
    EXPECT_EQ(second->mesh().points(), alone->mesh().points());
    for (std::size_t p = 0; p < alone->mesh().points().size(); ++p) {
      EXPECT_EQ(second->mesh().point_number(p), alone->mesh().point_number(p));
    }
    for (std::size_t t = 0; t < alone->mesh().tetrahedra().size(); ++t) {
      const Tetrahedron &a = second->mesh().tetrahedra()[t], &b = alone->mesh().tetrahedra()[t];
      EXPECT_TRUE(std::ranges::equal(a.corner, b.corner)) << t;
      EXPECT_TRUE(std::ranges::equal(a.neighbor, b.neighbor)) << t;
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ((*second)[c].name, (*alone)[c].name);
      EXPECT_EQ(values_of(*second, c), values_of(*alone, c)) << c;
      EXPECT_EQ(second->statistics(c).maximum, alone->statistics(c).maximum);
    }
  }
}

TEST(CutSteps, OtherArraysOfTheSameCellsAreTaken) {
  const UnstructuredGrid cells = quadratic();
  const std::vector<MeshArrayChoice> one{{"p", {}, "p"}}, other{{"c", 0, "c"}};
  const auto first = tetrahedralize_step(with_values(cells, 1), one, nullptr);
  const auto second = tetrahedralize_step(with_values(cells, 1), other, first.get());
  EXPECT_EQ(second->shared_mesh(), first->shared_mesh());
  EXPECT_EQ(values_of(*second, 0),
            values_of(*cut_into_tetrahedra(with_values(cells, 1), other), 0));
}

TEST(CutSteps, WhatDiffersByABitIsCut) {
  const UnstructuredGrid cells = with_values(polyhedral(), 1);
  const auto first = tetrahedralize_step(cells, all, nullptr);
  const std::vector<std::function<void(UnstructuredGrid&)>> changes{
      [](UnstructuredGrid& g) { g.points[8].x = std::nextafter(2.0, 3.0); },
      [](UnstructuredGrid& g) { g.points[0].y = -0.0; },
      [](UnstructuredGrid& g) {
        g.points.push_back({5, 5, 5});
        g.arrays.erase(g.arrays.begin(), g.arrays.begin() + 2);
        g.arrays.push_back({"p", Centering::point, 1, std::vector<float>(10, 1)});
        g.arrays.push_back({"v", Centering::point, 3, std::vector<float>(30, 1)});
      },
      [](UnstructuredGrid& g) { std::swap(g.corners[24], g.corners[26]); },
      [](UnstructuredGrid& g) {
        g.cell_numbers = {1, 0};
      },
      [](UnstructuredGrid& g) { g.name = "another"; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    UnstructuredGrid changed = cells;
    changes[i](changed);
    const auto second = tetrahedralize_step(changed, all, first.get());
    EXPECT_NE(second->shared_mesh(), first->shared_mesh()) << i;
    const auto alone = cut_into_tetrahedra(changed, all);
    EXPECT_EQ(second->mesh().name(), alone->mesh().name());
    EXPECT_EQ(second->mesh().points(), alone->mesh().points());
    for (int c = 0; c < 3; ++c) EXPECT_EQ(values_of(*second, c), values_of(*alone, c)) << i;
  }
  // Of a mesh whose cut was not kept nothing is taken.
  const auto plain = cut_into_tetrahedra(cells, all);
  const auto second = tetrahedralize_step(cells, all, plain.get());
  EXPECT_NE(second->shared_mesh(), plain->shared_mesh());
}

TEST(CutSteps, LiveAsLongAsAnyStep) {
  const UnstructuredGrid cells = quadratic();
  auto mesh = tetrahedralize_step(with_values(cells, 1), all, nullptr);
  for (unsigned step = 2; step < 5; ++step) {
    mesh = tetrahedralize_step(with_values(cells, step), all, mesh.get());
  }
  EXPECT_EQ(values_of(*mesh, 1), values_of(*cut_into_tetrahedra(with_values(cells, 4), all), 1));
}

TEST(CutSteps, ArraysThatDoNotFitAreRefused) {
  const UnstructuredGrid cells = with_values(polyhedral(), 1);
  const auto first = tetrahedralize_step(cells, all, nullptr);
  const auto error_of = [&](const std::function<void(UnstructuredGrid&)>& change) {
    UnstructuredGrid changed = cells;
    change(changed);
    try {
      tetrahedralize_step(changed, all, first.get());
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(error_of([](auto& g) { g.arrays.pop_back(); }).find("there is no array \"c\""),
            std::string::npos);
  EXPECT_NE(error_of([](auto& g) { g.arrays[0].values = std::vector<float>(3); }).find("\"p\""),
            std::string::npos);
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_NE(error_of([&](auto& g) {
              g.arrays[0].values = std::vector<float>(9, infinity);
            }).find("infinite"),
            std::string::npos);
}

}  // namespace
}  // namespace pellucid::test_tetrahedralize_step
