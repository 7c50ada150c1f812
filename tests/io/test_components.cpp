// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "volume_files.h"

namespace pellucid::test_components {
namespace {

using test::bytes_of;
using test::contains;
using test::error_of;
using test::gzipped;
using test::swapped_bytes_of;

enum class Lie { side_by_side, behind };

/// Component c of value i is i + 60 · c.
template <class Value = float>
std::vector<Value> values(int components, Lie lie) {
  std::vector<Value> list;
  const int outer = lie == Lie::side_by_side ? 60 : components;
  const int inner = lie == Lie::side_by_side ? components : 60;
  for (int a = 0; a < outer; ++a) {
    for (int b = 0; b < inner; ++b) {
      list.push_back(static_cast<Value>(lie == Lie::side_by_side ? a + 60 * b : b + 60 * a));
    }
  }
  return list;
}

class ComponentsTest : public test::ScratchFolder {
 protected:
  std::string error(const std::string& name, const ReadOptions& options = {}) {
    return error_of([&] { read_volume(path(name), options); });
  }

  static void expect_component(const Volume& volume, int c, const std::string& type) {
    EXPECT_EQ(type_name(volume.data()), type);
    ASSERT_EQ(volume.description().dimensions, (std::array<int, 3>{5, 4, 3}));
    for (int i = 0; i < 60; ++i) {
      ASSERT_EQ(test::value_at(volume, i % 5, i / 5 % 4, i / 20), i + 60 * c) << "component " << c;
    }
  }

  /// All at once, each by itself, and what is refused.
  void expect_components(const std::string& name, int components, const std::string& type,
                         ReadOptions options = {}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(component_count(path(name), options), components);
    const std::vector<Volume> all = read_components(path(name), options);
    ASSERT_EQ(all.size(), static_cast<std::size_t>(components));
    const std::string last = std::to_string(components - 1);
    if (components > 1) {
      const std::string text = error(name, options);
      EXPECT_TRUE(contains(text, "component, 0 to " + last)) << text;
    }
    for (int c = 0; c < components; ++c) {
      const Volume& volume = all[static_cast<std::size_t>(c)];
      expect_component(volume, c, type);
      EXPECT_EQ(contains(volume.description().name, ", component " + std::to_string(c)),
                components > 1);
      options.component = c;
      const Volume alone = read_volume(path(name), options);
      expect_component(alone, c, type);
      EXPECT_EQ(alone.world_corners(), volume.world_corners());
      EXPECT_EQ(read_components(path(name), options).size(), 1u);
    }
    for (const int none : {-1, components}) {
      options.component = none;
      const std::string text = error(name, options);
      EXPECT_TRUE(contains(text, "there is no component " + std::to_string(none))) << text;
      error_of([&] { read_components(path(name), options); });
    }
  }
};

std::string npy(const std::string& descr, const std::string& order, const std::string& shape,
                const std::string& data) {
  const std::string header =
      "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
  return std::string("\x93NUMPY\1\0", 8) + static_cast<char>(header.size()) + '\0' + header + data;
}

TEST_F(ComponentsTest, OfNpyAreTheLastAxis) {
  write("c.npy", npy("<f4", "False", "(3, 4, 5, 2)", bytes_of(values(2, Lie::side_by_side))));
  expect_components("c.npy", 2, "f32");
  write("b.npy", npy(">i2", "False", "(3, 4, 5, 3)",
                     swapped_bytes_of(values<std::int16_t>(3, Lie::side_by_side))));
  expect_components("b.npy", 3, "i16");
  write("o.npy",
        npy("|u1", "False", "(3, 4, 5, 1)", bytes_of(values<std::uint8_t>(1, Lie::side_by_side))));
  expect_components("o.npy", 1, "u8");
  write("t.npy",
        npy("|u1", "False", "(3, 4, 5)", bytes_of(values<std::uint8_t>(1, Lie::side_by_side))));
  expect_components("t.npy", 1, "u8");
}

TEST_F(ComponentsTest, OfNpyThatCannotBe) {
  const std::string data = bytes_of(values(2, Lie::side_by_side));
  write("a.npy", npy("<f4", "False", "(3, 4, 5, 0)", data));
  EXPECT_TRUE(contains(error("a.npy"), "components"));
  write("a.npy", npy("<f4", "False", "(9, 9, 9, 99999999999)", data));
  EXPECT_TRUE(contains(error("a.npy"), "99999999999"));
  write("a.npy", npy("<f4", "False", "(99999999999, 9, 9, 9)", data));
  EXPECT_TRUE(contains(error("a.npy"), "components"));
  write("a.npy", npy("<f4", "False", "(1000000000, 1000000000, 1, 2147483647)", data));
  EXPECT_TRUE(contains(error("a.npy"), "too large"));
  write("a.npy", npy("<f4", "False", "(3, 4, 5, 3)", data));
  EXPECT_TRUE(contains(error("a.npy"), "cut off"));
  write("a.npy", npy("<f4", "False", "(3, 4, 5, 2, 2)", data));
  EXPECT_TRUE(contains(error("a.npy"), "no volume"));
}

TEST_F(ComponentsTest, OfNpyAreThoseOfTheFirstArray) {
  write("a.npy", npy("<f4", "False", "(3, 4, 5, 2)",
                     bytes_of(values(2, Lie::side_by_side)) + "\x93NUMPY and more"));
  expect_components("a.npy", 2, "f32");
  std::string told;
  ReadOptions options;
  options.component = 0;
  options.note = [&](const std::string& note) { told += note; };
  read_volume(path("a.npy"), options);
  EXPECT_TRUE(contains(told, "15 bytes more")) << told;
}

TEST_F(ComponentsTest, OfHeaderlessDataLieSideBySide) {
  ReadOptions options;
  options.dimensions = {5, 4, 3};
  options.type = "f32";
  options.components = 2;
  options.skip_bytes = 3;
  options.spacing = Vec3<double>{1, 2, 3};
  write("a.raw", "abc" + bytes_of(values(2, Lie::side_by_side)));
  expect_components("a.raw", 2, "f32", options);
  options.big_endian = true;
  write("b.raw", "abc" + swapped_bytes_of(values(2, Lie::side_by_side)));
  expect_components("b.raw", 2, "f32", options);
  options.components = 3;
  EXPECT_TRUE(contains(error("b.raw", options), "3 x f32 need 720 after 3 skipped"));
  for (const int bad : {0, -1}) {
    options.components = bad;
    EXPECT_TRUE(contains(error("b.raw", options), "at least 1"));
  }
  options.dimensions = {2147483647, 2147483647, 1};
  options.components = 2147483647;
  EXPECT_TRUE(contains(error("b.raw", options), "too large"));
  options = {};
  options.components = 2;
  write("t.npy", npy("|u1", "False", "(3, 4, 5)", std::string(60, '\1')));
  EXPECT_TRUE(contains(error("t.npy", options), "components may only be given for headerless"));
}

TEST_F(ComponentsTest, OfManyPartsAreAllRead) {
  // More than is read at once.
  ReadOptions options;
  options.dimensions = {97, 89, 41};
  options.type = "u16";
  options.components = 3;
  std::vector<std::uint16_t> data(97 * 89 * 41 * 3);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint16_t>(i * 31);
  write("a.raw", bytes_of(data));
  const std::vector<Volume> all = read_components(path("a.raw"), options);
  ASSERT_EQ(all.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& component = std::get<DataArray<std::uint16_t>>(all[c].data());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < component.size(); ++i) {
      wrong += component[i] != data[3 * i + c] ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0u) << c;
  }
}

#ifdef PELLUCID_HAVE_ITK

using test::NiftiFile;

TEST_F(ComponentsTest, OfNiftiAreAnAxisBehindTheThird) {
  NiftiFile file;
  file.dim = {4, 5, 4, 3, 3, 1, 1, 1};
  file.pixdim = {1, 1, 2, 3, 0, 0, 0, 0};
  const std::string data = bytes_of(values(3, Lie::behind));
  write("t.nii", file.with(data));
  expect_components("t.nii", 3, "f32");
  EXPECT_TRUE(contains(error("t.nii"), "3 time steps (axis 4)"));
  EXPECT_TRUE(contains(error("t.nii"), "choose a time, or a component, 0 to 2"));
  write("t.nii.gz", gzipped(file.with(data)));
  expect_components("t.nii.gz", 3, "f32");
  file.vox_offset = 0;
  file.magic = std::string("ni1\0", 4);
  write("p.hdr", file.header());
  write("p.img", data);
  expect_components("p.hdr", 3, "f32");

  NiftiFile vectors;
  vectors.dim = {5, 5, 4, 3, 1, 2, 1, 1};
  vectors.datatype = 4;
  vectors.bitpix = 16;
  vectors.big_endian = true;
  write("v.nii", vectors.with(swapped_bytes_of(values<std::int16_t>(2, Lie::behind))));
  expect_components("v.nii", 2, "i16");
  EXPECT_TRUE(contains(error("v.nii"), "2 components (axis 5)"));
}

TEST_F(ComponentsTest, OfNiftiAreScaled) {
  NiftiFile file;
  file.dim = {4, 5, 4, 3, 2, 1, 1, 1};
  file.datatype = 4;
  file.bitpix = 16;
  file.slope = 0.5;
  file.intercept = 10;
  std::vector<std::int16_t> stored = values<std::int16_t>(2, Lie::behind);
  for (std::int16_t& v : stored) v = static_cast<std::int16_t>(2 * v - 20);
  write("s.nii", file.with(bytes_of(stored)));
  expect_components("s.nii", 2, "f32");
  write("s.nii.gz", gzipped(file.with(bytes_of(stored))));
  expect_components("s.nii.gz", 2, "f32");
}

TEST_F(ComponentsTest, OfNiftiAreColors) {
  for (const int components : {3, 4}) {
    NiftiFile file;
    file.datatype = components == 3 ? 128 : 2304;
    file.bitpix = static_cast<std::int16_t>(8 * components);
    file.slope = 2;  // which colors do not have
    const std::string data = bytes_of(values<std::uint8_t>(components, Lie::side_by_side));
    write("c.nii", file.with(data));
    expect_components("c.nii", components, "u8");
    EXPECT_TRUE(contains(error("c.nii"), components == 3 ? "RGB)" : "RGBA)"));
    write("c.nii.gz", gzipped(file.with(data)));
    expect_components("c.nii.gz", components, "u8");
    file.dim = {4, 5, 4, 3, 2, 1, 1, 1};
    write("ct.nii", file.with(data + data));
    EXPECT_TRUE(contains(error("ct.nii"), "2 time steps"));
  }
}

TEST_F(ComponentsTest, OfNiftiThatAreCutOffOrContradict) {
  NiftiFile file;
  file.dim = {4, 5, 4, 3, 3, 1, 1, 1};
  const std::string data = bytes_of(values(3, Lie::behind));
  ReadOptions first;
  first.component = 0;
  for (const std::size_t missing : {std::size_t{1}, std::size_t{240}, std::size_t{700}}) {
    const std::string cut = file.with(data.substr(0, data.size() - missing));
    // Also where the chosen one is whole.
    write("c.nii", cut);
    EXPECT_TRUE(contains(error("c.nii", first), "cut off"));
    write("c.nii.gz", gzipped(cut));
    EXPECT_TRUE(contains(error("c.nii.gz", first), "too early"));
  }
  file.dim = {5, 5, 4, 3, 3, 2, 1, 1};
  write("two.nii", file.with(data + data));
  EXPECT_TRUE(contains(error("two.nii", first), "3 time steps (axis 4) and 2 components (axis 5)"));
  file.dim = {4, 5, 4, 3, 0, 1, 1, 1};
  write("zero.nii", file.with(data));
  EXPECT_TRUE(contains(error("zero.nii"), "damaged"));
  file.dim = {4, 5, 4, 3, -3, 1, 1, 1};
  write("negative.nii", file.with(data));
  EXPECT_TRUE(contains(error("negative.nii"), "damaged"));
}

std::string nrrd(const std::string& sizes, const std::string& more,
                 const std::string& encoding = "raw", const std::string& type = "float") {
  return "NRRD0005\ntype: " + type + "\ndimension: 4\nsizes: " + sizes +
         "\nendian: little\nencoding: " + encoding + "\n" + more + "\n";
}

TEST_F(ComponentsTest, OfNrrdAreTheFirstAxis) {
  const std::string data = bytes_of(values(3, Lie::side_by_side));
  for (const char* kind : {"vector", "3-vector", "3-color", "RGB-color", "list", "covariant-vector",
                           "3-gradient", "3-normal", "point"}) {
    SCOPED_TRACE(kind);
    const std::string kinds = "kinds: " + std::string(kind) + " domain domain domain\n";
    write("v.nrrd", nrrd("3 5 4 3", kinds) + data);
    expect_components("v.nrrd", 3, "f32");
    write("z.nrrd", nrrd("3 5 4 3", kinds, "gzip") + gzipped(data));
    expect_components("z.nrrd", 3, "f32");
  }
  write("m.nrrd", nrrd("7 5 4 3", "kinds: 3D-masked-symmetric-matrix domain domain domain\n") +
                      bytes_of(values(7, Lie::side_by_side)));
  expect_components("m.nrrd", 7, "f32");
  write("d.raw", data);
  write("d.nhdr", nrrd("3 5 4 3", "kinds: vector space space space\ndata file: d.raw\n"));
  expect_components("d.nhdr", 3, "f32");
}

TEST_F(ComponentsTest, OfNrrdAreTheLastAxis) {
  const std::string data = bytes_of(values(2, Lie::behind));
  for (const char* more :
       {"", "kinds: domain domain domain list\n", "kinds: space space space vector\n",
        "kinds: space space space time\n"}) {
    SCOPED_TRACE(more);
    write("v.nrrd", nrrd("5 4 3 2", more) + data);
    expect_components("v.nrrd", 2, "f32");
    write("z.nrrd", nrrd("5 4 3 2", more, "gzip") + gzipped(data));
    expect_components("z.nrrd", 2, "f32");
  }
}

TEST_F(ComponentsTest, OfNrrdAreInSpace) {
  const std::string place = "(0,2,0) (3,0,0) (0,0,4)", origin = "space origin: (10,20,30)\n";
  const std::string kinds[] = {"", "kinds: vector space space space\n",
                               "kinds: ??? space space space\n",
                               "kinds: none domain domain domain\n"};
  for (const std::string& kind : kinds) {
    for (const char* space : {"space: LPS\n", "space: right-anterior-superior\n",
                              "space: left-anterior-superior\n", "space dimension: 3\n"}) {
      SCOPED_TRACE(kind + space);
      const std::string header = space + ("space directions: none " + place + "\n") + origin + kind;
      write("s.nrrd", nrrd("2 5 4 3", header) + bytes_of(values(2, Lie::side_by_side)));
      expect_components("s.nrrd", 2, "f32");
      ReadOptions options;
      options.component = 1;
      const Volume volume = read_volume(path("s.nrrd"), options);
      const double x = contains(space, "right") ? -1 : 1, y = contains(space, "anterior") ? -1 : 1;
      test::expect_near(test::world_of(volume, 0, 0, 0), {10 * x, 20 * y, 30});
      test::expect_near(test::world_of(volume, 1, 1, 1), {13 * x, 22 * y, 34});
    }
  }
  const std::string last = "space: LPS\nspace directions: " + place + " none\n" + origin +
                           "centerings: cell cell cell none\n";
  write("l.nrrd", nrrd("5 4 3 2", last) + bytes_of(values(2, Lie::behind)));
  expect_components("l.nrrd", 2, "f32");
  write("l.nrrd", nrrd("5 4 3 2", last, "gzip") + gzipped(bytes_of(values(2, Lie::behind))));
  expect_components("l.nrrd", 2, "f32");
  EXPECT_EQ(read_components(path("l.nrrd"))[0].description().centering, Centering::cell);
  // Spacings alone.
  write("n.nrrd", nrrd("2 5 4 3",
                       "kinds: vector domain domain domain\nspacings: nan 1 2 3\n"
                       "centerings: none cell cell cell\n") +
                      bytes_of(values(2, Lie::side_by_side)));
  expect_components("n.nrrd", 2, "f32");
  const Volume n = read_components(path("n.nrrd"))[1];
  test::expect_near(n.description().placement.spacing, {1, 2, 3});
  EXPECT_EQ(n.description().centering, Centering::cell);
}

TEST_F(ComponentsTest, OfNrrdBetweenAxesOfSpace) {
  const auto all = values(2, Lie::side_by_side);
  for (const bool packed : {false, true}) {
    write("m.nrrd", nrrd("5 2 4 3", "kinds: domain list domain domain\n", packed ? "gzip" : "raw") +
                        (packed ? gzipped(bytes_of(all)) : bytes_of(all)));
    const auto components = read_components(path("m.nrrd"));
    ASSERT_EQ(components.size(), 2u);
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t y = 0; y < 4; ++y) {
        EXPECT_EQ(test::value_at(components[c], 3, static_cast<int>(y), 2),
                  static_cast<double>(all[3 + 5 * (c + 2 * (y + 4 * 2))]));
      }
    }
  }
}

TEST_F(ComponentsTest, OfNrrdThatCannotBe) {
  const std::string data = bytes_of(values(2, Lie::side_by_side));
  write("d.nrrd", nrrd("2 5 4 3", "kinds: list domain domain list\n") + data);
  error("d.nrrd");
  ReadOptions first;
  first.component = 0;
  const std::string vector = "kinds: vector domain domain domain\n";
  write("c.nrrd", nrrd("2 5 4 3", vector) + data.substr(1));
  EXPECT_TRUE(contains(error("c.nrrd", first), "cut off"));
  write("z.nrrd", nrrd("2 5 4 3", vector, "gzip") + gzipped(data).substr(0, 100));
  error("z.nrrd", first);
  write("k.nrrd", nrrd("3 5 4 3", "kinds: 4-color domain domain domain\n") + data);
  error("k.nrrd");
}

std::string meta_image(const std::string& more, const std::string& file = "LOCAL",
                       const std::string& size = "5 4 3", const std::string& axes = "3") {
  return "ObjectType = Image\nNDims = " + axes +
         "\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" + more + "DimSize = " + size +
         "\nElementType = MET_FLOAT\nElementDataFile = " + file + "\n";
}

TEST_F(ComponentsTest, OfMetaImageAreItsChannels) {
  const std::string data = bytes_of(values(3, Lie::side_by_side));
  const std::string channels = "ElementNumberOfChannels = 3\n";
  write("c.mha", meta_image(channels) + data);
  expect_components("c.mha", 3, "f32");
  const std::string packed = test::deflated(data, 15);
  write("z.mha", meta_image(channels + "CompressedData = True\nCompressedDataSize = " +
                            std::to_string(packed.size()) + "\n") +
                     packed);
  expect_components("z.mha", 3, "f32");
  for (int k = 0; k < 3; ++k) {
    write("s" + std::to_string(k) + ".raw", data.substr(static_cast<std::size_t>(k) * 240, 240));
  }
  write("s.mhd", meta_image(channels, "s%d.raw 0 2 1"));
  expect_components("s.mhd", 3, "f32");
  ReadOptions first;
  first.component = 0;
  write("cut.mha", meta_image(channels) + data.substr(1));
  EXPECT_TRUE(contains(error("cut.mha", first), "cut off"));
}

TEST_F(ComponentsTest, OfMetaImageAreAFourthAxis) {
  const std::string data = bytes_of(values(2, Lie::behind));
  write("t.mha", meta_image("", "LOCAL", "5 4 3 2", "4") + data);
  expect_components("t.mha", 2, "f32");
  write("a.raw", data.substr(0, 240));
  write("b.raw", data.substr(240));
  write("l.mhd", meta_image("", "LIST", "5 4 3 2", "4") + "a.raw\nb.raw\n");
  expect_components("l.mhd", 2, "f32");
}

#endif

}  // namespace
}  // namespace pellucid::test_components
