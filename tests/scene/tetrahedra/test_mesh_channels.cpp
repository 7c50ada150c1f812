// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/mesh_channels.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/scene/expect_error.h"

namespace pellucid::test_mesh_channels {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Three tetrahedra in a row, of six points, and a seventh (number 3) that none uses.
std::shared_ptr<const TetrahedralMesh> mesh() {
  return std::make_shared<const TetrahedralMesh>(TetrahedralMesh::Description{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}, {0, 0, 1}, {1, 1, 1}, {1, 1, 3}},
      {{0, 1, 2, 4}, {1, 2, 4, 5}, {2, 4, 5, 6}},
      "row.vtu"});
}

MeshChannel at_points(const std::string& name, std::vector<float> values) {
  return {name, "", Centering::point, std::move(values)};
}

MeshChannel at_tetrahedra(const std::string& name, std::vector<float> values) {
  return {name, "", Centering::cell, std::move(values)};
}

void expect_refused(std::vector<MeshChannel> list, std::initializer_list<const char*> parts) {
  expect_error([&] { const MeshChannels channels(mesh(), std::move(list)); }, parts);
}

TEST(MeshChannels, KeepTheirOrderNamesAndValues) {
  const MeshChannels channels(
      mesh(), {at_tetrahedra("p", {7, 8, 9}),
               {"t", "K", Centering::point, std::vector<std::uint8_t>{0, 1, 2, 200, 4, 5, 6}}});
  EXPECT_EQ(channels.count(), 2);
  EXPECT_EQ(channels.find("t"), 1);
  EXPECT_EQ(channels.find("T"), std::nullopt);
  EXPECT_EQ(channels.value(0, 2), 9);
  EXPECT_EQ(channels.value(1, 5), 5);
  EXPECT_EQ(channels[1].unit, "K");
  EXPECT_EQ(channels.vacuum_count(), 0U);
}

TEST(MeshChannels, StatisticsAreOfValuesThatTetrahedraUse) {
  const MeshChannels channels(
      mesh(), {at_points("a", {2, -1, 3, infinity, 4, 5, 4}),
               at_points("b", {2, 2, 2, nan, nan, 2, 2}), at_tetrahedra("c", {1, nan, 3})});
  EXPECT_EQ(channels.statistics(0).minimum, -1);
  EXPECT_EQ(channels.statistics(0).maximum, 5);
  EXPECT_EQ(channels.statistics(0).finite, 6U);
  EXPECT_EQ(channels.statistics(0).infinite, 0U);
  EXPECT_EQ(channels.statistics(1).nan, 1U);
  EXPECT_EQ(channels.statistics(1).finite, 5U);
  EXPECT_EQ(channels.statistics(2).nan, 1U);
  EXPECT_EQ(channels.statistics(2).maximum, 3);
}

TEST(MeshChannels, ATetrahedronWithNanInAnyChannelIsVacuum) {
  const auto vacuum = [](std::vector<MeshChannel> list) {
    return MeshChannels(mesh(), std::move(list)).vacuum_count();
  };
  EXPECT_EQ(vacuum({at_points("a", {nan, 0, 0, 0, 0, 0, 0})}), 1U);
  EXPECT_EQ(vacuum({at_points("a", {0, 0, nan, 0, 0, 0, 0})}), 3U);
  EXPECT_EQ(vacuum({at_points("a", {0, 0, 0, nan, 0, 0, 0})}), 0U);
  EXPECT_EQ(vacuum({at_tetrahedra("a", {0, nan, 0})}), 1U);
  EXPECT_EQ(vacuum({at_points("a", {nan, 0, 0, 0, 0, 0, 0}), at_tetrahedra("b", {nan, 0, nan})}),
            2U);
}

TEST(MeshChannels, RefusesWhatCannotBe) {
  const MeshChannel good = at_tetrahedra("a", {1, 2, 3});
  expect_error([&] { const MeshChannels channels(nullptr, {good}); }, {"there is none"});
  expect_refused({}, {"row.vtu", "there is no channel"});
  expect_refused(std::vector<MeshChannel>(9, good), {"9 channels", "at most 8"});
  expect_refused({at_tetrahedra("", {1, 2, 3})}, {"channel 0 has no name"});
  expect_refused({good, good}, {"two channels have the name \"a\""});
  expect_refused({at_tetrahedra("a", {1, 2})}, {"\"a\" has 2 values", "3 tetrahedra"});
  expect_refused({at_points("a", {1, 2, 3})}, {"\"a\" has 3 values", "7 points"});
  expect_refused({at_points("a", {0, 0, 0, infinity, 0, -infinity, infinity})},
                 {"\"a\" has 2 infinite values, the first at point 5"});
  expect_refused(
      {at_tetrahedra("a", {0, 0, infinity})},
      {"\"a\" has 1 infinite value, the first at the tetrahedron of points 2, 4, 5 and 6"});
  expect_refused({at_points("a", {0, 0, 0, -3e38F, -3e37F, 0, 0})},
                 {"the value at point 4 is beyond"});
}

}  // namespace
}  // namespace pellucid::test_mesh_channels
