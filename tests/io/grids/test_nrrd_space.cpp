// SPDX-License-Identifier: Apache-2.0
//
// Spaces of NRRD: of time as well, and those of no patient.
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

#ifdef PELLUCID_HAVE_ITK

namespace pellucid::test_nrrd_space {
namespace {

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::world_of;

class NrrdSpaceTest : public test::ScratchFolder {
 protected:
  std::string error(const std::string& header) {
    write("a.nrrd", header + bytes_of(counting()));
    return error_of([&] { read_volume(path("a.nrrd")); });
  }
};

// "right-anterior-superior-time" and the like: the fourth coordinate is time.
TEST_F(NrrdSpaceTest, SpacesOfFourAxesAreTurnedToo) {
  const auto four = [](const std::string& space, const std::string& directions,
                       const std::string& sizes, const std::string& more = "") {
    return "NRRD0005\ntype: float\ndimension: 4\nsizes: " + sizes +
           "\nendian: little\nencoding: raw\nspace: " + space +
           "\nspace directions: " + directions + "\nspace origin: (10,20,30,5)\n" + more + "\n";
  };
  std::vector<float> both = counting();
  for (int i = 0; i < 60; ++i) both.push_back(100 + static_cast<float>(i));
  std::vector<float> side_by_side(120);
  for (std::size_t i = 0; i < 120; ++i) side_by_side[i] = both[i % 2 * 60 + i / 2];
  const std::string last = "(1,0,0,0) (0,2,0,0) (0,0,3,0) (0,0,0,0.5)";
  const std::string first = "(0,0,0,0.5) (1,0,0,0) (0,2,0,0) (0,0,3,0)";
  struct Case {
    const char* space;
    Vec3<double> at;
    const char* name;
  };
  for (const Case& c :
       {Case{"right-anterior-superior-time", {-14, -26, 36}, "LPS"},
        Case{"RAST", {-14, -26, 36}, "LPS"},
        Case{"left-anterior-superior-time", {14, -26, 36}, "LPS"},
        Case{"LAST", {14, -26, 36}, "LPS"},
        Case{"left-posterior-superior-time", {14, 26, 36}, "LPS"},
        Case{"LPST", {14, 26, 36}, "LPS"}, Case{"scanner-xyz-time", {14, 26, 36}, "scanner-xyz"},
        Case{"3D-right-handed-time", {14, 26, 36}, "3D-right-handed"},
        Case{"3D-left-handed-time", {14, 26, 36}, "3D-left-handed"}}) {
    SCOPED_TRACE(c.space);
    for (const bool is_last : {true, false}) {
      const std::string kinds =
          is_last ? "kinds: domain domain domain time\n" : "kinds: time domain domain domain\n";
      for (const std::string& more : {std::string(), kinds}) {
        write("t.nrrd", four(c.space, is_last ? last : first, is_last ? "5 4 3 2" : "2 5 4 3",
                             more + "space units: \"mm\" \"mm\" \"mm\" \"s\"\n") +
                            bytes_of(is_last ? both : side_by_side));
        const std::vector<Volume> steps = read_components(path("t.nrrd"));
        ASSERT_EQ(steps.size(), 2u);
        expect_counting(steps[0], "f32");
        EXPECT_EQ(test::value_at(steps[1], 4, 3, 2), 159);
        expect_near(world_of(steps[0], 4, 3, 2), c.at);
        EXPECT_EQ(world_space(path("t.nrrd")), c.name);
      }
    }
  }
  // One step, three axes of four numbers, and a list of files.
  expect_near(
      world_of(read_volume(write("o.nrrd", four("RAST", last, "5 4 3 1") + bytes_of(counting()))),
               4, 3, 2),
      {-14, -26, 36});
  std::string three = four("RAST", "(1,0,0,0) (0,2,0,0) (0,0,3,0)", "5 4 3");
  three.replace(three.find("dimension: 4"), 12, "dimension: 3");
  expect_near(world_of(read_volume(write("u.nrrd", three + bytes_of(counting()))), 4, 3, 2),
              {-14, -26, 36});
  for (int k = 0; k < 6; ++k) {
    write("s" + std::to_string(k), bytes_of(both).substr(static_cast<std::size_t>(80 * k), 80));
  }
  std::string listed = four("RAST", last, "5 4 3 2");
  listed.replace(listed.size() - 1, 1, "data file: LIST 2\ns0\ns1\ns2\ns3\ns4\ns5\n");
  write("l.nhdr", listed);
  expect_near(world_of(read_components(path("l.nhdr"))[1], 4, 3, 2), {-14, -26, 36});
  // Time between the axes of space.
  std::string between;
  for (std::size_t row = 0; row < 12; ++row) {
    for (std::size_t step = 0; step < 2; ++step) {
      between += bytes_of(both).substr(240 * step + 20 * row, 20);
    }
  }
  const auto steps = read_components(write(
      "b.nrrd", four("RAST", "(1,0,0,0) (0,0,0,1) (0,2,0,0) (0,0,3,0)", "5 2 4 3") + between));
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(test::value_at(steps[1], 4, 3, 2), 159);
  EXPECT_EQ(test::value_at(steps[0], 4, 1, 1), 29);
  expect_near(world_of(steps[1], 4, 3, 2), {-14, -26, 36});
  // Through space and time at once.
  EXPECT_TRUE(contains(error(four("RAST", "(1,0,0,1) (0,2,0,0) (0,0,3,0) (0,0,0,1)", "5 4 3 2")),
                       "axis 1 runs through space and time"));
}

TEST_F(NrrdSpaceTest, SpacesThatAreNoPatientsAreNamed) {
  const std::string place = "space directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (10,20,30)\n";
  std::string notes;
  ReadOptions options;
  options.note = [&](const std::string& line) { notes += line + "\n"; };
  const auto space_of = [&](const std::string& fields) {
    notes.clear();
    write("a.nrrd",
          "NRRD0004\ntype: float\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: raw\n" +
              fields + "\n" + bytes_of(counting()));
    read_volume(path("a.nrrd"), options);
    return world_space(path("a.nrrd"));
  };
  EXPECT_EQ(space_of("space: right-anterior-superior\n" + place), "LPS");
  EXPECT_EQ(space_of("space: LAS\n" + place), "LPS");
  EXPECT_EQ(notes, "");
  EXPECT_EQ(space_of("space: 3D-left-handed\n" + place), "3D-left-handed");
  EXPECT_TRUE(contains(notes, "left-handed")) << notes;
  EXPECT_EQ(space_of("space: 3D-right-handed\n" + place), "3D-right-handed");
  EXPECT_EQ(space_of("space: scanner-xyz\n" + place), "scanner-xyz");
  EXPECT_EQ(notes, "");
  EXPECT_EQ(space_of("space dimension: 3\n" + place), "");
  EXPECT_EQ(space_of(place), "");
  EXPECT_EQ(space_of("space: scanner-xyz\nspacings: 1 2 3\n"), "scanner-xyz");
  EXPECT_EQ(space_of("spacings: 1 2 3\n"), "");
  EXPECT_EQ(notes, "");
  EXPECT_EQ(space_of("space: LPS\nspacings: 1 2 3\n"), "");
  EXPECT_TRUE(contains(notes, "no space directions")) << notes;
  EXPECT_FALSE(is_placed_in_lps(path("a.nrrd")));
}

}  // namespace
}  // namespace pellucid::test_nrrd_space

#endif
