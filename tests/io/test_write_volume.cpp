// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/write_volume.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "volume_files.h"
#include "written_volumes.h"

namespace pellucid::test_write_volume {
namespace {

using test::awkward_description;
using test::awkward_volumes;
using test::contains;
using test::error_of;

class WriteVolume : public test::ScratchFolder {
 protected:
  std::vector<std::string> write_all(const std::vector<Volume>& volumes,
                                     const std::string& name) const {
    return write_volume(volumes, path(name), "density");
  }
};

template <class Value>
void expect_same_bits(const Volume& a, const Volume& b) {
  const auto& x = std::get<DataArray<Value>>(a.data());
  const auto& y = std::get<DataArray<Value>>(b.data());
  ASSERT_EQ(x.size(), y.size());
  EXPECT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof(Value)), 0);
}

/// The places of all values, not the numbers that make them.
void expect_same_place(const Volume& a, const Volume& b, double tolerance) {
  EXPECT_EQ(a.description().dimensions, b.description().dimensions);
  EXPECT_EQ(a.description().centering, b.description().centering);
  const std::array<int, 3>& n = a.description().dimensions;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner % 2 * (n[0] - 1), j = corner / 2 % 2 * (n[1] - 1),
              k = corner / 4 * (n[2] - 1);
    test::expect_near(test::world_of(a, i, j, k), test::world_of(b, i, j, k), tolerance);
  }
}

TEST_F(WriteVolume, RawIsTheValuesAndItsNoteReadsItBack) {
  Volume::Description description = awkward_description(Centering::cell);
  const std::vector<Volume> volumes = awkward_volumes<float>(2, description);
  const std::vector<std::string> losses = write_all(volumes, "a.raw");
  ASSERT_EQ(losses.size(), 2u);
  EXPECT_EQ(losses[0],
            "raw holds the values alone; read it with --dimensions 5,4,3 --type f32 --components 2 "
            "--spacing 0.361328,1.5,0.1 --origin -83.3,0.1,206.25 --centering cell");
  EXPECT_TRUE(contains(losses[1], "direction"));
  ReadOptions options;
  options.dimensions = {5, 4, 3};
  options.type = "f32";
  options.components = 2;
  const std::vector<Volume> read = read_components(path("a.raw"), options);
  ASSERT_EQ(read.size(), 2u);
  for (std::size_t c = 0; c < 2; ++c) expect_same_bits<float>(read[c], volumes[c]);
  description.placement.direction = {};
  EXPECT_EQ(write_all(awkward_volumes<float>(1, description), "b.raw").size(), 1u);
}

template <class Value>
void expect_npz_reads_back(const std::filesystem::path& file) {
  const Volume::Description description = awkward_description();
  const std::vector<Volume> volumes = awkward_volumes<Value>(1, description);
  EXPECT_TRUE(write_volume(volumes, file, "density").empty());
  ReadOptions options;
  options.array = "density";
  const Volume read = read_volume(file, options);
  expect_same_bits<Value>(read, volumes.front());
  expect_same_place(read, volumes.front(), 1e-12);
}

TEST_F(WriteVolume, NpzReadsBackInEveryType) {
  expect_npz_reads_back<std::uint8_t>(path("a.npz"));
  expect_npz_reads_back<std::int8_t>(path("b.npz"));
  expect_npz_reads_back<std::uint16_t>(path("c.npz"));
  expect_npz_reads_back<std::int16_t>(path("d.npz"));
  expect_npz_reads_back<std::uint32_t>(path("e.npz"));
  expect_npz_reads_back<std::int32_t>(path("f.npz"));
  expect_npz_reads_back<float>(path("g.npz"));
  expect_npz_reads_back<double>(path("h.npz"));
}

TEST_F(WriteVolume, NpzHasComponentsAndSaysWhatItDoesNotHold) {
  const Volume::Description cells = awkward_description(Centering::cell);
  const std::vector<Volume> volumes = awkward_volumes<float>(3, cells);
  const std::vector<std::string> losses = write_all(volumes, "a.npz");
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_TRUE(contains(losses[0], "--centering cell"));
  ReadOptions options;
  options.array = "density";
  options.centering = Centering::cell;
  const std::vector<Volume> read = read_components(path("a.npz"), options);
  ASSERT_EQ(read.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) {
    expect_same_bits<float>(read[c], volumes[c]);
    expect_same_place(read[c], volumes[c], 1e-12);
  }
}

TEST_F(WriteVolume, NpzKeepsPositionsAlongTheAxes) {
  Volume::Description description = awkward_description();
  description.placement.direction = {};
  description.placement.origin = {0.5, -1, 2};
  description.coordinates[0] = {0, 0.5, 2, 3, 7};
  const std::vector<Volume> volumes = awkward_volumes<float>(1, description);
  EXPECT_TRUE(write_all(volumes, "a.npz").empty());
  ReadOptions options;
  options.array = "density";
  const Volume read = read_volume(path("a.npz"), options);
  expect_same_bits<float>(read, volumes.front());
  const auto ours = volumes.front().world_corners(), theirs = read.world_corners();
  for (std::size_t i = 0; i < 8; ++i) test::expect_near(theirs[i], ours[i], 1e-12);
  const auto refused = [&](const Volume::Description& wrong) {
    return error_of([&] { write_all(awkward_volumes<float>(1, wrong), "b.npz"); });
  };
  Volume::Description turned = description;
  turned.placement.direction = test::oblique();
  EXPECT_TRUE(contains(refused(turned), "turned"));
  Volume::Description cells = description;
  cells.centering = Centering::cell;
  cells.coordinates[0].push_back(8.5);
  EXPECT_TRUE(contains(refused(cells), "cells of several sizes"));
}

TEST_F(WriteVolume, NpzNamesItsArrayApartFromThoseThatPlaceIt) {
  for (const char* name : {"affine", "x", "space"}) {
    const std::vector<Volume> volumes = awkward_volumes<float>(1, awkward_description());
    const auto losses = write_volume(volumes, path("a.npz"), name);
    ASSERT_EQ(losses.size(), 1u);
    EXPECT_TRUE(contains(losses[0], std::string(name) + "_values"));
    ReadOptions options;
    options.array = std::string(name) + "_values";
    expect_same_place(read_volume(path("a.npz"), options), volumes.front(), 1e-12);
  }
}

TEST_F(WriteVolume, Refuses) {
  const std::vector<Volume> volumes = awkward_volumes<float>(1, awkward_description());
  EXPECT_TRUE(contains(error_of([&] { write_all(volumes, "a.png"); }), ".nrrd"));
  EXPECT_TRUE(contains(error_of([&] { write_all({}, "a.raw"); }), "no volume"));
  EXPECT_TRUE(contains(error_of([&] { write_all(volumes, "none/a.raw"); }), "none"));
  std::vector<Volume> mixed = volumes;
  mixed.push_back(awkward_volumes<double>(1, awkward_description()).front());
  EXPECT_TRUE(contains(error_of([&] { write_all(mixed, "a.nrrd"); }), "differ in type"));
  Volume::Description rectilinear = awkward_description();
  rectilinear.coordinates[1] = {0, 1, 2, 4};
  for (const char* name : {"a.nrrd", "a.nii", "a.vti", "a.raw"}) {
    EXPECT_TRUE(contains(error_of([&] { write_all(awkward_volumes<float>(1, rectilinear), name); }),
                         "along y"));
  }
  Volume::Description wide;
  wide.dimensions = {32768, 2, 2};
  const Volume long_one(wide, DataArray<std::uint8_t>(std::size_t{32768} * 4));
  EXPECT_TRUE(contains(error_of([&] { write_all({long_one}, "a.nii"); }), "32767"));
  EXPECT_TRUE(files().empty());
  EXPECT_FALSE(is_writable_volume("a.vtu"));
  EXPECT_TRUE(is_writable_volume("a.NII.GZ"));
}

TEST_F(WriteVolume, NiftiSaysWhatItDoesNotHold) {
  Volume::Description description = awkward_description();
  EXPECT_EQ(write_all(awkward_volumes<float>(1, description), "a.nii").size(), 1u);
  description.placement = {{-8, 2, 3}, {0.5, 1, 2}, {}};
  EXPECT_TRUE(write_all(awkward_volumes<float>(1, description), "a.nii").empty());
  description.centering = Centering::cell;
  const auto losses = write_all(awkward_volumes<float>(1, description), "a.nii");
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_TRUE(contains(losses[0], "--centering cell"));
  // Of 1/3, 2^-25 / 3 · 4 / 3 is lost at each of 4 steps: 2^-25 · 4/9 · ….
  description.centering = Centering::point;
  description.placement.spacing.x = 1.0 / 3;
  const auto moved = write_all(awkward_volumes<float>(1, description), "a.nii");
  ASSERT_EQ(moved.size(), 1u);
  const double lost = std::stod(moved[0].substr(moved[0].rfind(' ')));
  EXPECT_NEAR(lost, 4 * (static_cast<double>(1.0F / 3) - 1.0 / 3), 1e-14);
}

#ifdef PELLUCID_HAVE_ITK

TEST_F(WriteVolume, NiftiCountsTheRoundingOfItsOrigin) {
  Volume::Description description;
  description.dimensions = {5, 4, 3};
  description.placement.origin = {0.1, 0, 0};
  const Volume volume(description, DataArray<float>(test::counting()));
  const std::vector<std::string> losses = write_volume({&volume, 1}, path("a.nii"));
  ASSERT_EQ(losses.size(), 1U);
  EXPECT_TRUE(contains(losses[0], "moved by up to 1.49")) << losses[0];
}

TEST_F(WriteVolume, MedicalFilesAreReadBackInEveryBitAndPlace) {
  const auto expect = [&](auto value, const std::string& name, int components, Centering centering,
                          double tolerance) {
    using Value = decltype(value);
    SCOPED_TRACE(name + " of " + std::to_string(components));
    const std::vector<Volume> written =
        awkward_volumes<Value>(components, awkward_description(centering));
    write_all(written, name);
    const std::vector<Volume> read = read_components(path(name));
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t c = 0; c < read.size(); ++c) {
      expect_same_bits<Value>(read[c], written[c]);
      expect_same_place(read[c], written[c], tolerance);
    }
  };
  for (const int components : {1, 2, 3, 4, 7}) {
    // NIfTI has the places in binary32: 206.25 is exact, 83.3 to 4e-6.
    for (const char* name : {"a.nii", "a.nii.gz"}) {
      expect(0.F, name, components, Centering::point, 4e-6);
    }
    for (const Centering centering : {Centering::point, Centering::cell}) {
      expect(0.F, "a.nrrd", components, centering, 1e-13);
    }
  }
  for (const char* name : {"b.nrrd", "b.nii", "b.nii.gz"}) {
    const double tolerance = name[2] == 'n' && name[3] == 'r' ? 1e-13 : 4e-6;
    expect(std::uint8_t{}, name, 1, Centering::point, tolerance);
    expect(std::int8_t{}, name, 2, Centering::point, tolerance);
    expect(std::uint16_t{}, name, 1, Centering::point, tolerance);
    expect(std::int16_t{}, name, 3, Centering::point, tolerance);
    expect(std::uint32_t{}, name, 1, Centering::point, tolerance);
    expect(std::int32_t{}, name, 1, Centering::point, tolerance);
    expect(0., name, 1, Centering::point, tolerance);
  }
}

TEST_F(WriteVolume, ShearedAxesAreKept) {
  Volume::Description description = awkward_description();
  description.placement.direction.column[1] = {0.6, 0, 0.8};
  const std::vector<Volume> written = awkward_volumes<float>(1, description);
  write_all(written, "a.nrrd");
  expect_same_place(read_volume(path("a.nrrd")), written[0], 1e-13);
  write_all(written, "a.nii");
  expect_same_place(read_volume(path("a.nii")), written[0], 4e-6);
}

TEST_F(WriteVolume, NrrdValuesAreUsedWhereTheyLie) {
  write_all(awkward_volumes<double>(1, awkward_description()), "a.nrrd");
  const std::string bytes = read(path("a.nrrd"));
  EXPECT_EQ((bytes.size() - 60 * sizeof(double)) % 8, 0u);
}

#endif

#ifdef PELLUCID_HAVE_VTK

TEST_F(WriteVolume, VtiIsReadBackInEveryBitAndPlace) {
  const auto expect = [&](auto value, int components, Centering centering) {
    using Value = decltype(value);
    const std::vector<Volume> written =
        awkward_volumes<Value>(components, awkward_description(centering));
    EXPECT_TRUE(write_all(written, "a.vti").empty());
    const NamedComponents read = read_named_components(path("a.vti"));
    EXPECT_EQ(read.array, "density");
    ASSERT_EQ(read.components.size(), written.size());
    for (std::size_t c = 0; c < written.size(); ++c) {
      expect_same_bits<Value>(read.components[c], written[c]);
      expect_same_place(read.components[c], written[c], 1e-13);
    }
  };
  for (const Centering centering : {Centering::point, Centering::cell}) {
    expect(std::uint8_t{}, 1, centering);
    expect(std::int8_t{}, 2, centering);
    expect(std::uint16_t{}, 4, centering);
    expect(std::int16_t{}, 1, centering);
    expect(std::uint32_t{}, 1, centering);
    expect(std::int32_t{}, 9, centering);
    expect(0.F, 3, centering);
    expect(0., 1, centering);
  }
}

TEST_F(WriteVolume, NamesOfArraysAreMadeXml) {
  const std::vector<Volume> volumes = awkward_volumes<float>(1, awkward_description());
  write_volume(volumes, path("a.vti"), "<\"ü&\n\xff>");
  EXPECT_EQ(list_arrays(path("a.vti")).front().name, "<\"ü&_\xef\xbf\xbd>");
}

#endif

}  // namespace
}  // namespace pellucid::test_write_volume
