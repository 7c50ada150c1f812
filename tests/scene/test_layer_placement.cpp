// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "expect_error.h"
#include "layer_contents.h"

namespace pellucid::test_layer_placement {
namespace {

/// A quarter turn, a shear and scales, all of them exact.
Affine<double> exact_map() {
  Affine<double> map;
  map.matrix = {{{0, 2, 0}, {-2, 0.5, 0}, {0, 0.25, -4}}};
  map.translation = {1, -2, 3};
  return map;
}

/// The transform that is `first`, then `second`.
Affine<double> after(const Affine<double>& second, const Affine<double>& first) {
  Affine<double> result;
  for (int a = 0; a < 3; ++a) result.matrix.column[a] = second.vector(first.matrix.column[a]);
  result.translation = second.point(first.translation);
  return result;
}

const void* address(const VolumeData& data) {
  return std::visit([](const auto& values) { return static_cast<const void*>(values.data()); },
                    data);
}

/// Every place of the grid is where the map says, the data are shared, and all else is as it was.
void expect_moved(const Volume& moved, const Volume& volume, const Affine<double>& map) {
  EXPECT_EQ(address(moved.data()), address(volume.data()));
  EXPECT_EQ(&moved.block_records(), &volume.block_records());
  EXPECT_EQ(moved.description().name, volume.description().name);
  EXPECT_EQ(moved.description().dimensions, volume.description().dimensions);
  EXPECT_EQ(moved.description().coordinates, volume.description().coordinates);
  EXPECT_EQ(moved.statistics().maximum, volume.statistics().maximum);
  EXPECT_EQ(moved.grid_lower(), volume.grid_lower());
  EXPECT_EQ(moved.grid_upper(), volume.grid_upper());
  const Vec3<double> lower = volume.grid_lower(), size = volume.grid_upper() - lower;
  for (const double x : {0.0, 0.25, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      for (const double z : {0.0, 0.75, 1.0}) {
        const Vec3<double> place = lower + Vec3<double>{x * size.x, y * size.y, z * size.z};
        const Vec3<double> world = map.point(volume.world_from_grid().point(place));
        EXPECT_EQ(moved.world_from_grid().point(place), world);
        const Vec3<double> back = moved.grid_from_world().point(world);
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(back[a], place[a], 1e-13);
      }
    }
  }
  const auto before = volume.world_corners(), corners = moved.world_corners();
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(corners[i], map.point(before[i])) << i;
}

TEST(MovedVolume, UniformGrids) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    Volume::Description d = exact_grid();
    d.centering = centering;
    const auto volume = counting(d);
    const Volume moved = volume->moved(exact_map());
    expect_moved(moved, *volume, exact_map());
    EXPECT_EQ(moved.description().placement.origin, exact_map().point({10, -20, 30}));
    EXPECT_EQ(moved.description().placement.spacing, (Vec3<double>{2, 1, 0.5}));
    EXPECT_EQ(volume->description().placement.origin, (Vec3<double>{10, -20, 30}));
  }
  Affine<double> map;
  map.matrix = {{{0, 2, 0}, {-2, 0, 0}, {0, 0, 8}}};
  EXPECT_EQ(counting(exact_grid())->voxel_size(), 0.5);
  EXPECT_EQ(counting(exact_grid())->moved(map).voxel_size(), 2);
}

TEST(MovedVolume, RectilinearGrids) {
  Volume::Description d = exact_grid();
  d.coordinates[0] = {-1, 0.5, 3};
  d.coordinates[2] = {2, 2.25};
  const auto points = counting(d);
  expect_moved(points->moved(exact_map()), *points, exact_map());
  d.centering = Centering::cell;
  d.coordinates[0] = {-1, 0.5, 3, 3.5};
  d.coordinates[2] = {2, 2.25, 4};
  const auto cells = counting(d);
  const Volume moved = cells->moved(exact_map());
  expect_moved(moved, *cells, exact_map());
  // The values are at the middles between the faces.
  moved.visit([&](const auto& grid) {
    EXPECT_EQ(grid.axis[0].plane(1), -0.25);
    EXPECT_EQ(grid.axis[0].plane(3), 3.25);
  });
}

TEST(MovedVolume, ShearedGrids) {
  Volume::Description d = exact_grid();
  d.placement.direction = {{{1, 0.25, 0}, {0.5, 1, 0}, {0, -0.125, -1}}};
  const auto volume = counting(d);
  const Volume moved = volume->moved(exact_map());
  expect_moved(moved, *volume, exact_map());
  EXPECT_EQ(moved.description().placement.direction.column[0], exact_map().vector({1, 0.25, 0}));
}

TEST(MovedVolume, MovesAddUp) {
  const auto volume = counting(exact_grid());
  Affine<double> second;
  second.matrix = {{{1, 0, 0.5}, {0, 1, 0}, {0, 0.5, 1}}};
  second.translation = {-8, 0, 16};
  expect_moved(volume->moved(exact_map()).moved(second), *volume, after(second, exact_map()));
}

TEST(MovedVolume, CopiesStayWhereTheyWere) {
  const Volume volume = *counting(exact_grid());
  const Volume copy = volume;
  const Volume moved = copy.moved(exact_map());
  EXPECT_EQ(copy.world_corners(), volume.world_corners());
  EXPECT_NE(moved.world_corners(), volume.world_corners());
}

TEST(MovedVolume, RefusesPlacesThatAreNone) {
  const auto volume = counting(exact_grid());
  const auto refusal = [&](const Affine<double>& map) {
    return error_message([&] { (void)volume->moved(map); });
  };
  Affine<double> map;
  map.matrix.column[2] = {0, 0, 0};
  EXPECT_EQ(refusal(map),
            "small: direction is singular, with columns (1, 0, 0), (0, 1, 0), (0, 0, 0); its "
            "columns must be three independent axes");
  map = {};
  map.translation.y = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(map), "small: origin is (10, inf, 30), but must be finite");
  map = {};
  map.matrix.column[0].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(map), "small: origin is (nan, -20, 30), but must be finite");
  map = {};
  map.matrix.column[0].x = 1.5e307;  // to 14 times that
  EXPECT_EQ(refusal(map),
            "small: origin, spacing and direction place the box beyond the range of double; use "
            "another unit of length");
  map.matrix.column[0].x = 1e307;
  EXPECT_EQ(refusal(map), "");
}

Layer dressed(LayerContent content) {
  Layer layer;
  layer.content = std::move(content);
  layer.name = "liver";
  layer.visible = false;
  layer.transform = exact_map();
  layer.clips = {{ClipSphere{{1, 2, 3}, 4}, false}};
  return layer;
}

/// Moves it and expects that only the data and the transform changed.
Layer placed(const Layer& layer) {
  Layer moved = moved_into_place(layer);
  EXPECT_TRUE(is_in_place(moved));
  EXPECT_EQ(moved.name, layer.name);
  EXPECT_EQ(moved.visible, layer.visible);
  EXPECT_EQ(moved.content.index(), layer.content.index());
  EXPECT_EQ(moved.clips.size(), 1U);
  const auto& sphere = std::get<ClipSphere>(moved.clips.at(0).shape);
  EXPECT_EQ(sphere.center, (Vec3<double>{1, 2, 3}));
  EXPECT_FALSE(moved.clips[0].keep_inside);
  return moved;
}

TEST(MovedIntoPlace, ALayerInPlaceIsSharedWhole) {
  const auto volume = counting(exact_grid());
  Layer layer = dressed(VolumeContent{volume, table_of(1, 1), nullptr});
  EXPECT_FALSE(is_in_place(layer));
  layer.transform = {};
  EXPECT_TRUE(is_in_place(layer));
  layer.transform.translation = {-0.0, 0, 0};
  EXPECT_TRUE(is_in_place(layer));
  EXPECT_EQ(std::get<VolumeContent>(placed(layer).content).volume, volume);
  layer.transform.translation = {0, 0, 1e-300};
  EXPECT_FALSE(is_in_place(layer));
}

TEST(MovedIntoPlace, VolumesWithTheirMasks) {
  const auto labels = std::make_shared<const LabelVolume>(counting(exact_grid()));
  const auto mask = std::make_shared<const LabelMask>(
      labels, std::vector<LabelMask::Choice>{{3, table_of(7, 2)}, {5, table_of(1, 2)}});
  const VolumeContent content{counting(exact_grid()), table_of(1, 1), mask};
  const auto moved = std::get<VolumeContent>(placed(dressed(content)).content);
  expect_moved(*moved.volume, *content.volume, exact_map());
  EXPECT_EQ(moved.transfer_function, content.transfer_function);
  expect_moved(moved.mask->labels().volume(), labels->volume(), exact_map());
  EXPECT_EQ(moved.mask->labels().labels(), labels->labels());
  ASSERT_EQ(moved.mask->choices().size(), 2U);
  EXPECT_EQ(moved.mask->choice_of(5), 1);
  EXPECT_EQ(moved.mask->choices()[1].transfer_function, mask->choices()[1].transfer_function);
  Layer layer = dressed(content);
  layer.transform = {};
  layer.content = moved;
  EXPECT_NO_THROW(check_layer(layer, "layer"));
}

TEST(MovedIntoPlace, ChannelsOnTheirGrid) {
  const ChannelsContent content{two_channels(), gaussian_of(2)};
  const auto moved = std::get<ChannelsContent>(placed(dressed(content)).content);
  ASSERT_EQ(moved.channels->count(), 2);
  for (int c = 0; c < 2; ++c) {
    expect_moved(*(*moved.channels)[c].volume, *(*content.channels)[c].volume, exact_map());
    EXPECT_EQ((*moved.channels)[c].name, (*content.channels)[c].name);
    EXPECT_EQ((*moved.channels)[c].unit, (*content.channels)[c].unit);
  }
  EXPECT_EQ(moved.transfer_function, content.transfer_function);
}

TEST(MovedIntoPlace, LabelsWithTheirColors) {
  const LabelContent content{
      std::make_shared<const LabelVolume>(counting(exact_grid())),
      std::make_shared<const LabelTable>(std::vector<LabelStyle>{{1, "", {1, 1, 1}, 1}})};
  const auto moved = std::get<LabelContent>(placed(dressed(content)).content);
  expect_moved(moved.labels->volume(), content.labels->volume(), exact_map());
  EXPECT_EQ(moved.labels->labels(), content.labels->labels());
  EXPECT_EQ(moved.table, content.table);
}

TEST(MovedIntoPlace, Meshes) {
  const MeshContent content{two_tetrahedra(2), gaussian_of(2)};
  const auto moved = std::get<MeshContent>(placed(dressed(content)).content);
  const TetrahedralMesh &before = content.mesh->mesh(), &mesh = moved.mesh->mesh();
  ASSERT_EQ(mesh.points().size(), before.points().size());
  for (std::size_t i = 0; i < mesh.points().size(); ++i) {
    EXPECT_EQ(mesh.points()[i], exact_map().point(before.points()[i])) << i;
    EXPECT_EQ(mesh.point_number(i), before.point_number(i)) << i;
  }
  ASSERT_EQ(mesh.tetrahedra().size(), before.tetrahedra().size());
  for (std::size_t t = 0; t < mesh.tetrahedra().size(); ++t) {
    for (int k = 0; k < 4; ++k) EXPECT_EQ(mesh.tetrahedra()[t][k], before.tetrahedra()[t][k]);
  }
  EXPECT_EQ(mesh.name(), "two.vtu");
  EXPECT_EQ(mesh.statistics().folded_faces, 0U);
  EXPECT_EQ(mesh.statistics().boundary_faces, 6U);
  // The determinant of the map is -16: what is mirrored stays a body.
  EXPECT_NEAR(mesh.statistics().volume, 16 * before.statistics().volume, 1e-14);
  ASSERT_EQ(moved.mesh->count(), 2);
  for (int c = 0; c < 2; ++c) {
    EXPECT_EQ(address((*moved.mesh)[c].values), address((*content.mesh)[c].values));
    EXPECT_EQ((*moved.mesh)[c].name, (*content.mesh)[c].name);
    EXPECT_EQ((*moved.mesh)[c].unit, (*content.mesh)[c].unit);
    EXPECT_EQ((*moved.mesh)[c].centering, (*content.mesh)[c].centering);
  }
  EXPECT_EQ(moved.multivariate(), content.multivariate());
}

TEST(MovedIntoPlace, CornersAreWhereTheDataWillBe) {
  Layer layer = dressed(VolumeContent{counting(exact_grid()), table_of(1, 1), nullptr});
  EXPECT_EQ(world_corners(layer), world_corners(moved_into_place(layer)));
  // Of a mesh: its box, turned with it. The unused point is outside.
  layer = dressed(MeshContent{two_tetrahedra(1), table_of(1, 1)});
  const auto corners = world_corners(layer);
  EXPECT_EQ(corners[0], exact_map().point({0, 0, 0}));
  EXPECT_EQ(corners[1], exact_map().point({1, 0, 0}));
  EXPECT_EQ(corners[7], exact_map().point({1, 1, 1}));
}

TEST(MovedIntoPlace, RefusesSingularTransformsOfAllKinds) {
  const std::vector<LayerContent> contents{
      VolumeContent{counting(exact_grid()), table_of(1, 1), nullptr},
      ChannelsContent{two_channels(), gaussian_of(2)},
      MeshContent{two_tetrahedra(1), table_of(1, 1)},
      LabelContent{
          std::make_shared<const LabelVolume>(counting(exact_grid())),
          std::make_shared<const LabelTable>(std::vector<LabelStyle>{{1, "", {1, 1, 1}, 1}})}};
  for (const LayerContent& content : contents) {
    Layer layer = dressed(content);
    layer.transform.matrix.column[0] = layer.transform.matrix.column[1];
    const auto refusal = [&] { return error_message([&] { (void)moved_into_place(layer); }); };
    const std::string text = "transform is singular; its columns must be three independent axes";
    EXPECT_EQ(refusal(), "layer \"liver\": " + text);
    layer.name.clear();
    EXPECT_EQ(refusal(), "layer: " + text);
  }
}

TEST(MovedIntoPlace, RefusesMeshesBeyondTheRangeOfNumbers) {
  Layer layer = dressed(MeshContent{two_tetrahedra(1), table_of(1, 1)});
  layer.transform.matrix = {{{1e38, 0, 0}, {0, 1e38, 0}, {0, 0, 1e38}}};
  layer.transform.translation = {0, 0, 0};
  EXPECT_EQ(error_message([&] { (void)moved_into_place(layer); }),
            "two.vtu: point 71 is (1e+38, 0, 0), but coordinates must be finite and within 2.1e37");
}

}  // namespace
}  // namespace pellucid::test_layer_placement
