// SPDX-License-Identifier: Apache-2.0
#include "view/slice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/error.h"
#include "view/layer_values.h"

namespace pellucid::view::slice_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A trilinear function is interpolated without error, along axes that are oblique too: each of its
/// terms has degree 1 along each axis of the grid.
double trilinear(const Vec3<double>& in_grid) {
  return 3 + 2 * in_grid.x - in_grid.y + 0.5 * in_grid.z + 0.25 * in_grid.x * in_grid.y -
         0.125 * in_grid.x * in_grid.y * in_grid.z;
}

/// Positions of the values, in the grid's own coordinates.
double coordinate(const Volume::Description& grid, std::size_t axis, int i) {
  const std::vector<double>& at = grid.coordinates[axis];
  if (at.empty()) return i;
  const auto n = static_cast<std::size_t>(i);
  return grid.centering == Centering::cell ? (at[n] + at[n + 1]) / 2 : at[n];
}

std::shared_ptr<const Volume> volume_of(const Volume::Description& grid) {
  std::vector<double> values;
  for (int k = 0; k < grid.dimensions[2]; ++k) {
    for (int j = 0; j < grid.dimensions[1]; ++j) {
      for (int i = 0; i < grid.dimensions[0]; ++i) {
        values.push_back(
            trilinear({coordinate(grid, 0, i), coordinate(grid, 1, j), coordinate(grid, 2, k)}));
      }
    }
  }
  return std::make_shared<const Volume>(grid, VolumeData(DataArray<double>(std::move(values))));
}

Layer layer_of(std::shared_ptr<const Volume> volume) {
  Layer layer;
  layer.content = VolumeContent{std::move(volume), {}};
  return layer;
}

Mat3<double> matrix(const Vec3<double>& x, const Vec3<double>& y, const Vec3<double>& z) {
  Mat3<double> result;
  result.column[0] = x;
  result.column[1] = y;
  result.column[2] = z;
  return result;
}

struct Case {
  const char* name;
  Volume::Description grid;
  Affine<double> transform{};
};

std::vector<Case> cases() {
  const double c = std::cos(0.3), s = std::sin(0.3);
  Volume::Description uniform;
  uniform.dimensions = {7, 6, 5};
  std::vector<Case> all{{"uniform", uniform}};
  const auto add = [&](const char* name, const auto& change) {
    all.push_back({name, uniform});
    change(all.back().grid);
  };
  add("anisotropic", [](auto& grid) { grid.placement = {{-3, 5, 1}, {0.5, 2, 3.25}, {}}; });
  add("flipped", [](auto& grid) {
    grid.placement = {{9, 8, 7}, {1, 1.5, 2}, matrix({-1, 0, 0}, {0, -1, 0}, {0, 0, 1})};
  });
  add("permuted", [](auto& grid) {
    grid.placement = {{9, 8, 7}, {1, 1.5, 2}, matrix({0, 0, -1}, {1, 0, 0}, {0, 1, 0})};
  });
  add("oblique", [&](auto& grid) {
    grid.placement = {{1, 2, 3}, {1, 1.5, 2}, matrix({c, s, 0}, {-s, c, 0.1}, {0.2, 0, 1})};
  });
  add("cells", [](auto& grid) { grid.centering = Centering::cell; });
  add("rectilinear", [](auto& grid) {
    grid.coordinates = {{{0, 1, 3, 3.5, 7, 8, 10}, {}, {-1, 0, 2, 2.5, 4}}};
  });
  add("rectilinear cells", [](auto& grid) {
    grid.centering = Centering::cell;
    grid.coordinates[1] = {0, 1, 1.5, 4, 6, 9, 9.5};
  });
  all.push_back({"transformed", uniform, {matrix({2, 0, 0}, {0, c, s}, {0, -s, c}), {4, 5, 6}}});
  return all;
}

/// Returns the value in closed form: of the position, which between the outermost values and the
/// faces of cells is that of the value; NaN outside of the box.
double expected(const Case& wanted, const Volume& volume, const Vec3<double>& world) {
  Vec3<double> at = volume.grid_from_world().point(inverse(wanted.transform).point(world));
  for (int a = 0; a < 3; ++a) {
    if (at[a] < volume.grid_lower()[a] || at[a] > volume.grid_upper()[a]) return nan;
    const auto n = static_cast<std::size_t>(a);
    at[a] = std::clamp(at[a], coordinate(wanted.grid, n, 0),
                       coordinate(wanted.grid, n, wanted.grid.dimensions[n] - 1));
  }
  return trilinear(at);
}

TEST(Slice, HasTheValuesOfATrilinearFunction) {
  for (const Case& wanted : cases()) {
    SCOPED_TRACE(wanted.name);
    Layer layer = layer_of(volume_of(wanted.grid));
    layer.transform = wanted.transform;
    const auto& volume = *std::get<VolumeContent>(layer.content).volume;
    Vec3<double> lower = world_corners(layer)[0], upper = lower;
    for (const Vec3<double>& corner : world_corners(layer)) {
      for (int a = 0; a < 3; ++a) {
        lower[a] = std::min(lower[a], corner[a]);
        upper[a] = std::max(upper[a], corner[a]);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      SlicePlane plane;
      plane.axis = axis;
      plane.position = lower[axis] + 0.37 * (upper[axis] - lower[axis]);
      const auto u = plane.column_axis(), v = plane.row_axis();
      plane.from = {lower[u] - 0.1, upper[v] + 0.1};  // rows go down
      plane.to = {upper[u] + 0.1, lower[v] - 0.1};
      plane.columns = 23;
      plane.rows = 19;
      std::vector<float> values(plane.count());
      LayerValues(layer).fill(0, plane, {}, values);
      int inside = 0;
      for (int row = 0; row < plane.rows; ++row) {
        for (int column = 0; column < plane.columns; ++column) {
          const double value = expected(wanted, volume, plane.at(column, row));
          const float found = values[static_cast<std::size_t>(row * plane.columns + column)];
          ASSERT_EQ(std::isnan(value), std::isnan(found)) << column << ", " << row;
          if (std::isnan(value)) continue;
          ++inside;
          ASSERT_NEAR(value, static_cast<double>(found), 1e-6 * (1 + std::abs(value)));
        }
      }
      EXPECT_GT(inside, 50);
    }
  }
}

TEST(Slice, HasValuesInTheMiddlesOfItsPixels) {
  const SlicePlane plane{1, 7, {0, 10}, {8, -2}, 4, 3};
  EXPECT_EQ(plane.at(0, 0), (Vec3<double>{1, 7, 8}));
  EXPECT_EQ(plane.at(3, 2), (Vec3<double>{7, 7, 0}));
}

TEST(Slice, TellsTheVoxelAtEachValue) {
  for (const Case& wanted : cases()) {
    SCOPED_TRACE(wanted.name);
    Layer layer = layer_of(volume_of(wanted.grid));
    layer.transform = wanted.transform;
    const auto& volume = *std::get<VolumeContent>(layer.content).volume;
    const LayerValues values(layer);
    for (const std::array<int, 3> voxel : {std::array{0, 0, 0}, {6, 5, 4}, {3, 1, 2}}) {
      Vec3<double> in_grid;
      for (int a = 0; a < 3; ++a) {
        const auto n = static_cast<std::size_t>(a);
        in_grid[a] = coordinate(wanted.grid, n, voxel[n]);
      }
      const Vec3<double> world = wanted.transform.point(volume.world_from_grid().point(in_grid));
      EXPECT_EQ(values.voxel_at(world), voxel);
      ASSERT_EQ(values.at(world).size(), 1U);
      EXPECT_NEAR(values.at(world)[0], trilinear(in_grid), 1e-9);
    }
    EXPECT_FALSE(values.voxel_at({1e6, 0, 0}));
  }
}

TEST(Slice, LeavesVacuumOut) {
  Volume::Description grid;
  grid.dimensions = {3, 3, 3};
  std::vector<float> data(27, 1.0F);
  data[0] = static_cast<float>(nan);
  Layer layer = layer_of(std::make_shared<const Volume>(grid, VolumeData(data)));
  SlicePlane plane{2, 0.5, {0, 0}, {2, 2}, 4, 4};
  std::vector<float> values(16);
  LayerValues(layer).fill(0, plane, {}, values);
  for (int i = 0; i < 16; ++i) {
    EXPECT_EQ(std::isnan(values[static_cast<std::size_t>(i)]), i % 4 < 2 && i / 4 < 2) << i;
  }
  // Channels share their vacuum.
  const auto whole = std::make_shared<const Volume>(grid, VolumeData(std::vector<float>(27, 2.0F)));
  const auto part = std::get<VolumeContent>(layer.content).volume;
  Layer channels;
  channels.content = ChannelsContent{
      std::make_shared<const Channels>(std::vector<Channel>{{"a", "", whole}, {"b", "", part}}),
      {}};
  LayerValues(channels).fill(0, plane, {}, values);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_EQ(values[15], 2.0F);
  EXPECT_TRUE(LayerValues(channels).at({0.5, 0.5, 0.5}).empty());
}

TEST(Slice, CutsTetrahedra) {
  // A cube of five tetrahedra, stretched; linear data are exact in any of them.
  TetrahedralMesh::Description description;
  for (int n = 0; n < 8; ++n) {
    description.points.push_back({2.0 * (n & 1), 1.0 * ((n >> 1) & 1), 3.0 * (n >> 2)});
  }
  description.tetrahedra = {{0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}};
  const auto linear = [](const Vec3<double>& p) { return 1 + p.x - 2 * p.y + 0.5 * p.z; };
  MeshChannel points{"p", "", Centering::point, {}}, cells{"c", "", Centering::cell, {}};
  std::vector<double> values;
  for (const Vec3<double>& point : description.points) values.push_back(linear(point));
  points.values = DataArray<double>(values);
  cells.values = DataArray<float>(std::vector<float>{10, 11, 12, 13, 14});
  const auto mesh = std::make_shared<const TetrahedralMesh>(description);
  Layer layer;
  layer.content = MeshContent{
      std::make_shared<const MeshChannels>(mesh, std::vector<MeshChannel>{points, cells}), {}};
  layer.transform.translation = {10, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    SlicePlane plane;
    plane.axis = axis;
    plane.position = axis == 0 ? 10.7 : 0.6;
    plane.from = {axis == 0 ? -0.25 : 9.5, -0.25};
    plane.to = {axis == 0 ? 1.25 : 12.5, 3.25};
    plane.columns = 31;
    plane.rows = 37;
    std::vector<float> found(plane.count());
    LayerValues(layer).fill(0, plane, {}, found);
    for (int row = 0; row < plane.rows; ++row) {
      for (int column = 0; column < plane.columns; ++column) {
        const Vec3<double> at = plane.at(column, row) - Vec3<double>{10, 0, 0};
        const bool inside = at.x > 0 && at.x < 2 && at.y > 0 && at.y < 1 && at.z > 0 && at.z < 3;
        const float value = found[static_cast<std::size_t>(row * plane.columns + column)];
        ASSERT_EQ(inside, !std::isnan(value));
        if (!inside) continue;
        ASSERT_NEAR(linear(at), static_cast<double>(value), 1e-6);
      }
    }
  }
  // In the tetrahedron of the corner at the origin, and in the one in the middle.
  EXPECT_EQ(LayerValues(layer).at({10.1, 0.1, 0.1})[1], 10);
  EXPECT_EQ(LayerValues(layer).at({11, 0.5, 1.5})[1], 14);
}

Scene labelled_scene() {
  Volume::Description grid;
  grid.dimensions = {4, 2, 2};
  grid.coordinates[0] = {0, 1, 3, 4};
  std::vector<std::int16_t> data;
  for (int i = 0; i < 4; ++i) data.insert(data.end(), {0, 5, 7, 9});
  const auto labels =
      std::make_shared<const LabelVolume>(std::make_shared<const Volume>(grid, VolumeData(data)));
  const auto table = std::make_shared<const LabelTable>(std::vector<LabelStyle>{
      {5, "five", {1, 0, 0}, 1}, {7, "seven", {0, 1, 0}, 0}, {9, "", {0, 0, 1}, 2}});
  Scene scene;
  scene.layers.resize(1);
  scene.layers[0].content = LabelContent{labels, table};
  return scene;
}

TEST(Slice, HasTheLabelOfTheNearestValue) {
  const Scene scene = labelled_scene();
  AskSlice ask;
  ask.plane = {2, 0.5, {0, 0}, {4, 1}, 40, 1};
  const SlicePicture picture = make_slice(scene, ask, {});
  EXPECT_TRUE(picture.values.empty());
  ASSERT_EQ(picture.labels.size(), 40U);
  // 7 is transparent, 0 has no look. Borders are half-way: at 0.5, 2 and 3.5.
  ASSERT_EQ(picture.shown.size(), 2U);
  EXPECT_EQ(picture.shown[0].name, "five");
  for (int i = 0; i < 40; ++i) {
    const double x = (i + 0.5) / 10;
    const int wanted = x < 0.5 ? 0 : x < 2 ? 1 : x < 3.5 ? 0 : 2;
    EXPECT_EQ(picture.labels[static_cast<std::size_t>(i)], wanted) << x;
  }
  const Json located = located_json(scene, {{1.4, 0.5, 0.5}});
  EXPECT_EQ(located["labels"][0]["name"], "five");
  EXPECT_EQ(located["labels"][0]["color"], "#ff0000");
  EXPECT_EQ(located["voxels"][0]["index"], Json({1, 1, 1}));
  EXPECT_TRUE(located["values"].empty());
}

TEST(Slice, HasTheLabelsOfAMask) {
  Volume::Description grid;
  grid.dimensions = {4, 2, 2};
  grid.placement.origin = {10, 0, 0};
  std::vector<std::uint8_t> labels;
  for (int i = 0; i < 4; ++i) labels.insert(labels.end(), {0, 3, 4, 4});
  const auto function = std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 1, {1, 1, 1}}});
  const auto mask = std::make_shared<const LabelMask>(
      std::make_shared<const LabelVolume>(std::make_shared<const Volume>(grid, VolumeData(labels))),
      std::vector<LabelMask::Choice>{{0, function}, {3, function}});
  Scene scene;
  scene.layers = {layer_of(volume_of(grid))};
  std::get<VolumeContent>(scene.layers[0].content).mask = mask;
  AskSlice ask;
  ask.plane = {2, 0.5, {10, 0}, {13, 1}, 30, 1};
  ask.layer = 0;
  const SlicePicture picture = make_slice(scene, ask, {});
  // 3 alone has a function of its own, and 0 is what lies around labels.
  ASSERT_EQ(picture.shown.size(), 1U);
  EXPECT_EQ(picture.shown[0].label, 3);
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(picture.labels[static_cast<std::size_t>(i)], i >= 5 && i < 15 ? 1 : 0) << i;
    EXPECT_FALSE(std::isnan(picture.values[static_cast<std::size_t>(i)]));
  }
  EXPECT_EQ(located_json(scene, {{11, 0.5, 0.5}})["labels"][0]["label"], 3);
  scene.layers[0].visible = false;
  EXPECT_TRUE(make_slice(scene, ask, {}).labels.empty());
}

TEST(Slice, RefusesWhatIsNotThere) {
  const Scene scene = labelled_scene();
  AskSlice ask;
  ask.plane = {2, 0.5, {0, 0}, {4, 1}, 4, 1};
  ask.layer = 0;
  EXPECT_THROW(make_slice(scene, ask, {}), Error);  // labels have no values
  ask.layer = 1;
  EXPECT_THROW(make_slice(scene, ask, {}), Error);
  Scene volumes = scene;
  volumes.layers = {layer_of(volume_of(cases()[0].grid))};
  ask.layer = 0;
  EXPECT_EQ(make_slice(volumes, ask, {}).values.size(), 4U);
  ask.channel = 1;
  EXPECT_THROW(make_slice(volumes, ask, {}), Error);
}

TEST(SliceSteps, GoFromValueToValue) {
  const auto all = cases();
  const auto steps_of = [&](std::size_t i) {
    Layer layer = layer_of(volume_of(all[i].grid));
    layer.transform = all[i].transform;
    return slice_steps(layer);
  };
  EXPECT_EQ(steps_of(0)[2].count, 5);
  EXPECT_EQ(steps_of(1)[1].first, 5);
  EXPECT_EQ(steps_of(1)[1].step, 2);
  EXPECT_EQ(steps_of(2)[0].first, 3);   // flipped: 9 - 6
  EXPECT_EQ(steps_of(3)[0].step, 1.5);  // permuted: the grid's y goes along x
  EXPECT_EQ(steps_of(4)[0].count, 0);   // oblique
  EXPECT_NEAR(steps_of(4)[0].step, std::cos(0.3), 1e-12);
  EXPECT_EQ(steps_of(6)[2].positions, (std::vector<double>{-1, 0, 2, 2.5, 4}));
  EXPECT_EQ(steps_of(7)[1].positions[2], 2.75);
}

}  // namespace
}  // namespace pellucid::view::slice_test
