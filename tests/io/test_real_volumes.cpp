// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/support/test_data.h"
#include "volume_files.h"

// Files of other programs, against the facts that stand in their manifest.
namespace pellucid::test_real_volumes {
namespace {

namespace fs = std::filesystem;

const fs::path data = test_data_folder();

struct Facts {
  const char* file;
  const char* type;
  std::array<int, 3> dimensions;
  std::array<double, 3> spacing;
  double minimum, maximum;
};

void expect_facts(const Facts& facts, const ReadOptions& options = {}) {
  SCOPED_TRACE(facts.file);
  if (!fs::exists(data / facts.file)) {
    GTEST_SKIP() << (data / facts.file).string() << " not found";
  }
  const Volume volume = read_volume(data / facts.file, options);
  EXPECT_EQ(type_name(volume.data()), facts.type);
  EXPECT_EQ(volume.description().dimensions, facts.dimensions);
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(volume.description().placement.spacing[a],
                facts.spacing[static_cast<std::size_t>(a)], 1e-4);
  }
  EXPECT_NEAR(volume.statistics().minimum, facts.minimum, 0.05);
  EXPECT_NEAR(volume.statistics().maximum, facts.maximum, 0.05);
  EXPECT_EQ(volume.statistics().nan, 0u);
}

class RealFile : public ::testing::TestWithParam<Facts> {};
TEST_P(RealFile, IsAsTheManifestSays) {
  expect_facts(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Own, RealFile,
    ::testing::Values(
        Facts{"structured/hdz2000.npy", "u8", {128, 128, 128}, {1, 1, 1}, 0, 255},
        // The thickness says 8.
        Facts{"dicom/cptac_sar_mr_3slice", "u16", {512, 512, 3}, {0.97656, 0.97656, 12}, 0, 346},
        Facts{"structured/cthead_tiff", "u16", {256, 256, 99}, {1, 1, 1}, 0, 3272},
        Facts{
            "structured/hydrogenatom/hydrogenatom.dat", "u8", {128, 128, 128}, {1, 1, 1}, 0, 250}));

TEST(RealVolumes, AnObliqueSeriesOfManyFiles) {
  const fs::path archive = data / "dicom/n2d_t1w.tar.xz";
  if (!fs::exists(archive)) GTEST_SKIP() << archive.string() << " not found";
  std::string pattern = (fs::temp_directory_path() / "pellucid_n2d_XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  const std::string command = "tar -xJf '" + archive.string() + "' -C '" + pattern + "'";
  if (std::system(command.c_str()) != 0) GTEST_SKIP() << "cannot unpack by: " << command;
  const Volume volume = read_volume(fs::path(pattern) / "n2d_t1w");
  const Volume by_file = read_volume(fs::path(pattern) / "n2d_t1w/N2D_0200.dcm");
  fs::remove_all(pattern);
  EXPECT_EQ(type_name(volume.data()), "i16");
  EXPECT_EQ(volume.description().dimensions, (std::array<int, 3>{274, 384, 384}));
  test::expect_near(volume.description().placement.spacing, {0.69999, 0.66667, 0.66667}, 1e-4);
  EXPECT_EQ(volume.statistics().minimum, 0);
  EXPECT_EQ(volume.statistics().maximum, 278);
  EXPECT_EQ(volume.data(), by_file.data());
  // Neighbors are alike only if the slices are in their order: of 384 files in any other, each
  // pair of neighbors would differ about as much as a slice from one far away.
  const auto difference = [&](int distance) {
    double sum = 0;
    for (int k = 0; k + distance < 384; k += 7) {
      for (int i = 0; i < 274; i += 3) {
        sum += std::abs(test::value_at(volume, i, 192, k) -
                        test::value_at(volume, i, 192, k + distance));
      }
    }
    return sum / (384 - distance);
  };
  EXPECT_LT(difference(1), 0.5 * difference(60));
}

TEST(RealVolumes, VectorsOfInviwo) {
  const fs::path crystal = data / "multivariate/Bi2O3/Bi2O3.dat";
  if (!fs::exists(crystal)) GTEST_SKIP() << crystal.string() << " not found";
  const std::vector<Volume> both = read_components(crystal);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NEAR(both[1].statistics().maximum, 0.69314718, 1e-8);
  test::expect_near(both[0].world_corners()[7] - both[0].world_corners()[0], {5.684, 5.684, 5.684});
}

#ifdef PELLUCID_HAVE_ITK
INSTANTIATE_TEST_SUITE_P(
    Medical, RealFile,
    ::testing::Values(
        Facts{"structured/fuel.nii.gz", "u8", {64, 33, 32}, {1, 1, 1}, 0, 255},
        Facts{"structured/engine.nii.gz", "u8", {256, 256, 128}, {1, 1, 1}, 0, 255},
        Facts{"structured/stent.nrrd", "f32", {128, 128, 256}, {1, 1, 1}, 0, 1},
        Facts{"structured/nucleon/nucleon.nrrd", "u8", {41, 41, 41}, {1, 1, 1}, 0, 249},
        Facts{"structured/headsq/quarter.nhdr", "i16", {64, 64, 93}, {3.2, 3.2, 1.5}, 0, 3926},
        Facts{"structured/HeadMRVolume/HeadMRVolume.mhd", "u8", {48, 62, 42}, {4, 4, 4}, 0, 255},
        Facts{"structured/mha.mha", "i16", {64, 64, 37}, {3.4375, 3.4375, 3.8}, 0, 6690},
        Facts{"structured/avg152T1_RL_nifti.nii.gz", "u8", {91, 109, 91}, {2, 2, 2}, 0, 255},
        Facts{"multivariate/dti/FA.nii.gz", "f32", {84, 92, 56}, {2.2, 2.2, 2.2}, 0, 1.2247},
        Facts{"multivariate/ms_patient07/GOLD.nii.gz", "u8", {182, 218, 182}, {1, 1, 1}, 0, 1}));
#endif

TEST(RealVolumes, HeaderlessFiles) {
  ReadOptions options;
  options.dimensions = {128, 128, 128};
  options.type = "u8";
  expect_facts(
      {"structured/hydrogenatom/hydrogenatom.raw", "u8", {128, 128, 128}, {1, 1, 1}, 0, 250},
      options);
  options.dimensions = {256, 256, 108};
  options.type = "i16";
  options.spacing = Vec3<double>{0.957031, 0.957031, 1.5};
  expect_facts({"structured/cranium_ct/matrix.dat",
                "i16",
                {256, 256, 108},
                {0.957031, 0.957031, 1.5},
                -1024,
                2986},
               options);
}

// One small volume in every type and both byte orders.
TEST(RealVolumes, OneVolumeInAllTypes) {
  const fs::path folder = data / "conformance/inviwo_types";
  if (!fs::exists(folder)) GTEST_SKIP() << folder.string() << " not found";
  const std::array<std::pair<const char*, const char*>, 8> types{{{"UINT8", "u8"},
                                                                  {"INT8", "i8"},
                                                                  {"UINT16", "u16"},
                                                                  {"INT16", "i16"},
                                                                  {"UINT32", "u32"},
                                                                  {"INT32", "i32"},
                                                                  {"FLOAT32", "f32"},
                                                                  {"FLOAT64", "f64"}}};
  for (const auto& [file, type] : types) {
    std::vector<double> first;
    for (const std::string order : {".LittleEndian", ".BigEndian"}) {
      const std::string bytes = std::string(type).ends_with('8') ? "" : order;
      SCOPED_TRACE(file + bytes);
      ReadOptions options;
      options.dimensions = {13, 7, 3};
      options.type = type;
      options.big_endian = order == ".BigEndian";
      const Volume volume =
          read_volume(folder / ("testdata." + std::string(file) + bytes + ".raw"), options);
      std::vector<double> values;
      for (int i = 0; i < 273; ++i) {
        values.push_back(test::value_at(volume, i % 13, i / 13 % 7, i / 91));
      }
      if (first.empty()) first = values;
      EXPECT_EQ(values, first);
    }
    EXPECT_LT(first.front(), first.back());
  }
}

#ifdef PELLUCID_HAVE_ITK

// The index whose value stands nearest to a world position; fails where the position is off the
// grid's points.
std::array<int, 3> index_at(const Volume& volume, const Vec3<double>& world) {
  const GridPlacement& p = volume.description().placement;
  const Vec3<double> offset = inverse(p.direction) * (world - p.origin);
  std::array<int, 3> index{};
  for (int a = 0; a < 3; ++a) {
    const double position = offset[a] / p.spacing[a];
    index[static_cast<std::size_t>(a)] = static_cast<int>(std::lround(position));
    EXPECT_NEAR(position, std::round(position), 1e-3);
  }
  return index;
}

double value_at_world(const Volume& volume, const Vec3<double>& world) {
  const auto [i, j, k] = index_at(volume, world);
  return test::value_at(volume, i, j, k);
}

void expect_same_in_the_world(const Volume& a, const Volume& b) {
  const auto [nx, ny, nz] = a.description().dimensions;
  for (int k = 0; k < nz; k += 5) {
    for (int j = 0; j < ny; j += 3) {
      for (int i = 0; i < nx; i += 7) {
        ASSERT_EQ(test::value_at(a, i, j, k), value_at_world(b, test::world_of(a, i, j, k)))
            << i << ' ' << j << ' ' << k;
      }
    }
  }
}

TEST(RealVolumes, EightOrientationsAreOneImage) {
  const fs::path folder = data / "conformance/nifti_space";
  if (!fs::exists(folder)) GTEST_SKIP() << folder.string() << " not found";
  const Volume reference = read_volume(folder / "RAS.nii.gz");
  EXPECT_NEAR(reference.statistics().maximum, 255 * 0.36296, 0.01);
  for (const char* name : {"LAS", "LPS", "LPI", "PSR", "AIL", "SAR", "IRP"}) {
    SCOPED_TRACE(name);
    expect_same_in_the_world(reference, read_volume(folder / (std::string(name) + ".nii.gz")));
  }
}

TEST(RealVolumes, LeftAndRightReferenceImagesAreOneImage) {
  if (!fs::exists(data / "structured"))
    GTEST_SKIP() << (data / "structured").string() << " not found";
  const Volume rl = read_volume(data / "structured/avg152T1_RL_nifti.nii.gz");
  expect_same_in_the_world(rl, read_volume(data / "structured/avg152T1_LR_nifti.nii.gz"));
  for (const char* half : {"hdr", "img"}) {
    expect_same_in_the_world(rl,
                             read_volume(data / ("structured/avg152T1_RL_pair/avg152T1_RL_nifti." +
                                                 std::string(half) + ".gz")));
  }
}

TEST(RealVolumes, TheSameBallInAllKindsOfNrrd) {
  const fs::path folder = data / "conformance/pynrrd";
  if (!fs::exists(folder)) GTEST_SKIP() << folder.string() << " not found";
  ReadOptions raw;
  raw.dimensions = {30, 30, 30};
  raw.type = "i16";
  const Volume ball = read_volume(folder / "BallBinary30x30x30.raw", raw);
  EXPECT_EQ(ball.statistics().maximum, 257);
  for (const char* name : {".nrrd", ".nhdr", "_gz.nrrd", ".nii.gz"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(read_volume(folder / (std::string("BallBinary30x30x30") + name)).data(), ball.data());
  }
#ifdef PELLUCID_HAVE_BZIP2
  EXPECT_EQ(read_volume(folder / "BallBinary30x30x30_bz2.nrrd").data(), ball.data());
#endif
  for (const char* name : {"test1d_ascii.nrrd", "test2d_ascii.nrrd", "test_simple4d_raw.nrrd"}) {
    SCOPED_TRACE(name);
    test::error_of([&] { read_volume(folder / name); });
  }
}

// Every value is x + y + z, the axes from the slowest.
TEST(RealVolumes, AllTypesOfInviwo) {
  const fs::path folder = data / "conformance/inviwo_types";
  if (!fs::exists(folder)) GTEST_SKIP() << folder.string() << " not found";
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".dat" && extension != ".ivf") continue;
    SCOPED_TRACE(entry.path().string());
    ++files;
    const Volume volume = read_volume(entry.path());
    EXPECT_EQ(volume.description().dimensions, (std::array<int, 3>{13, 7, 3}));
    EXPECT_EQ(volume.description().placement.spacing, (Vec3<double>{1, 1, 1}));
    for (int i = 0; i < 273; ++i) {
      const int x = i % 13, y = i / 13 % 7, z = i / 91;
      ASSERT_EQ(test::value_at(volume, x, y, z), x + y + z);
    }
  }
  EXPECT_EQ(files, 40);
}

#ifdef PELLUCID_HAVE_OPENVDB
TEST(RealVolumes, SmokeOfOpenVdb) {
  const fs::path smoke = data / "sparse_amr/smoke.vdb";
  if (!fs::exists(smoke)) GTEST_SKIP() << smoke.string() << " not found";
  const Volume volume = read_volume(smoke);
  EXPECT_EQ(volume.description().dimensions, (std::array<int, 3>{111, 222, 112}));
  EXPECT_NEAR(volume.description().placement.spacing.x, 0.47619, 1e-5);
  EXPECT_NEAR(volume.statistics().maximum, 5.715, 1e-3);
  EXPECT_EQ(volume.statistics().minimum, 0);
  const fs::path sphere = data / "sparse_amr/sphere.vdb";
  EXPECT_TRUE(test::contains(test::error_of([&] { read_volume(sphere); }), "ls_sphere (a level"));
}
#endif

TEST(RealVolumes, ComponentsAreVolumes) {
  const fs::path folder = data / "multivariate";
  if (!fs::exists(folder)) GTEST_SKIP() << folder.string() << " not found";

  const fs::path colors = folder / "ct_perfusion_rgb24.nii.gz";
  EXPECT_TRUE(test::contains(test::error_of([&] { read_volume(colors); }), "RGB"));
  const std::vector<Volume> rgb = read_components(colors);
  ASSERT_EQ(rgb.size(), 3u);
  const double sums[] = {17217466, 50015603, 44343336};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& values = std::get<DataArray<std::uint8_t>>(rgb[c].data());
    EXPECT_EQ(rgb[c].statistics().maximum, 255);
    EXPECT_EQ(std::accumulate(values.begin(), values.end(), 0.0), sums[c]) << c;
  }

  const fs::path directions = folder / "dti/V1.nii.gz";
  EXPECT_TRUE(
      test::contains(test::error_of([&] { read_volume(directions); }), "3 components (axis 4)"));
  EXPECT_EQ(component_count(directions), 3);
  const std::vector<Volume> v1 = read_components(directions);
  ASSERT_EQ(v1.size(), 3u);
  const double middle[] = {-0.9802985787391663, 0.1972721666097641, 0.009916640818119049};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(test::value_at(v1[c], 42, 46, 28), middle[c]) << c;
    EXPECT_NEAR(v1[c].description().placement.spacing.z, 2.2, 1e-6);
  }
  EXPECT_EQ(v1[0].world_corners(), read_volume(folder / "dti/FA.nii.gz").world_corners());
}
#endif

TEST(RealVolumes, ComponentsSideBySide) {
  const fs::path file = data / "multivariate/Bi2O3/Bi2O3.raw";
  if (!fs::exists(file)) GTEST_SKIP() << file.string() << " not found";
  ReadOptions options;
  options.dimensions = {80, 80, 80};
  options.type = "f32";
  options.components = 2;
  const std::vector<Volume> both = read_components(file, options);
  ASSERT_EQ(both.size(), 2u);
  for (const Volume& v : both) {
    EXPECT_EQ(v.statistics().minimum, 0);
    EXPECT_NEAR(v.statistics().maximum, 0.69314718, 1e-8);
  }
}

#ifdef PELLUCID_HAVE_ITK
// 166 MB behind 0.8 MB whose size the header has wrong.
TEST(RealVolumes, AMaskWithAStaleSize) {
  expect_facts(
      {"structured/k3d_mask/mask.mhd", "i16", {512, 512, 317}, {0.361328, 0.361328, 0.5}, 0, 1});
}

TEST(RealVolumes, TheBrainOfTheDemo) {
  const fs::path file = "/usr/share/mricron/templates/ch2.nii.gz";
  if (!fs::exists(file)) GTEST_SKIP() << file.string() << " not found (Debian: mricron-data)";
  const Volume brain = read_volume(file);
  EXPECT_EQ(type_name(brain.data()), "u8");
  EXPECT_EQ(brain.description().dimensions, (std::array<int, 3>{181, 217, 181}));
  test::expect_near(test::world_of(brain, 0, 0, 0), {90, 125, -71});
  test::expect_near(test::world_of(brain, 180, 216, 180), {-90, -91, 109});
  EXPECT_EQ(brain.statistics().maximum, 254);
}

#endif

}  // namespace
}  // namespace pellucid::test_real_volumes
