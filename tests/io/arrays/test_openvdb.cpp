// SPDX-License-Identifier: Apache-2.0
#ifdef PELLUCID_HAVE_OPENVDB

#include <openvdb/openvdb.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_openvdb {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::value_at;
using test::world_of;

/// Writes grids by OpenVDB itself.
class OpenVdb : public test::ScratchFolder {
 protected:
  void SetUp() override {
    ScratchFolder::SetUp();
    openvdb::initialize();
  }

  /// 5 × 4 × 3 voxels 0, 1, …, 59 from (-2, 7, 100) on, all of them active.
  template <class Grid, class Make>
  typename Grid::Ptr counting_grid(const std::string& name, const Make& make) {
    auto grid = Grid::create();
    grid->setName(name);
    auto access = grid->getAccessor();
    for (int i = 0; i < 60; ++i) {
      access.setValueOn({i % 5 - 2, i / 5 % 4 + 7, i / 20 + 100}, make(i));
    }
    return grid;
  }
  openvdb::FloatGrid::Ptr floats(const std::string& name = "density") {
    return counting_grid<openvdb::FloatGrid>(name, [](int i) { return static_cast<float>(i); });
  }
  fs::path save(const openvdb::GridPtrVec& grids, const std::string& name = "a.vdb") {
    openvdb::io::File(path(name).string()).write(grids);
    return path(name);
  }
  Volume read(const fs::path& file, const std::string& array, std::optional<int> component = {}) {
    ReadOptions options;
    options.array = array;
    options.component = component;
    return read_volume(file, options);
  }
};

TEST_F(OpenVdb, EveryType) {
  const auto as = [](auto number) {
    return [](int i) { return static_cast<decltype(number)>(i); };
  };
  const fs::path file = save({counting_grid<openvdb::FloatGrid>("f32", as(0.F)),
                              counting_grid<openvdb::DoubleGrid>("f64", as(0.)),
                              counting_grid<openvdb::Int32Grid>("i32", as(std::int32_t{0})),
                              counting_grid<openvdb::Int64Grid>("i64", as(std::int64_t{0}))});
  for (const char* type : {"f32", "f64", "i32"}) {
    SCOPED_TRACE(type);
    expect_counting(read(file, type), type);
  }
  expect_counting(read(file, "i64"), "u8");
}

// Its library has threads from its first moment, and whoever forks beside them may wait for ever.
TEST_F(OpenVdb, ModulesAreLoadedElsewhere) {
  const fs::path maps = "/proc/self/maps";
  if (!fs::exists(maps)) GTEST_SKIP() << "no /proc/self/maps";
  expect_counting(read(save({floats()}), "density"), "f32");
  std::ifstream file(maps);
  const std::string mapped(std::istreambuf_iterator<char>(file), {});
  ASSERT_NE(mapped.find("test_io"), std::string::npos);
  EXPECT_EQ(mapped.find("pellucid_openvdb"), std::string::npos);
}

TEST_F(OpenVdb, TruthValuesAndMasks) {
  const auto odd = counting_grid<openvdb::BoolGrid>("odd", [](int i) { return i % 2 == 1; });
  auto mask = openvdb::MaskGrid::create();
  mask->setName("mask");
  mask->tree().setValueOn({0, 0, 0});
  mask->tree().setValueOn({2, 3, 4});
  const fs::path file = save({odd, mask});
  const Volume bits = read(file, "odd"), ones = read(file, "mask");
  EXPECT_EQ(type_name(bits.data()), "u8");
  EXPECT_EQ(value_at(bits, 0, 0, 0), 0);
  EXPECT_EQ(value_at(bits, 1, 0, 0), 1);
  EXPECT_EQ(ones.description().dimensions, (std::array<int, 3>{3, 4, 5}));
  EXPECT_EQ(value_at(ones, 2, 3, 4), 1);
  EXPECT_EQ(value_at(ones, 1, 3, 4), 0);
}

TEST_F(OpenVdb, HalfFloats) {
  const auto grid = floats();
  grid->setSaveFloatAsHalf(true);
  expect_counting(read_volume(save({grid})), "f32");
}

TEST_F(OpenVdb, VectorsAreComponents) {
  const auto grid = counting_grid<openvdb::Vec3SGrid>("v", [](int i) {
    const auto x = static_cast<float>(i);
    return openvdb::Vec3s(x, x + 100, x + 200);
  });
  const fs::path file = save({grid});
  EXPECT_TRUE(contains(error_of([&] { read_volume(file); }), "3 components"));
  const std::vector<Volume> all = read_components(file);
  ASSERT_EQ(all.size(), 3U);
  expect_counting(all[0], "f32");
  EXPECT_EQ(value_at(all[1], 0, 0, 0), 100);
  EXPECT_EQ(value_at(read(file, "v", 2), 4, 3, 2), 259);
}

// What is not active has the background's value; what is active far away makes the box larger.
TEST_F(OpenVdb, TheBackgroundFillsTheBox) {
  auto grid = openvdb::FloatGrid::create(-3);
  grid->setName("sparse");
  grid->tree().setValueOn({0, 0, 0}, 1);
  grid->tree().setValueOn({40, 30, 20}, 2);
  // A tile of 8³ voxels.
  grid->fill({{16, 8, 8}, {23, 15, 15}}, 7, true);
  grid->pruneGrid();
  const Volume volume = read_volume(save({grid}));
  EXPECT_EQ(volume.description().dimensions, (std::array<int, 3>{41, 31, 21}));
  EXPECT_EQ(value_at(volume, 0, 0, 0), 1);
  EXPECT_EQ(value_at(volume, 1, 0, 0), -3);
  EXPECT_EQ(value_at(volume, 16, 8, 8), 7);
  EXPECT_EQ(value_at(volume, 23, 15, 15), 7);
  EXPECT_EQ(value_at(volume, 24, 15, 15), -3);
  EXPECT_EQ(value_at(volume, 40, 30, 20), 2);
}

TEST_F(OpenVdb, PlacesVoxelsByAnyAffineMap) {
  const auto corner = [&](const openvdb::math::Transform::Ptr& transform) {
    const auto grid = floats();
    grid->setTransform(transform);
    const Volume volume = read_volume(save({grid}));
    for (const openvdb::Coord at : {openvdb::Coord{0, 0, 0}, openvdb::Coord{4, 3, 2}}) {
      const openvdb::Vec3d world = transform->indexToWorld(at + openvdb::Coord{-2, 7, 100});
      expect_near(world_of(volume, at.x(), at.y(), at.z()), {world.x(), world.y(), world.z()},
                  1e-12 * world.length());
    }
  };
  corner(openvdb::math::Transform::createLinearTransform(0.25));
  corner(openvdb::math::Transform::createLinearTransform(
      openvdb::Mat4R(1., 2., 0., 0., 0., 3., 0.5, 0., 0.25, 0., -2., 0., 10., 20., 30., 1.)));
  auto turned = openvdb::math::Transform::createLinearTransform(1);
  turned->postScale(openvdb::Vec3d(1, 2, 3));
  turned->postRotate(0.7, openvdb::math::Y_AXIS);
  turned->postTranslate({5, -6, 7});
  corner(turned);
}

TEST_F(OpenVdb, RefusesByNameWhatIsNoVolume) {
  const auto sphere = floats("ball");
  sphere->setGridClass(openvdb::GRID_LEVEL_SET);
  auto staggered =
      counting_grid<openvdb::Vec3SGrid>("flow", [](int) { return openvdb::Vec3s(1, 2, 3); });
  staggered->setGridClass(openvdb::GRID_STAGGERED);
  auto frustum = floats("cone");
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0, 0, 0}, {100, 100, 100}), 0.5, 100));
  auto empty = openvdb::FloatGrid::create();
  empty->setName("nothing");
  const auto cloud = openvdb::GridBase::createGrid("Tree_ptdataidx32_5_4_3");
  cloud->setName("cloud");
  const fs::path file = save({sphere, staggered, frustum, empty, cloud, floats("smoke")});
  expect_counting(read_volume(file), "f32");
  const auto refused = [&](const std::string& name, const std::string& why) {
    const std::string error = error_of([&] { read(file, name); });
    EXPECT_TRUE(contains(error, "\"" + name + "\"") && contains(error, why)) << error;
  };
  refused("ball", "a level set");
  refused("flow", "staggered");
  refused("cone", "frustum");
  refused("nothing", "without an active voxel");
  refused("cloud", "points");
  refused("fire", "it has smoke");
  const std::string error = error_of([&] { read_volume(save({sphere}, "b.vdb")); });
  EXPECT_TRUE(contains(error, "no fog volume; it has ball (a level set")) << error;
}

TEST_F(OpenVdb, NamesOfAnyLettersAreOneLine) {
  const auto vectors = counting_grid<openvdb::Vec3SGrid>(
      "a\nb\x1b[31m", [](int) { return openvdb::Vec3s(1, 2, 3); });
  auto empty = openvdb::FloatGrid::create();
  empty->setName("\xff\n");
  const fs::path file = save({vectors, empty});
  EXPECT_TRUE(contains(error_of([&] { read_volume(file); }), "in \"a b [31m\""));
  EXPECT_TRUE(contains(error_of([&] { read(file, "none"); }), "it has a b [31m"));
  EXPECT_TRUE(contains(error_of([&] { read(file, "\xff\n"); }), "without an active voxel"));
}

// The library opens no file with a grid of a type that it does not know.
TEST_F(OpenVdb, UnknownTypesAreRefused) {
  std::string bytes = ScratchFolder::read(save({floats()}));
  const std::string type = "Tree_float_5_4_3";
  bytes.replace(bytes.find(type), type.size(), "Tree_float_3_3_3");
  EXPECT_TRUE(contains(error_of([&] { read_volume(write("b.vdb", bytes)); }), "Tree_float_3_3_3"));
}

TEST_F(OpenVdb, ListsItsGrids) {
  const fs::path file = save({floats("a"), floats("b"), floats("b")});
  const std::vector<VolumeArray> arrays = list_arrays(file);
  ASSERT_EQ(arrays.size(), 3U);
  EXPECT_EQ(arrays[0].name, "a");
  EXPECT_TRUE(arrays[0].is_default);
  EXPECT_EQ(arrays[0].dimensions, (std::vector<int>{5, 4, 3}));
  EXPECT_EQ(arrays[0].components.front().maximum, 59);
  expect_counting(read(file, arrays[2].name), "f32");
}

TEST_F(OpenVdb, BoxesBeyondMemoryAreRefused) {
  auto large = openvdb::BoolGrid::create();
  const int last = (1 << 17) - 1;
  large->fill({{0, 0, 0}, {last, last, last}}, true, true);
  EXPECT_TRUE(contains(error_of([&] { read_volume(save({large})); }), "its values"));
}

// As where a damaged file has a voxel far from the others: gigabytes of nothing.
TEST_F(OpenVdb, BoxesOfNearlyNothingAreRefused) {
  for (const int far : {1 << 10, 1 << 18, 2147483647}) {
    auto grid = openvdb::FloatGrid::create();
    grid->setName("d");
    grid->tree().setValueOn({-far, -far, -far}, 1);
    grid->tree().setValueOn({far, far, far}, 1);
    const std::string error = error_of([&] { read_volume(save({grid})); });
    EXPECT_TRUE(contains(error, "with 2 active ones")) << error;
  }
  // A large one with enough of them: 2^28 voxels and more, of one byte.
  auto full = openvdb::MaskGrid::create();
  full->fill({{0, 0, 0}, {511, 511, 1023}}, true, true);
  full->tree().setValueOn({511, 511, 1030});
  EXPECT_EQ(outline_volume(save({full})).description.dimensions[2], 1031);
}

TEST_F(OpenVdb, LeavesAndTilesOnBothSidesOfZero) {
  auto grid = openvdb::Int32Grid::create(-5);
  grid->setName("v");
  grid->fill({{-24, -9, -17}, {-9, 14, 6}}, 3, true);
  for (int x = -30; x <= 30; ++x) grid->tree().setValueOn({x, x / 3, -x / 2}, 100 + x);
  grid->pruneGrid();
  const Volume volume = read_volume(save({grid}));
  const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
  const auto dimensions = volume.description().dimensions;
  for (int z = 0; z < dimensions[2]; ++z) {
    for (int y = 0; y < dimensions[1]; ++y) {
      for (int x = 0; x < dimensions[0]; ++x) {
        ASSERT_EQ(value_at(volume, x, y, z), grid->tree().getValue(box.min().offsetBy(x, y, z)));
      }
    }
  }
}

// Wherever it is cut off, the file's own list of grids shows it, before OpenVDB is asked and takes
// any number for a size.
TEST_F(OpenVdb, CutOffIsAnError) {
  const fs::path file = save({floats("a"), floats("b")}, "cut.vdb");
  // Every byte of the header, some of the trees.
  for (std::size_t length = fs::file_size(file); length > 0;) {
    length -= std::min<std::size_t>(length < 600 ? 1 : 101, length);
    fs::resize_file(file, length);
    const std::string text = error_of([&] { read_volume(file); });
    ASSERT_TRUE(contains(text, length < 8 ? "is no OpenVDB file" : "is cut off")) << text;
    ASSERT_FALSE(contains(text, "memory"));
  }
  fs::resize_file(save({floats()}, "cut.vdb"), 1000);
  EXPECT_TRUE(contains(error_of([&] { list_arrays(path("cut.vdb")); }), "is cut off"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(write("no.vdb", "this is none")); }),
                       "is no OpenVDB file"));
}

// What the list does not show: OpenVDB reads it in a process of its own. Few, for each is started.
TEST_F(OpenVdb, DamagedIsAnErrorThatSaysSo) {
  const std::string whole = ScratchFolder::read(save({floats()}));
  for (std::size_t n = 1; n <= 8; ++n) {
    std::string damaged = whole;
    const std::size_t at = whole.size() * n / 9;
    damaged.replace(at, 12, std::string(std::min<std::size_t>(12, whole.size() - at), '\xff'));
    try {
      read_volume(write("damaged.vdb", damaged));
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_FALSE(contains(text, "memory") && !contains(text, "damaged")) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace pellucid::test_openvdb

#endif
