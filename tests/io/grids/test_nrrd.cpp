// SPDX-License-Identifier: Apache-2.0
#ifdef PELLUCID_HAVE_BZIP2
#include <bzlib.h>
#endif

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

#ifdef PELLUCID_HAVE_ITK

namespace pellucid::test_nrrd {
namespace {

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::world_of;

// The fields that every header here has, and then more.
std::string header(const std::string& more, const std::string& type = "float",
                   const std::string& encoding = "raw", const std::string& sizes = "5 4 3") {
  return "NRRD0004\n# by hand\ntype: " + type + "\ndimension: 3\nsizes: " + sizes +
         "\nendian: little\nencoding: " + encoding + "\n" + more;
}

#ifdef PELLUCID_HAVE_BZIP2
std::string bzipped(std::string bytes) {
  std::string packed(bytes.size() + 1000, '\0');
  auto size = static_cast<unsigned>(packed.size());
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, bytes.data(),
                                     static_cast<unsigned>(bytes.size()), 9, 0, 0),
            BZ_OK);
  packed.resize(size);
  return packed;
}
#endif

class NrrdTest : public test::ScratchFolder {
 protected:
  Volume parse(const std::string& fields, const std::string& values = bytes_of(counting()),
               const ReadOptions& options = {}) {
    return read_volume(write("a.nrrd", fields + "\n" + values), options);
  }
  std::string error(const std::string& fields, const std::string& values = bytes_of(counting())) {
    write("a.nrrd", fields + "\n" + values);
    return error_of([&] { read_volume(path("a.nrrd")); });
  }
  template <class Value>
  void expect_type(const std::string& name, const std::string& type) {
    SCOPED_TRACE(type);
    const std::vector<Value> values = counting<Value>();
    expect_counting(parse(header("", name), bytes_of(values)), type);
    expect_counting(parse(header("", name, "gzip"), test::gzipped(bytes_of(values))), type);
    std::string big = header("", name);
    big.replace(big.find("little"), 6, "big");
    expect_counting(parse(big, test::swapped_bytes_of(values)), type);
  }
};

TEST_F(NrrdTest, AllTypesInBothByteOrdersRawAndGzip) {
  expect_type<std::uint8_t>("unsigned char", "u8");
  expect_type<std::int8_t>("signed char", "i8");
  expect_type<std::uint16_t>("uint16", "u16");
  expect_type<std::int16_t>("short", "i16");
  expect_type<std::uint32_t>("unsigned int", "u32");
  expect_type<std::int32_t>("int32_t", "i32");
  expect_type<float>("float", "f32");
  expect_type<double>("double", "f64");
  // Whole numbers of 64 bits in the smallest type that holds them.
  expect_type<std::int64_t>("int64", "u8");
  expect_type<std::uint64_t>("unsigned long long", "u8");
}

TEST_F(NrrdTest, TextAndHexadecimal) {
  std::string text, hex;
  for (const float value : counting()) text += std::to_string(value) + "\n";
  for (const char c : bytes_of(counting())) {
    const unsigned byte = static_cast<unsigned char>(c);
    hex += "0123456789abcdef"[byte / 16];
    hex += "0123456789abcdef"[byte % 16];
  }
  expect_counting(parse(header("", "float", "ascii"), text), "f32");
  expect_counting(parse(header("", "float", "hex"), hex), "f32");
  error(header("", "float", "ascii"), text.substr(0, text.size() / 2));
  error(header("", "float", "hex"), hex.substr(0, 470));
}

TEST_F(NrrdTest, Detached) {
  write("v.raw", bytes_of(counting()));
  write("v.raw.gz", test::gzipped(bytes_of(counting())));
  for (int k = 0; k < 3; ++k) {
    write("slice" + std::to_string(k + 1) + ".raw",
          bytes_of(counting()).substr(static_cast<std::size_t>(80 * k), 80));
  }
  write("s.raw", "1234567" + bytes_of(counting()));
  write("a.nhdr", header("data file: v.raw\n"));
  write("b.nhdr", header("data file: v.raw.gz\n", "float", "gzip"));
  write("c.nhdr", header("data file: slice%d.raw 1 3 1\n"));
  write("d.nhdr", header("data file: s.raw\nbyte skip: 7\n"));
  write("e.nhdr", header("data file: LIST\nslice1.raw\nslice2.raw\nslice3.raw\n"));
  for (const char* name : {"a.nhdr", "b.nhdr", "c.nhdr", "d.nhdr", "e.nhdr"}) {
    SCOPED_TRACE(name);
    expect_counting(read_volume(path(name)), "f32");
  }
  write("f.nhdr", header("data file: none.raw\n"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("f.nhdr")); }), "none.raw"));
  write("v.raw", bytes_of(counting()).substr(4));
  error_of([&] { read_volume(path("a.nhdr")); });
}

// A file of another format that is named as one of values begins with its own header.
TEST_F(NrrdTest, BytesThatAreLeftOverAreTold) {
  std::string notes;
  ReadOptions options;
  options.note = [&](const std::string& line) { notes += line + "\n"; };
  const auto note_of = [&](const std::string& more, const std::string& type = "float") {
    notes.clear();
    read_volume(write("n.nhdr", header("data file: s.raw\n" + more, type)), options);
    return notes;
  };
  write("s.raw", std::string(352, 'h') + bytes_of(counting()));
  EXPECT_TRUE(contains(note_of(""), "s.raw: has 352 bytes more") &&
              contains(notes, "\"byte skip: -1\""))
      << notes;
  EXPECT_EQ(note_of("byte skip: -1\n"), "");
  expect_counting(read_volume(path("n.nhdr"), options), "f32");
  EXPECT_EQ(note_of("byte skip: 352\n"), "");
  // NrrdIO would tell of a seek that failed.
  write("short.raw", "1234");
  write("short.nhdr", header("data file: short.raw\nbyte skip: -1\n", "float"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("short.nhdr")); }), "cut off"));
  EXPECT_TRUE(contains(note_of("byte skip: 300\n"), "52 bytes more")) << notes;
  for (const char* type : {"unsigned int", "int32_t", "uint", "signed int"}) {
    EXPECT_TRUE(contains(note_of("", type), "352 bytes more")) << type << notes;
  }
  write("s.raw", bytes_of(counting()));
  EXPECT_EQ(note_of(""), "");
  notes.clear();
  read_volume(write("n.nrrd", header("") + "\n" + bytes_of(counting()) + "more"), options);
  EXPECT_TRUE(contains(notes, "4 bytes more") && !contains(notes, "skip")) << notes;
}

TEST_F(NrrdTest, SkipsBelowZeroAreOneLine) {
  write("v.raw", bytes_of(counting()));
  for (const char* skip : {"byte skip: -2", "byte skip: -352", "line skip: -1", "byte skip: x",
                           "byteskip: 99999999999999999999"}) {
    write("n.nhdr", header("data file: v.raw\n" + std::string(skip) + "\n"));
    const std::string text = error_of([&] { read_volume(path("n.nhdr")); });
    EXPECT_TRUE(contains(text, skip) && contains(text, "whole number from 0")) << text;
  }
  write("v.raw.gz", test::gzipped(bytes_of(counting())));
  write("n.nhdr", header("data file: v.raw.gz\nbyte skip: -1\n", "float", "gzip"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("n.nhdr")); }), "encoding \"raw\""));
}

TEST_F(NrrdTest, SpacesAreTurnedToLps) {
  const std::string place = "space directions: (1,0,0) (0,0,2) (0,3,0)\nspace origin: (10,20,30)\n";
  const auto at = [&](const std::string& space) {
    return world_of(parse(header("space: " + space + "\n" + place)), 4, 3, 2);
  };
  // In the file's own space: (10 + 4, 20 + 3·2, 30 + 2·3).
  expect_near(at("left-posterior-superior"), {14, 26, 36});
  expect_near(at("LPS"), {14, 26, 36});
  expect_near(at("right-anterior-superior"), {-14, -26, 36});
  expect_near(at("left-anterior-superior"), {14, -26, 36});
  expect_near(at("LAS"), {14, -26, 36});
  expect_near(at("scanner-xyz"), {14, 26, 36});
}

TEST_F(NrrdTest, ObliqueAndShearedDirectionsStandAsTheyLie) {
  const Volume volume =
      parse(header("space: LPS\nspace directions: (0.8,0.6,0) (-1.2,1.6,0) (0.5,0,3)\n"
                   "space origin: (1,2,3)\n"));
  expect_near(world_of(volume, 4, 3, 2),
              {1 + 4 * 0.8 - 3 * 1.2 + 2 * 0.5, 2 + 4 * 0.6 + 3 * 1.6, 3 + 6});
}

TEST_F(NrrdTest, SpacingsAndAxisMinima) {
  expect_near(world_of(parse(header("spacings: 1 2 3\n")), 4, 3, 2), {4, 6, 6});
  expect_near(world_of(parse(header("centerings: node node node\nspacings: 1 2 3\n"
                                    "axis mins: 10 20 30\n")),
                       4, 3, 2),
              {14, 26, 36});
  // ITK would take a spacing of 1.
  const std::string range = header(
      "centerings: node node node\naxis mins: 10 20 30\n"
      "axis maxs: 14 26 36\n");
  EXPECT_TRUE(contains(error(range), "spacing"));
  ReadOptions options;
  options.spacing = Vec3<double>{1, 2, 3};
  expect_near(world_of(parse(range, bytes_of(counting()), options), 4, 3, 2), {14, 26, 36});
}

TEST_F(NrrdTest, NamesOfFieldsAreReadAsNrrdIoReadsThem) {
  const std::string place = "SPACE Directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (10,20,30)\n";
  expect_near(world_of(parse(header("Space: LAS\n" + place)), 4, 3, 2), {14, -26, 36});
  expect_near(world_of(parse(header("Space: left anterior superior\n" + place)), 4, 3, 2),
              {14, -26, 36});
  expect_near(
      world_of(parse(header("Space: LPS\nSpaceDirections:  (1,0,0) (0,2,0) (0,0,3)\n")), 4, 3, 2),
      {4, 6, 6});
  expect_near(world_of(parse(header(place)), 4, 3, 2), {14, 26, 36});
  EXPECT_TRUE(contains(error(header("axismins: 10 20 30\naxismaxs: 14 26 36\n")), "range"));
  EXPECT_TRUE(contains(error(header("Axis Mins: 10 20 30\nAXIS MAXS: 14 26 36\n")), "range"));
  // A comment and a key are no fields.
  expect_near(world_of(parse(header("# axis maxs: 1 2 3\naxis maxs:=1 2 3\n")), 4, 3, 2),
              {4, 3, 2});
  // ITK would write 2^34 bytes and more into room for 32.
  for (const char* field : {"sizes", "Sizes", "SIZES"}) {
    std::string sizes = header("", "float", "raw", "4294967298 2 2");
    sizes.replace(sizes.find("sizes"), 5, field);
    EXPECT_TRUE(contains(error(sizes), "too large to read")) << field;
  }
}

TEST_F(NrrdTest, SpacingThatIsNotKnownIsRefused) {
  for (const char* nan : {"nan", "NaN", "-nan"}) {
    const std::string fields = header("Spacings: 1 " + std::string(nan) + " 1\n");
    EXPECT_TRUE(contains(error(fields), "spacing of axis 2; give the spacing")) << nan;
    ReadOptions options;
    options.spacing = Vec3<double>{1, 2, 3};
    expect_near(world_of(parse(fields, bytes_of(counting()), options), 4, 3, 2), {4, 6, 6});
  }
  error(header("spacings: 1 inf 1\n"));
  // Behind the three, an axis of one value changes nothing.
  std::string four = header("spacings: 1 2 3 nan\n");
  four.replace(four.find("dimension: 3"), 12, "dimension: 4");
  four.replace(four.find("5 4 3"), 5, "5 4 3 1");
  expect_near(world_of(parse(four), 4, 3, 2), {4, 6, 6});
  expect_near(world_of(parse(header("")), 4, 3, 2), {4, 3, 2});
}

TEST_F(NrrdTest, AnAxisThatIsNoneOfSpaceIsRefused) {
  for (const char* axis : {"none", "(nan,nan,nan)"}) {
    for (const char* space : {"space: LPS\n", ""}) {
      const std::string place = "space directions: (1,0,0) (0,2,0) " + std::string(axis) + "\n";
      EXPECT_TRUE(contains(error(header(space + place)), "axis 3 is no axis of space")) << axis;
    }
  }
  EXPECT_TRUE(contains(error(header("space: LPS\nspace directions: none (1,0,0) (0,2,0)\n")),
                       "axis 1 is no axis of space"));
}

TEST_F(NrrdTest, CenteringIsThatOfTheFile) {
  EXPECT_EQ(parse(header("")).description().centering, Centering::point);
  EXPECT_EQ(parse(header("centerings: node node node\n")).description().centering,
            Centering::point);
  EXPECT_EQ(parse(header("centerings: cell cell cell\n")).description().centering, Centering::cell);
  EXPECT_EQ(parse(header("centers: cell cell cell\n")).description().centering, Centering::cell);
  EXPECT_TRUE(contains(error(header("centerings: cell node cell\n")), "cell-centred"));
  ReadOptions options;
  options.centering = Centering::point;
  EXPECT_EQ(parse(header("centerings: cell node cell\n"), bytes_of(counting()), options)
                .description()
                .centering,
            Centering::point);
  // The first value is the centre of the first cell.
  expect_near(world_of(parse(header("centerings: cell cell cell\nspacings: 1 2 3\n"
                                    "axis mins: 10 20 30\n")),
                       0, 0, 0),
              {10.5, 21, 31.5});
}

// NrrdIO refuses both, and files like them are common.
TEST_F(NrrdTest, HeadersThatMissTheirSpaceAreMended) {
  const std::string place = "space directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (10,20,30)\n";
  const Volume attached = parse(header(place));
  expect_counting(attached, "f32");
  expect_near(world_of(attached, 4, 3, 2), {14, 26, 36});
  expect_counting(parse(header(place, "float", "gzip"), test::gzipped(bytes_of(counting()))),
                  "f32");
  // A header whose lines end as on Windows, and values that begin with what ends a line.
  std::string windows = header(place, "unsigned char");
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) {
    windows.replace(at, 1, "\r\n");
  }
  std::vector<std::uint8_t> values(60, '\n');
  const Volume lines = read_volume(write("w.nrrd", windows + "\r\n" + bytes_of(values)));
  EXPECT_EQ(std::get<DataArray<std::uint8_t>>(lines.data()), values);

  write("v.raw", bytes_of(counting()));
  write("a.nhdr", header(place + "data file: v.raw\n"));
  expect_near(world_of(read_volume(path("a.nhdr")), 4, 3, 2), {14, 26, 36});
  write("b.nhdr", header("space: 3D-left-handed\nspacings: 1 2 3\ndata file: v.raw\n"));
  expect_near(world_of(read_volume(path("b.nhdr")), 4, 3, 2), {4, 6, 6});
  expect_near(world_of(parse(header("space: LAS\nspacings: 1 2 3\n")), 4, 3, 2), {4, 6, 6});
  EXPECT_EQ(attached.description().name, path("a.nrrd").string());
}

TEST_F(NrrdTest, MendedHeadersKeepTheirLineSkip) {
  const std::string place = "space directions: (1,0,0) (0,2,0) (0,0,3)\nLine Skip: 2\n";
  const std::string values = "two\nlines\n" + bytes_of(counting());
  expect_counting(parse(header(place), values), "f32");
  write("v.raw", values);
  write("a.nhdr", header(place + "DataFile: v.raw\n"));
  expect_counting(read_volume(path("a.nhdr")), "f32");
}

TEST_F(NrrdTest, ErrorsOfMendedHeadersNameTheFile) {
  const std::string place = "space directions: (1,0,0) (0,2,0) (0,0,3)\n";
  for (const std::string& message :
       {error(header(place), "short"), error(header(place, "nonsense")),
        error(header(place + "data file: none.raw\n"))}) {
    EXPECT_TRUE(contains(message, path("a.nrrd").string())) << message;
    EXPECT_FALSE(contains(message, "mended")) << message;
  }
}

TEST_F(NrrdTest, EveryTruncationIsAnError) {
  const std::string raw = header("") + "\n" + bytes_of(counting());
  const std::string gzip = header("", "float", "gzip") + "\n" + test::gzipped(bytes_of(counting()));
  // The last four bytes of gzip only repeat the length, behind the checksum.
  for (const std::string& whole : {raw, gzip.substr(0, gzip.size() - 4)}) {
    for (std::size_t length = 0; length < whole.size(); ++length) {
      write("cut.nrrd", whole.substr(0, length));
      error_of([&] { read_volume(path("cut.nrrd")); });
    }
  }
}

#ifdef PELLUCID_HAVE_BZIP2
TEST_F(NrrdTest, Bzip2) {
  const std::string packed = bzipped(bytes_of(counting()));
  for (const char* encoding : {"bzip2", "bz2", "BZ2"}) {
    expect_counting(parse(header("", "float", encoding), packed), "f32");
  }
  // Two members, an odd number of bytes before them inside, and a file of its own.
  const std::string all = bytes_of(counting());
  expect_counting(
      parse(header("", "float", "bzip2"), bzipped(all.substr(0, 101)) + bzipped(all.substr(101))),
      "f32");
  expect_counting(parse(header("byte skip: 3\n", "float", "bzip2"), bzipped("abc" + all)), "f32");
  write("values.bz2", packed);
  expect_counting(parse(header("data file: values.bz2\n", "float", "bzip2"), ""), "f32");
  expect_counting(
      parse(header("", "unsigned char", "bzip2"), bzipped(bytes_of(counting<std::uint8_t>()))),
      "u8");
  EXPECT_TRUE(contains(error(header("line skip: 1\n", "float", "bzip2"), packed), "line skip"));
  EXPECT_TRUE(
      contains(error(header("data file: LIST\nvalues.bz2\n", "float", "bzip2"), ""), "bzip2"));
  EXPECT_TRUE(contains(error(header("", "float", "bzip2"), bzipped(all.substr(0, 239))), "early"));
  for (std::size_t length = 0; length < packed.size(); ++length) {
    error(header("", "float", "bzip2"), packed.substr(0, length));
  }
  std::string damaged = packed;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 4);
  EXPECT_TRUE(contains(error(header("", "float", "bzip2"), damaged), "damaged"));
}
#endif

TEST_F(NrrdTest, BadHeadersAreRefused) {
  error(header("spacings: 1 0 3\n"));
  error(header("spacings: 1 -2 3\n"));
  error(header("space: LPS\nspace directions: (1,0,0) (1,0,0) (0,0,3)\n"));
  error(header("space: LPS\nspace directions: (1,0,0) (0,0,0) (0,0,3)\n"));
  error(header("space: LPS\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (1,inf,3)\n"));
  error(header("", "float", "raw", "5 0 3"));
  error(header("", "float", "raw", "5 -4 3"));
  error(header("", "float", "raw", "5 4"));
  error(header("", "float", "raw", "100000 100000 100000"));
  error(header("", "float", "raw", "4294967301 4 3"));
  error(header("", "block"));
  error(header("", "nonsense"));
  error("NRRD0004\ntype: float\n");
  error("");
  error("NRRD");
  error(std::string(100, 'x'));
}

TEST_F(NrrdTest, OtherThanThreeAxesOrOneNumberIsRefused) {
  const auto with = [](const std::string& fields) {
    return "NRRD0004\ntype: unsigned char\nendian: little\nencoding: raw\n" + fields;
  };
  const std::string values(60, '\1');
  EXPECT_TRUE(contains(error(with("dimension: 2\nsizes: 6 10\n"), values), "2 axes"));
  for (const char* fields : {"dimension: 1\nsizes: 6\n", "dimension: 2\nsizes: 3 2\n"}) {
    std::string text = with(fields);
    text.replace(text.find("raw"), 3, "ascii");
    EXPECT_TRUE(contains(error(text, "1 2 3 4 5 6"), " axes is not read")) << fields;
  }
  EXPECT_TRUE(contains(error(with("dimension: 4\nsizes: 3 5 2 2\n"
                                  "kinds: RGB-color domain domain domain\n"),
                             values),
                       "3 components"));
  EXPECT_TRUE(contains(error(with("dimension: 4\nsizes: 5 2 2 3\n"), values), "3 volumes"));
  expect_counting(read_volume(write("four.nrrd", with("dimension: 4\nsizes: 5 4 3 1\n") + "\n" +
                                                     bytes_of(counting<std::uint8_t>()))),
                  "u8");
}

TEST_F(NrrdTest, AListOfOneNumberIsThatNumber) {
  expect_counting(
      parse("NRRD0005\ntype: float\ndimension: 4\nspace: left-posterior-superior\nsizes: 5 4 3 1\n"
            "space directions: (1,0,0) (0,1,0) (0,0,1) none\nendian: little\nencoding: raw\n"),
      "f32");
}

TEST_F(NrrdTest, NanIsKeptAndInfinityRefused) {
  std::vector<float> values = counting();
  values[31] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(parse(header(""), bytes_of(values)).statistics().nan, 1u);
  values[31] = -std::numeric_limits<float>::infinity();
  EXPECT_TRUE(contains(error(header(""), bytes_of(values)), "infinite"));
}

TEST_F(NrrdTest, NothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  parse(header(""));
  error(header("spacings: 1 0 3\n"));
  error(header(""), "short");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace pellucid::test_nrrd

#endif
