// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/scene/tetrahedralize.h"
#include "tests/scene/expect_error.h"

namespace pellucid::test_tetrahedra_arrays {
namespace {

/// A unit cube beside a pyramid: 10 points, 2 cells, with a few arrays.
UnstructuredGrid grid() {
  UnstructuredGrid g;
  g.name = "two.vtu";
  g.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},   {0, 0, 1},
              {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {2, .5, .5}, {9, 9, 9}};
  g.shapes = {CellShape::hexahedron, CellShape::pyramid};
  g.corners = {0, 1, 2, 3, 4, 5, 6, 7, 1, 2, 6, 5, 8};
  g.arrays = {
      {"t", Centering::point, 1, std::vector<std::uint8_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
      {"p", Centering::cell, 1, std::vector<double>{1.5, 2.5}},
      {"v", Centering::cell, 2, std::vector<std::int16_t>{3, 4, -5, 12}},
      {"both", Centering::cell, 1, std::vector<float>{1, 2}},
      {"both", Centering::point, 1, std::vector<float>(10, 3)},
  };
  return g;
}

std::shared_ptr<const MeshChannels> cut(const UnstructuredGrid& g,
                                        const std::vector<MeshArrayChoice>& choices) {
  return cut_into_tetrahedra(g, choices);
}

/// The value at the point that the grid calls by this number.
double value_at(const MeshChannels& channels, int channel, std::int32_t number) {
  for (std::size_t p = 0; p < channels.mesh().points().size(); ++p) {
    if (channels.mesh().point_number(p) == number) return channels.value(channel, p);
  }
  ADD_FAILURE() << "there is no point " << number;
  return 0;
}

TEST(TetrahedraArrays, PointsKeepTheirValuesAndTheirType) {
  const auto channels = cut(grid(), {{"t", {}, {}}});
  EXPECT_EQ((*channels)[0].name, "t");
  EXPECT_EQ((*channels)[0].centering, Centering::point);
  EXPECT_EQ(type_name((*channels)[0].values), "u8");
  const UnstructuredGrid given = grid();
  for (std::size_t p = 0; p < 10; ++p) {
    const std::int32_t number = channels->mesh().point_number(p);
    EXPECT_EQ(channels->value(0, p), static_cast<double>(number));
    EXPECT_EQ(channels->mesh().points()[p], given.points[static_cast<std::size_t>(number)]);
  }
  EXPECT_EQ(channels->mesh().statistics().unused_points, 1U);
  EXPECT_EQ(channels->statistics(0).maximum, 8);
  EXPECT_EQ(channels->mesh().name(), "two.vtu");
}

TEST(TetrahedraArrays, CellsGiveTheirValuesToTheirTetrahedra) {
  const auto channels =
      cut(grid(), {{"p", {}, "pressure"}, {"v", 1, "v1"}, {"v", {}, "length of v"}});
  const auto& mesh = channels->mesh();
  EXPECT_EQ((*channels)[0].name, "pressure");
  EXPECT_EQ(type_name((*channels)[1].values), "i16");
  EXPECT_EQ(type_name((*channels)[2].values), "f32");
  std::size_t of_pyramid = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra().size(); ++t) {
    bool pyramid = false;  // only it has the point
    for (const std::int32_t p : mesh.tetrahedra()[t].corner) {
      pyramid = pyramid || mesh.point_number(static_cast<std::size_t>(p)) == 8;
    }
    of_pyramid += pyramid ? 1 : 0;
    EXPECT_EQ(channels->value(0, t), pyramid ? 2.5 : 1.5);
    EXPECT_EQ(channels->value(1, t), pyramid ? 12 : 4);
    EXPECT_EQ(channels->value(2, t), pyramid ? 13 : 5);
  }
  EXPECT_EQ(of_pyramid, 2U);
}

TEST(TetrahedraArrays, OfTwoOfOneNameThatOfPointsIsTaken) {
  EXPECT_EQ((*cut(grid(), {{"both", {}, {}}}))[0].centering, Centering::point);
}

// Where a quadratic cell has NaN at a node, the new points that depend on it are vacuum too.
TEST(TetrahedraArrays, LengthsAreThoseOfTheVectorsBetween) {
  UnstructuredGrid g;
  g.shapes = {CellShape::quadratic_pyramid};
  g.points = {{0, 0, 0},    {2, 0, 0},     {2, 2, 0},   {0, 2, 0}, {1, 1, 2},
              {1, 0, 0},    {2, 1, 0},     {1, 2, 0},   {0, 1, 0}, {.5, .5, 1},
              {1.5, .5, 1}, {1.5, 1.5, 1}, {.5, 1.5, 1}};
  std::vector<float> turning, one(13, 1);
  for (std::int32_t i = 0; i < 13; ++i) {
    g.corners.push_back(i);
    // Outwards from the middle of the base, where the vectors cancel.
    const Vec3<double> p = g.points[static_cast<std::size_t>(i)];
    turning.push_back(static_cast<float>(p.x - 1));
    turning.push_back(static_cast<float>(p.y - 1));
  }
  one[3] = std::numeric_limits<float>::quiet_NaN();
  g.arrays = {{"turning", Centering::point, 2, turning}, {"one", Centering::point, 1, one}};
  const auto lengths = cut(g, {{"turning", {}, {}}});
  EXPECT_EQ(value_at(*lengths, 0, 13), 0);
  EXPECT_EQ(value_at(*lengths, 0, 0), static_cast<double>(std::sqrt(2.F)));
  const auto vacuum = cut(g, {{"one", {}, {}}});
  EXPECT_TRUE(std::isnan(value_at(*vacuum, 0, 13)));
  EXPECT_EQ(vacuum->statistics(0).nan, 2U);
  // All but the pyramid at the top touch the middle.
  EXPECT_EQ(vacuum->vacuum_count(), vacuum->mesh().tetrahedra().size() - 2);
}

// What is wrong is named as the file has it.
TEST(TetrahedraArrays, MessagesCallPointsAsTheGridDoes) {
  UnstructuredGrid g = grid();
  g.points[8].z = std::numeric_limits<double>::infinity();
  expect_error([&] { cut(g, {{"t", {}, {}}}); }, {"two.vtu: point 8 is (2, 0.5, inf)"});
  g = grid();
  std::vector<float> values(10, 1);
  // Point 1 comes behind point 6 on the curve, or before: the smallest number is named.
  values[1] = values[6] = values[4] = std::numeric_limits<float>::infinity();
  g.arrays = {{"t", Centering::point, 1, values}};
  expect_error([&] { cut(g, {{"t", {}, {}}}); }, {"the first at point 1"});
}

TEST(TetrahedraArrays, RefusesWhatIsNotThere) {
  const UnstructuredGrid g = grid();
  expect_error(
      [&] {
        cut(g, {{"T", {}, {}}});
      },
      {"two.vtu: there is no array \"T\"; it has \"t\", \"p\" (of cells)"});
  expect_error([&] { cut(g, {{"v", 2, {}}}); }, {"\"v\" has no component 2; choose from 0 to 1"});
  expect_error([&] { cut(g, {{"t", 1, {}}}); }, {"\"t\" has no component 1; its only one is 0"});
  expect_error([&] { cut(g, {{"v", -1, {}}}); }, {"no component -1"});
  expect_error([&] { cut(g, {}); }, {"there is no channel"});
  expect_error([&] { cut(g, {{"v", 0, {}}, {"v", 1, {}}}); }, {"two channels", "\"v\""});
  UnstructuredGrid bad = g;
  bad.arrays[0].values = std::vector<float>(9);
  expect_error([&] { cut(bad, {{"t", {}, {}}}); }, {"\"t\" has 9 values, but 10 points"});
  expect_error([&] { tetrahedralize(bad); }, {"\"t\" has 9 values"});
  bad = g;
  bad.arrays.clear();
  expect_error([&] { cut(bad, {{"t", {}, {}}}); }, {"there is no array \"t\"; it has none"});
}

}  // namespace
}  // namespace pellucid::test_tetrahedra_arrays
