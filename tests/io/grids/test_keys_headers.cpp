// SPDX-License-Identifier: Apache-2.0
//
// Rows of the table "What descriptions say": NRRD, MetaImage, NIfTI and MGH, headers of Inviwo and
// Voreen.
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/described_keys.h"

namespace pellucid::test_keys_headers {
namespace {

using test::bytes_of;
using test::counting;
using test::DescribedKeys;
using test::expect_counting;
using test::expect_near;
using test::value_at;
using test::world_of;

/// What reading a file tells.
std::vector<std::string> notes_of(const std::filesystem::path& path) {
  std::vector<std::string> notes;
  ReadOptions options;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  read_components(path, options);
  return notes;
}

std::string dat(const std::string& more) {
  return "RawFile: v.raw\nResolution: 5 4 3\nFormat: FLOAT32\n" + more;
}
std::string ivf(const std::string& more) {
  return "<InviwoVolume version=\"2\"><RawFile content=\"v.raw\"/><Format content=\"FLOAT32\"/>"
         "<Dimension x=\"5\" y=\"4\" z=\"3\"/>" +
         more + "</InviwoVolume>";
}
std::string vvd(const std::string& items) {
  return "<VoreenData><Volumes><Volume><RawData filename=\"v.raw\" format=\"float\" x=\"5\" "
         "y=\"4\" "
         "z=\"3\"/><MetaData>" +
         items + "</MetaData></Volume></Volumes></VoreenData>";
}
std::string item(const std::string& name, const std::string& value) {
  return "<MetaItem name=\"" + name + "\"><value " + value + "/></MetaItem>";
}

#define DAT_ROW(name, key, treatment) \
  PELLUCID_DESCRIBED_KEY(dat_##name, "Inviwo and Voreen headers", key, treatment)

DAT_ROW(spacing, "Spacing", honored) {
  write("v.raw", bytes_of(counting()));
  const Volume volume = read_volume(write("a.dat", dat("Spacing: 1 2 3\n")));
  expect_near(volume.description().placement.spacing, {1, 2, 3});
  expect_near(read_volume(write("a.vvd", vvd(item("Spacing", "x=\"1\" y=\"2\" z=\"3\""))))
                  .description()
                  .placement.spacing,
              {1, 2, 3});
}
DAT_ROW(thickness, "SliceThickness", honored) {
  write("v.raw", bytes_of(counting()));
  expect_near(world_of(read_volume(write("a.dat", dat("SliceThickness: 1 2 3\n"))), 4, 3, 2),
              {4, 6, 6});
}
DAT_ROW(dimensions, "Dimensions", honored) {
  write("v.raw", bytes_of(counting()));
  expect_counting(
      read_volume(write("a.dat", "RawFile: v.raw\nDimensions: 5 4 3\nFormat: FLOAT32\n")), "f32");
}
DAT_ROW(order, "ByteOrder", honored) {
  write("v.raw", test::swapped_bytes_of(counting()));
  expect_counting(read_volume(write("a.dat", dat("ByteOrder: BigEndian\n"))), "f32");
  expect_counting(read_volume(write("a.ivf", ivf("<ByteOrder content=\"1\"/>"))), "f32");
}
DAT_ROW(byte_offset, "ByteOffset", honored) {
  write("v.raw", "12345" + bytes_of(counting()));
  expect_counting(read_volume(write("a.dat", dat("ByteOffset: 5\n"))), "f32");
  expect_counting(read_volume(write("a.ivf", ivf("<ByteOffset content=\"5\"/>"))), "f32");
}
DAT_ROW(sequences, "Sequences", honored) {
  write("v.raw", bytes_of(counting()) + bytes_of(counting()));
  EXPECT_EQ(read_components(write("a.dat", dat("Sequences: 2\n"))).size(), 2u);
}
DAT_ROW(list, "DatFile", refused) {
  write("a.dat", "DatFile: b.dat\n");
  expect_refused([&] { read_volume(path("a.dat")); }, "DatFile");
}
DAT_ROW(basis, "BasisVector1", honored) {
  write("v.raw", bytes_of(counting()));
  const Volume volume = read_volume(
      write("a.dat", dat("BasisVector1: 5 0 0\nBasisVector2: 0 8 0\nBasisVector3: 0 0 9\n")));
  expect_near(volume.world_corners()[7], {2.5, 4, 4.5});
}
DAT_ROW(offset, "Offset", honored) {
  write("v.raw", bytes_of(counting()));
  expect_near(read_volume(write("a.dat", dat("Offset: 7 8 9\n"))).world_corners()[0], {7, 8, 9});
  expect_near(world_of(read_volume(write("a.vvd", vvd(item("Offset", "x=\"1\" y=\"2\" z=\"3\"")))),
                       0, 0, 0),
              {1, 2, 3});
}
DAT_ROW(world, "WorldVector1", honored) {
  write("v.raw", bytes_of(counting()));
  expect_near(read_volume(write("a.dat", dat("Offset: 0 0 0\nWorldVector1: 1 0 0 50\n")))
                  .world_corners()[0],
              {50, 0, 0});
}
DAT_ROW(value_range, "ValueRange", honored) {
  write("v.raw", bytes_of(counting()));
  const auto last = [](const Volume& volume) { return test::value_at(volume, 4, 3, 2); };
  EXPECT_EQ(last(read_volume(write("a.dat", dat("DataRange: 0 59\nValueRange: 0 118\n")))), 118);
  EXPECT_EQ(last(read_volume(write("a.ivf", ivf("<DataRange x=\"0\" y=\"59\"/>"
                                                "<ValueRange x=\"0\" y=\"118\"/>")))),
            118);
  expect_told(notes_of(write("a.dat", dat("ValueRange: 0 118\n"))), "ValueRange");
}
DAT_ROW(data_range, "DataRange", honored) {
  write("v.raw", bytes_of(counting()));
  expect_counting(read_volume(write("a.dat", dat("DataRange: 0 100\n"))), "f32");
  EXPECT_EQ(test::value_at(read_volume(write("a.dat", dat("DataRange: 0 100\nValueRange: 0 10\n"))),
                           0, 2, 2),
            5);
}
DAT_ROW(unit, "Unit", told) {
  write("v.raw", bytes_of(counting()));
  expect_told(notes_of(write("a.dat", dat("Unit: HU\n"))), "HU (Unit)");
  expect_told(notes_of(write("a.ivf", ivf("<ValueUnit content=\"HU\"/>"))), "HU (Unit)");
}
DAT_ROW(swizzle, "SwizzleMask", told) {
  write("v.raw", bytes_of(counting()));
  expect_told(notes_of(write("a.dat", dat("SwizzleMask: bgra\n"))), "SwizzleMask");
  expect_told(notes_of(write("a.ivf", ivf("<SwizzleMask content=\"bgra\"/>"))), "SwizzleMask");
  EXPECT_TRUE(notes_of(write("a.dat", dat("SwizzleMask: rgba\nInterpolation: Linear\nModality: "
                                          "CT\nWrapping: Clamp Clamp Clamp\n")))
                  .empty());
}
DAT_ROW(interpolation, "Interpolation", told) {
  write("v.raw", bytes_of(counting()));
  expect_told(notes_of(write("a.dat", dat("Interpolation: Nearest\n"))), "Interpolation");
}
DAT_ROW(grid_type, "GridType", told) {
  write("v.raw", bytes_of(counting()));
  // Keys that nobody knows stand in the same note.
  const std::vector<std::string> notes =
      notes_of(write("a.dat", dat("GridType: TETRAHEDRA\nFlipYZ: yes\nElevation: 3\n")));
  ASSERT_EQ(notes.size(), 1u);
  for (const char* key : {"GridType", "FlipYZ", "Elevation"}) expect_told(notes, key);
}
DAT_ROW(repeated, "a key twice", told) {
  write("v.raw", bytes_of(counting()));
  const auto file = write("a.dat", dat("Spacing: 1 2 3\nspacing: 2 2 2\nUnit: K\nUnit: K\n"));
  expect_told(notes_of(file), "Spacing (more than once)");
  expect_near(read_volume(file).description().placement.spacing, {1, 2, 3});
  const std::string twice = "<Dimension x=\"5\" y=\"4\" z=\"3\"/>";
  expect_told(notes_of(write("a.ivf", ivf(twice))), "Dimension (more than once)");
  const std::string spacing = item("Spacing", "x=\"1\" y=\"2\" z=\"3\"");
  expect_told(notes_of(write("a.vvd", vvd(spacing + spacing))), "Spacing (more than once)");
  EXPECT_TRUE(notes_of(write("a.vvd", vvd(spacing))).empty());
  for (const std::string& note : notes_of(file)) {
    EXPECT_FALSE(test::contains(note, "Unit (more than")) << note;
  }
}
DAT_ROW(ivf_basis, "BasisAndOffset", honored) {
  write("v.raw", bytes_of(counting()));
  const std::string basis =
      "<BasisAndOffset><col0 x=\"5\" y=\"0\" z=\"0\" w=\"0\"/><col1 x=\"0\" y=\"4\" z=\"0\" "
      "w=\"0\"/>"
      "<col2 x=\"0\" y=\"0\" z=\"3\" w=\"0\"/><col3 x=\"1\" y=\"2\" z=\"3\" "
      "w=\"1\"/></BasisAndOffset>";
  expect_near(read_volume(write("a.ivf", ivf(basis))).world_corners()[0], {1, 2, 3});
  const std::vector<std::string> notes =
      notes_of(write("a.ivf", ivf(basis + "<Flip content=\"1\"/>")));
  expect_told(notes, "Flip");
}
DAT_ROW(ivf_world, "WorldTransform", honored) {
  write("v.raw", bytes_of(counting()));
  const std::string world =
      "<WorldTransform><col3 x=\"7\" y=\"8\" z=\"9\" w=\"1\"/></WorldTransform>";
  expect_near(read_volume(write("a.ivf", ivf(world))).world_corners()[0], {7, 8, 9});
}
DAT_ROW(ivf_compression, "Compression", honored) {
  write("v.raw", test::gzipped(bytes_of(counting())));
  expect_counting(read_volume(write("a.ivf", ivf("<Compression content=\"1\"/>"))), "f32");
}
DAT_ROW(vvd_transformation, "Transformation", honored) {
  write("v.raw", bytes_of(counting()));
  const std::string moved =
      "<MetaItem name=\"Transformation\"><value.row0 x=\"1\" y=\"0\" z=\"0\" w=\"50\"/></MetaItem>";
  expect_near(world_of(read_volume(write("a.vvd", vvd(moved))), 0, 0, 0), {50, 0, 0});
  expect_told(
      notes_of(write("a.vvd", vvd(item("Tilt", "x=\"1\"") + item("PatientName", "x=\"1\"")))),
      "Tilt");
}
DAT_ROW(vvd_mapping, "RealWorldMapping", honored) {
  write("v.raw", bytes_of(counting()));
  EXPECT_EQ(test::value_at(read_volume(write(
                               "a.vvd", vvd(item("RealWorldMapping", "scale=\"2\" offset=\"1\"")))),
                           4, 3, 2),
            119);
}

#define NIFTI_ROW(name, key, treatment) \
  PELLUCID_DESCRIBED_KEY(nifti_##name, "NIfTI and MGH", key, treatment)

NIFTI_ROW(qform, "qform_code", honored) {
  test::NiftiFile file;
  file.qform_code = 1;
  file.qform = {0, 0, 0, 10, 20, 30};
  expect_near(world_of(read_volume(write("a.nii", file.with(bytes_of(counting())))), 0, 0, 0),
              {-10, -20, 30});
  file.qform_code = 0;
  expect_told(notes_of(write("a.nii", file.with(bytes_of(counting())))), "qform_code");
}
NIFTI_ROW(sform, "sform_code", honored) {
  test::NiftiFile file;
  file.sform_code = 1;
  file.sform = {1, 0, 0, 10, 0, 2, 0, 20, 0, 0, 3, 30};
  expect_near(world_of(read_volume(write("a.nii", file.with(bytes_of(counting())))), 0, 0, 0),
              {-10, -20, 30});
}
NIFTI_ROW(slope, "scl_slope", honored) {
  test::NiftiFile file;
  file.slope = 2;
  file.intercept = 1;
  EXPECT_EQ(test::value_at(read_volume(write("a.nii", file.with(bytes_of(counting())))), 4, 3, 2),
            119);
}
NIFTI_ROW(units, "xyzt_units", honored) {
  test::NiftiFile file;
  file.sform_code = 1;
  file.sform = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0};
  file.units = 3;
  expect_near(world_of(read_volume(write("a.nii", file.with(bytes_of(counting())))), 4, 0, 0),
              {-0.004, 0, 0});
  file.units = 6;
  expect_told(notes_of(write("a.nii", file.with(bytes_of(counting())))), "xyzt_units 6");
  file.units = 0;
  expect_told(notes_of(write("a.nii", file.with(bytes_of(counting())))), "xyzt_units 0");
  file.units = 2;
  EXPECT_TRUE(notes_of(write("a.nii", file.with(bytes_of(counting())))).empty());
}
NIFTI_ROW(intent, "intent_code", told) {
  test::NiftiTwoFile file;
  file.qform_code = 1;
  file.intent = 1002;
  expect_told(notes_of(write("a.nii", file.with(bytes_of(counting())))), "intent_code 1002");
  file.intent = 3002;
  write("a.nii", file.with(bytes_of(counting())));
  expect_refused([&] { read_volume(path("a.nii")); }, "CIFTI");
}
NIFTI_ROW(orient, "orient", told) {
  test::NiftiFile file;
  file.magic = std::string(4, '\0');
  file.vox_offset = 0;
  std::string header = file.header();
  header[252] = 2;
  write("a.img", bytes_of(counting()));
  expect_told(notes_of(write("a.hdr", header)), "orient 2");
}
NIFTI_ROW(origin, "originator", honored) {
  test::NiftiFile file;
  file.magic = std::string(4, '\0');
  file.vox_offset = 0;
  std::string header = file.header();
  for (std::size_t a = 0; a < 3; ++a) file.put(header, 253 + 2 * a, std::int16_t{2});
  write("a.img", bytes_of(counting()));
  expect_near(world_of(read_volume(write("a.hdr", header)), 1, 1, 1), {0, 0, 0});
}
NIFTI_ROW(ranges, "cal_max", told) {
  test::NiftiFile file;
  file.magic = std::string(4, '\0');
  file.vox_offset = 0;
  std::string header = file.header();
  file.put(header, 124, 1.0F);
  file.put(header, 140, std::int32_t{255});
  write("a.img", bytes_of(counting()));
  expect_told(notes_of(write("a.hdr", header)), "cal_max");
}
NIFTI_ROW(good_ras, "goodRASFlag", honored) {
  test::MghFile file;
  const std::string values = test::swapped_bytes_of(counting());
  EXPECT_TRUE(notes_of(write("a.mgh", file.with(values))).empty());
  file.good_ras = 0;
  expect_told(notes_of(write("a.mgh", file.with(values))), "goodRASFlag");
}
NIFTI_ROW(frames, "nframes", honored) {
  test::MghFile file;
  file.dimensions[3] = 2;
  const std::string values = test::swapped_bytes_of(counting());
  EXPECT_EQ(read_components(write("a.mgh", file.with(values + values))).size(), 2u);
}

#ifdef PELLUCID_HAVE_ITK

std::string nrrd(const std::string& more, const std::string& type = "float") {
  return "NRRD0005\ntype: " + type +
         "\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: raw\n" + more + "\n" +
         bytes_of(counting());
}
const char* const place = "space directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (10,20,30)\n";

#define NRRD_ROW(name, key, treatment) PELLUCID_DESCRIBED_KEY(nrrd_##name, "NRRD", key, treatment)

NRRD_ROW(space, "space", honored) {
  expect_near(
      world_of(read_volume(write("a.nrrd", nrrd("space: RAS\n" + std::string(place)))), 4, 3, 2),
      {-14, -26, 36});
  write("a.nrrd", nrrd("space: scanner-xyz\n" + std::string(place)));
  EXPECT_EQ(world_space(path("a.nrrd")), "scanner-xyz");
}
NRRD_ROW(directions, "space directions", honored) {
  expect_near(world_of(read_volume(write("a.nrrd", nrrd(place))), 4, 3, 2), {14, 26, 36});
}
NRRD_ROW(origin, "space origin", honored) {
  expect_near(world_of(read_volume(write("a.nrrd", nrrd(place))), 0, 0, 0), {10, 20, 30});
}
NRRD_ROW(dimension, "space dimension", honored) {
  const std::string four =
      "space dimension: 4\nspace directions: (1,0,0,0) (0,2,0,0) (0,0,3,0)\nspace origin: "
      "(10,20,30,1)\n";
  expect_near(world_of(read_volume(write("a.nrrd", nrrd(four))), 4, 3, 2), {14, 26, 36});
}
NRRD_ROW(spacings, "spacings", honored) {
  expect_near(world_of(read_volume(write("a.nrrd", nrrd("spacings: 1 2 3\n"))), 4, 3, 2),
              {4, 6, 6});
}
NRRD_ROW(words, "words in the place of numbers", refused) {
  for (const char* line : {"spacings: 1,5 2 3", "spacings: 1mm 2 3", "axis mins: 1 2,5 3"}) {
    write("a.nrrd", nrrd(std::string(line) + "\n"));
    expect_refused([&] { read_volume(path("a.nrrd")); }, line);
  }
  expect_near(
      read_volume(write("a.nrrd", nrrd("spacings: +1 2e0 3.\n"))).description().placement.spacing,
      {1, 2, 3});
}
NRRD_ROW(mins, "axis mins", honored) {
  expect_near(world_of(read_volume(write("a.nrrd", nrrd("centerings: node node node\nspacings: 1 2 "
                                                        "3\naxis mins: 10 20 30\n"))),
                       0, 0, 0),
              {10, 20, 30});
  expect_told(notes_of(write("a.nrrd", nrrd("axis mins: 10 20 30\n"))), "axis mins say where");
  const auto unsaid = write("a.nrrd", nrrd("spacings: 1 2 3\naxis mins: 10 20 30\n"));
  expect_told(notes_of(unsaid), "its centerings are not said");
  expect_near(world_of(read_volume(unsaid), 0, 0, 0), {10.5, 21, 31.5});
}
NRRD_ROW(maxs, "axis maxs", refused) {
  write("a.nrrd", nrrd("axis mins: 10 20 30\naxis maxs: 14 26 36\n"));
  expect_refused([&] { read_volume(path("a.nrrd")); }, "range of the axes");
  const auto both = [&](const std::string& more) {
    return notes_of(write("a.nrrd", nrrd("spacings: 1 2 3\naxis mins: 10 20 30\n" + more)));
  };
  EXPECT_TRUE(both("axis maxs: 14 26 36\ncenterings: node node node\n").empty());
  expect_told(both("axis maxs: 14 26 40\n"), "distances of 5 along axis 3");
  expect_told(both("axis maxs: 14 26 36\ncenterings: cell cell cell\n"),
              "distances of 0.8 along axis 1, but its spacings say 1");
}
NRRD_ROW(centerings, "centerings", honored) {
  EXPECT_EQ(
      read_volume(write("a.nrrd", nrrd("centerings: cell cell cell\n"))).description().centering,
      Centering::cell);
  expect_told(notes_of(path("a.nrrd")), "values are those of cells");
  EXPECT_TRUE(notes_of(write("a.nrrd", nrrd("centerings: node node node\n"))).empty());
  write("a.nrrd", nrrd("centerings: cell node node\n"));
  expect_refused([&] { read_volume(path("a.nrrd")); }, "give the centering");
  // An axis of components has none.
  std::string two = nrrd("kinds: vector domain domain domain\ncenterings: none cell cell cell\n");
  two.replace(two.find("dimension: 3"), 12, "dimension: 4");
  two.replace(two.find("5 4 3"), 5, "2 5 2 3");
  EXPECT_EQ(read_components(write("a.nrrd", two)).front().description().centering, Centering::cell);
}
NRRD_ROW(kinds, "kinds", honored) {
  std::string two = nrrd("kinds: vector domain domain domain\n");
  two.replace(two.find("dimension: 3"), 12, "dimension: 4");
  two.replace(two.find("5 4 3"), 5, "2 5 2 3");
  EXPECT_EQ(read_components(write("a.nrrd", two)).size(), 2u);
  expect_told(notes_of(write("a.nrrd", nrrd("kinds: domain domain time\n"))),
              "axis 3 is time, no axis of space; it is read as z");
  write("a.nrrd", nrrd("kinds: vector domain domain\n"));
  expect_refused([&] { read_volume(path("a.nrrd")); }, "an image of 2 axes");
  EXPECT_TRUE(notes_of(write("a.nrrd", nrrd("kinds: space domain ???\n"))).empty());
  std::string four = nrrd("");
  four.replace(four.find("dimension: 3"), 12, "dimension: 4");
  four.replace(four.find("5 4 3"), 5, "5 2 3 2");
  std::vector<std::string> notes;
  ReadOptions options;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  EXPECT_EQ(read_components(write("a.nrrd", four), options).size(), 2u);
  expect_told(notes, "do not say what axis 4 is");
}
/// Returns a file with two values at each point. The first ones are counting().
std::string beside_each_other(const std::string& kinds, const std::string& more) {
  std::string header = nrrd("kinds: " + kinds + "\n" + more);
  header.erase(header.size() - bytes_of(counting()).size());
  header.replace(header.find("dimension: 3"), 12, "dimension: 4");
  header.replace(header.find("5 4 3"), 5, "2 5 4 3");
  std::vector<float> values;
  for (const float value : counting()) values.insert(values.end(), {value, value + 100});
  return header + bytes_of(values);
}
NRRD_ROW(first_axis, "kinds: time in front", honored) {
  for (const char* kinds : {"time space space space", "??? domain domain domain"}) {
    for (const char* more : {"", "spacings: 1 1 2 3\n", "spacings: nan 1 2 3\n"}) {
      SCOPED_TRACE(std::string(kinds) + more);
      const std::vector<Volume> both =
          read_components(write("a.nrrd", beside_each_other(kinds, more)));
      ASSERT_EQ(both.size(), 2u);
      expect_counting(both[0], "f32");
      EXPECT_EQ(value_at(both[1], 4, 3, 2), 159);
      EXPECT_EQ(world_of(both[0], 0, 0, 1).z, *more == '\0' ? 1 : 3);
    }
  }
  // The second of four: 5 steps of 2 x 4 x 3 values.
  EXPECT_EQ(
      read_components(write("a.nrrd", beside_each_other("space time space space", ""))).size(), 5u);
  write("a.nrrd", beside_each_other("time domain domain list", ""));
  expect_refused([&] { read_components(path("a.nrrd")); },
                 "axis 1 is time and axis 4 holds components");
  std::vector<std::string> notes;
  ReadOptions options;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  read_components(write("a.nrrd", beside_each_other("list domain domain time", "")), options);
  expect_told(notes, "axis 4 is time, no axis of space; it is read as z");
}
NRRD_ROW(frame, "measurement frame", told) {
  expect_told(notes_of(write("a.nrrd", nrrd("space: LPS\n" + std::string(place) +
                                            "measurement frame: (1,0,0) (0,0,1) (0,1,0)\n"))),
              "measurement frame");
}
NRRD_ROW(old_min, "old min", told) {
  const std::vector<std::string> notes =
      notes_of(write("a.nrrd", nrrd("old min: -1000\nold max: 3000\nsample units: \"HU\"\n")));
  ASSERT_EQ(notes.size(), 1u);
  for (const char* key : {"old min", "old max", "sample units"}) expect_told(notes, key);
}
NRRD_ROW(sample_units, "sample units", told) {
  expect_told(notes_of(write("a.nrrd", nrrd("sample units: \"HU\"\n"))), "sample units");
}
NRRD_ROW(units, "units", told) {
  expect_told(notes_of(write("a.nrrd", nrrd("units: \"mm\" \"mm\" \"um\"\n"))), "units");
  EXPECT_TRUE(notes_of(write("a.nrrd", nrrd("units: \"mm\" \"mm\" \"mm\"\ncontent: x\n"))).empty());
}
NRRD_ROW(pair, "key:=value", told) {
  expect_told(notes_of(write("a.nrrd", nrrd("RescaleSlope:=2\nmodality:=CT\n"))), "RescaleSlope");
  EXPECT_TRUE(notes_of(write("a.nrrd", nrrd("modality:=CT\n# remark:=x\n"))).empty());
}

std::string mha(const std::string& more, const std::string& spacing = "ElementSpacing = 1 2 3\n") {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" +
         more + spacing + "DimSize = 5 4 3\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n" +
         bytes_of(counting());
}

#define MHA_ROW(name, key, treatment) \
  PELLUCID_DESCRIBED_KEY(mha_##name, "MetaImage", key, treatment)

MHA_ROW(matrix, "TransformMatrix", honored) {
  expect_near(world_of(read_volume(write("a.mha", mha("TransformMatrix = -1 0 0 0 -1 0 0 0 1\n"))),
                       4, 3, 2),
              {-4, -6, 6});
}
MHA_ROW(offset, "Offset", honored) {
  expect_near(world_of(read_volume(write("a.mha", mha("Offset = 7 8 9\n"))), 0, 0, 0), {7, 8, 9});
}
MHA_ROW(spacing, "ElementSpacing", honored) {
  expect_near(world_of(read_volume(write("a.mha", mha(""))), 4, 3, 2), {4, 6, 6});
}
MHA_ROW(size, "ElementSize", told) {
  expect_told(notes_of(write("a.mha", mha("ElementSize = 1 2 4\n"))), "ElementSize");
  EXPECT_TRUE(notes_of(write("a.mha", mha("ElementSize = 1 2 3\n"))).empty());
  // Alone it is the spacing.
  const auto alone = write("a.mha", mha("ElementSize = 1 2 4\n", ""));
  EXPECT_TRUE(notes_of(alone).empty());
  expect_near(world_of(read_volume(alone), 4, 3, 2), {4, 6, 8});
}
MHA_ROW(order, "ElementByteOrderMSB", honored) {
  std::string big = mha("");
  big.replace(big.find("BinaryDataByteOrderMSB = False"), 30, "ElementByteOrderMSB = True");
  big.replace(big.size() - 240, 240, test::swapped_bytes_of(counting()));
  expect_counting(read_volume(write("a.mha", big)), "f32");
}
MHA_ROW(orientation, "AnatomicalOrientation", told) {
  expect_told(notes_of(write("a.mha", mha("AnatomicalOrientation = LPI\n"))),
              "AnatomicalOrientation = LPI");
  const std::string turned = "TransformMatrix = -1 0 0 0 -1 0 0 0 1\n";
  EXPECT_TRUE(notes_of(write("a.mha", mha(turned + "AnatomicalOrientation = LPI\n"))).empty());
  EXPECT_TRUE(notes_of(write("a.mha", mha("AnatomicalOrientation = RAI\n"))).empty());
  EXPECT_TRUE(notes_of(write("a.mha", mha(turned + "AnatomicalOrientation = ???\n"))).empty());
}
MHA_ROW(center, "CenterOfRotation", told) {
  expect_told(notes_of(write("a.mha", mha("CenterOfRotation = 1 0 0\n"))), "CenterOfRotation");
  EXPECT_TRUE(notes_of(write("a.mha", mha("CenterOfRotation = 0 0 0\n"))).empty());
}
MHA_ROW(slope, "ElementToIntensityFunctionSlope", told) {
  expect_told(notes_of(write("a.mha", mha("ElementToIntensityFunctionSlope = 2\n"))),
              "ElementToIntensityFunctionSlope");
  EXPECT_TRUE(notes_of(write("a.mha", mha("ElementToIntensityFunctionSlope = 1\n"
                                          "ElementToIntensityFunctionOffset = 0\n")))
                  .empty());
}
MHA_ROW(shift, "ElementToIntensityFunctionOffset", told) {
  expect_told(notes_of(write("a.mha", mha("ElementToIntensityFunctionOffset = -1024\n"))),
              "ElementToIntensityFunctionOffset");
}
MHA_ROW(units, "DistanceUnits", told) {
  expect_told(notes_of(write("a.mha", mha("DistanceUnits = um\n"))), "DistanceUnits");
  EXPECT_TRUE(notes_of(write("a.mha", mha("DistanceUnits = mm\nModality = MET_MOD_CT\n"))).empty());
}
MHA_ROW(words, "words in the place of numbers", refused) {
  const char* const lines[] = {"HeaderSize = 12,5", "HeaderSize = 7.5",
                               "TransformMatrix = 1 0 0 0 1 0 0 0 1,0", "Offset = 1 2 3 4",
                               "ElementNumberOfChannels = 1,2"};
  for (const char* line : lines) {
    write("a.mha", mha(std::string(line) + "\n"));
    expect_refused([&] { read_volume(path("a.mha")); }, line);
  }
  write("a.mha", mha("", "ElementSpacing = 1,5 2 3\n"));
  expect_refused([&] { read_volume(path("a.mha")); }, "with a point before decimals");
}
MHA_ROW(repeated, "a key twice", told) {
  expect_told(notes_of(write("a.mha", mha("Offset = 1 2 3\nOffset = 7 8 9\n"))),
              "Offset (more than once)");
  EXPECT_TRUE(notes_of(write("a.mha", mha("Offset = 1 2 3\nOffset = 1 2 3\n"))).empty());
}
MHA_ROW(header_size, "HeaderSize", honored) {
  write("v.raw", std::string(7, 'x') + bytes_of(counting()));
  std::string text = mha("HeaderSize = 7\n");
  text = text.substr(0, text.find("LOCAL")) + "v.raw\n";
  EXPECT_EQ(test::value_at(read_volume(write("a.mhd", text)), 4, 3, 2), 59);
  write("v.raw", bytes_of(counting()));
  expect_refused([&] { read_volume(path("a.mhd")); }, "a.mhd: the header says \"HeaderSize = 7\"");
  // The values of the header's own file begin behind it.
  expect_told(notes_of(write("a.mha", mha("HeaderSize = 7\n"))), "HeaderSize = 7");
}
MHA_ROW(per_slice, "HeaderSizePerSlice", refused) {
  write("a.mha", mha("HeaderSizePerSlice = 12\n"));
  expect_refused([&] { read_volume(path("a.mha")); }, "HeaderSizePerSlice");
}

#endif

}  // namespace
}  // namespace pellucid::test_keys_headers
