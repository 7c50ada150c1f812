// SPDX-License-Identifier: Apache-2.0
//
// Parts of files that are read without the rest: the values and places are those of the whole.
#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/vtk/mesh_files.h"
#include "volume_files.h"
#ifdef PELLUCID_HAVE_HDF5
#include "tests/io/arrays/vtk_hdf_files.h"
#endif
#ifdef PELLUCID_HAVE_NETCDF
#include <netcdf.h>
#endif

namespace pellucid::test_file_parts {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::error_of;

constexpr std::array<int, 3> sides{23, 17, 14};  // x, y, z
constexpr std::size_t points = 23 * 17 * 14;

template <class Value>
std::vector<Value> some_values(std::size_t count = points) {
  std::vector<Value> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<Value>(i * 7919 % 251);
  return values;
}

ReadOptions options_of(const std::string& array = {}) {
  ReadOptions options;
  if (!array.empty()) options.array = array;
  return options;
}

Volume part_of(const fs::path& file, ReadOptions options, const IndexBox& box) {
  options.part = [box](const Volume::Description&) { return box; };
  return read_volume(file, options);
}

/// Expects that a part has the type, the values and the places of the whole.
void expect_part(const Volume& whole, const Volume& part, const IndexBox& box) {
  ASSERT_EQ(part.description().dimensions, box.count);
  EXPECT_EQ(type_name(part.data()), type_name(whole.data()));
  for (int k = 0; k < box.count[2]; ++k) {
    for (int j = 0; j < box.count[1]; ++j) {
      for (int i = 0; i < box.count[0]; ++i) {
        const int x = box.first[0] + i, y = box.first[1] + j, z = box.first[2] + k;
        ASSERT_EQ(test::value_at(part, i, j, k), test::value_at(whole, x, y, z))
            << x << " " << y << " " << z;
      }
    }
  }
  const Vec3<double> first = test::world_of(whole, box.first[0], box.first[1], box.first[2]);
  test::expect_near(test::world_of(part, 0, 0, 0), first, 1e-12);
  EXPECT_EQ(part.description().centering, whole.description().centering);
}

/// Expects the same of corners and of boxes anywhere, of a file that is read in
/// parts.
void expect_parts(const fs::path& file, const ReadOptions& options = {}) {
  SCOPED_TRACE(file);
  EXPECT_TRUE(outline_volume(file, options).reads_parts);
  const Volume whole = read_volume(file, options);
  const std::array<int, 3> n = whole.description().dimensions;
  std::vector<IndexBox> boxes{{{0, 0, 0}, n},
                              {{0, 0, 0}, {2, 2, 2}},
                              {{n[0] - 2, n[1] - 2, n[2] - 2}, {2, 2, 2}},
                              {{0, 0, n[2] / 2}, {n[0], n[1], n[2] - n[2] / 2}}};
  std::mt19937 random(1);
  for (int count = 0; count < 12; ++count) {
    IndexBox box;
    for (std::size_t a = 0; a < 3; ++a) {
      box.first[a] = std::uniform_int_distribution<int>(0, n[a] - 2)(random);
      box.count[a] = std::uniform_int_distribution<int>(2, n[a] - box.first[a])(random);
    }
    boxes.push_back(box);
  }
  for (const IndexBox& box : boxes) expect_part(whole, part_of(file, options, box), box);
}

using FileParts = test::ScratchFolder;

#ifdef PELLUCID_HAVE_HDF5

/// Writes one dataset; `chunk`: its sides, with deflate; empty: contiguous.
template <class Value>
void write_dataset(const fs::path& file, const std::vector<hsize_t>& shape, hid_t type,
                   const std::vector<Value>& values, const std::vector<hsize_t>& chunk = {},
                   bool checksum = false) {
  const hid_t to = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
  if (!chunk.empty()) {
    H5Pset_chunk(how, static_cast<int>(chunk.size()), chunk.data());
    if (checksum) H5Pset_fletcher32(how);
    if (!checksum) H5Pset_deflate(how, 6);
  }
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t set = H5Dcreate2(to, "v", type, space, H5P_DEFAULT, how, H5P_DEFAULT);
  EXPECT_GE(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Pclose(how);
  H5Fclose(to);
}

TEST_F(FileParts, OfHdf5) {
  const std::vector<hsize_t> shape{14, 17, 23};
  write_dataset(path("a.h5"), shape, H5T_NATIVE_INT16, some_values<std::int16_t>());
  expect_parts(path("a.h5"));
  write_dataset(path("b.h5"), shape, H5T_NATIVE_FLOAT, some_values<float>(), {5, 6, 7});
  expect_parts(path("b.h5"));
  // Other axes, and components.
  ReadOptions options;
  options.axes = "xyz";
  expect_parts(path("b.h5"), options);
  options.axes = "yzx";
  expect_parts(path("a.h5"), options);
  write_dataset(path("c.h5"), {14, 17, 23, 3}, H5T_NATIVE_UINT8,
                some_values<std::uint8_t>(3 * points), {4, 4, 4, 3});
  options.axes = "yxzc";
  options.component = 2;
  expect_parts(path("c.h5"), options);
}

TEST_F(FileParts, OfHdf5In64BitsAreReadWhole) {
  // The type is that of the largest of all values.
  std::vector<std::int64_t> values = some_values<std::int64_t>();
  values.back() = 70000;
  write_dataset(path("a.h5"), {14, 17, 23}, H5T_NATIVE_INT64, values);
  EXPECT_FALSE(outline_volume(path("a.h5")).reads_parts);
  const Volume whole = read_volume(path("a.h5"));
  const IndexBox box{{0, 0, 0}, {4, 4, 4}};
  expect_part(whole, part_of(path("a.h5"), {}, box), box);
}

TEST_F(FileParts, OfHdf5ReadNoChunkThatTheyDoNotNeed) {
  // The last chunk is damaged, which its checksum tells.
  const std::vector<std::uint8_t> values = some_values<std::uint8_t>();
  write_dataset(path("a.h5"), {14, 17, 23}, H5T_NATIVE_UINT8, values, {7, 17, 23}, true);
  std::string bytes = read(path("a.h5"));
  const std::string last(reinterpret_cast<const char*>(values.data()) + points - 200, 200);
  const std::size_t at = bytes.rfind(last);
  ASSERT_NE(at, bytes.npos);
  bytes[at + 100] ^= 1;
  write("a.h5", bytes);
  const IndexBox first{{0, 0, 0}, {23, 17, 7}}, second{{3, 0, 6}, {4, 4, 2}};
  EXPECT_EQ(test::value_at(part_of(path("a.h5"), {}, first), 0, 0, 0), values[0]);
  EXPECT_TRUE(contains(error_of([&] { part_of(path("a.h5"), {}, second); }), "damaged"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.h5")); }), "damaged"));
}

TEST_F(FileParts, OfVtkHdf) {
  {
    test::VtkHdfWriter writer(path("a.vtkhdf"), "ImageData");
    writer.attribute<std::int64_t>("WholeExtent", {2, 24, 0, 16, 1, 14});
    writer.attribute<double>("Origin", {1, 2, 3});
    writer.attribute<double>("Spacing", {0.5, 1, 2});
    writer.array("PointData", "p", {14, 17, 23}, some_values<float>());
    writer.array("PointData", "v", {14, 17, 23, 2}, some_values<std::int16_t>(2 * points), true);
    writer.array("CellData", "c", {13, 16, 22}, some_values<std::uint8_t>(13 * 16 * 22), true);
  }
  for (const char* array : {"p", "c"}) expect_parts(path("a.vtkhdf"), options_of(array));
  ReadOptions options = options_of("v");
  options.component = 1;
  expect_parts(path("a.vtkhdf"), options);
}

#endif

#ifdef PELLUCID_HAVE_NETCDF

TEST_F(FileParts, OfNetCdf) {
  int file = -1, axes[4] = {}, plain = -1, scaled = -1, missing = -1, steps = -1;
  ASSERT_EQ(nc_create(path("a.nc").c_str(), NC_CLOBBER | NC_NETCDF4, &file), NC_NOERR);
  const char* const names[] = {"t", "z", "y", "x"};
  const std::size_t counts[] = {2, 14, 17, 23};
  for (int a = 0; a < 4; ++a) nc_def_dim(file, names[a], counts[a], &axes[a]);
  nc_def_var(file, "plain", NC_FLOAT, 3, axes + 1, &plain);
  nc_def_var(file, "scaled", NC_SHORT, 3, axes + 1, &scaled);
  nc_def_var(file, "missing", NC_SHORT, 3, axes + 1, &missing);
  nc_def_var(file, "steps", NC_DOUBLE, 4, axes, &steps);
  const double scale = 0.25;
  const short none = 3;
  nc_put_att_double(file, scaled, "scale_factor", NC_DOUBLE, 1, &scale);
  nc_put_att_short(file, missing, "missing_value", NC_SHORT, 1, &none);
  nc_enddef(file);
  nc_put_var_float(file, plain, some_values<float>().data());
  nc_put_var_short(file, scaled, some_values<short>().data());
  nc_put_var_short(file, missing, some_values<short>().data());
  nc_put_var_double(file, steps, some_values<double>(2 * points).data());
  ASSERT_EQ(nc_close(file), NC_NOERR);
  for (const char* array : {"plain", "scaled"}) expect_parts(path("a.nc"), options_of(array));
  ReadOptions options = options_of("steps");
  options.component = 1;
  expect_parts(path("a.nc"), options);
  // Parts in which none is missing have another type: the whole is read.
  EXPECT_FALSE(outline_volume(path("a.nc"), options_of("missing")).reads_parts);
}

#endif

#ifdef PELLUCID_HAVE_VTK

/// The values of a box of a grid, as text.
template <class Value>
std::string text_of(const std::vector<Value>& values, const std::array<int, 3>& of,
                    const IndexBox& box) {
  std::string text;
  for (int k = box.first[2]; k < box.first[2] + box.count[2]; ++k) {
    for (int j = box.first[1]; j < box.first[1] + box.count[1]; ++j) {
      for (int i = box.first[0]; i < box.first[0] + box.count[0]; ++i) {
        text += std::to_string(values[static_cast<std::size_t>(i + of[0] * (j + of[1] * k))]) + " ";
      }
    }
  }
  return text;
}

/// The extent of points, which are counted from 10, 20 and 30.
std::string extent_of(const IndexBox& box) {
  std::string text;
  for (std::size_t a = 0; a < 3; ++a) {
    const int first = box.first[a] + 10 * (static_cast<int>(a) + 1);
    text += std::to_string(first) + " " + std::to_string(first + box.count[a] - 1) + " ";
  }
  return text;
}

constexpr IndexBox everything{{0, 0, 0}, sides};
constexpr const char* placed = " Origin=\"1 2 -3\" Spacing=\"0.5 1 2\"";

/// One file with points p and cells c of a box.
std::string image(const IndexBox& box, const std::vector<int>& values, const char* type = "Int16") {
  IndexBox cells = box;
  for (int& side : cells.count) --side;
  return test::xml_file("ImageData",
                        "<ImageData WholeExtent=\"" + extent_of(box) + "\"" + placed +
                            "><Piece Extent=\"" + extent_of(box) + "\"><PointData>" +
                            test::xml_array(type, "p", text_of(values, sides, box)) +
                            "</PointData><CellData>" +
                            test::xml_array("Float32", "c", text_of(values, {22, 16, 13}, cells)) +
                            "</CellData></Piece></ImageData>");
}

std::string list_of(const std::vector<std::pair<IndexBox, std::string>>& pieces) {
  std::string list = "<PImageData WholeExtent=\"" + extent_of(everything) + "\"" + placed +
                     "><PPointData><PDataArray type=\"Int16\" Name=\"p\"/></PPointData>"
                     "<PCellData><PDataArray type=\"Float32\" Name=\"c\"/></PCellData>";
  for (const auto& [box, file] : pieces) {
    list += "<Piece Extent=\"" + extent_of(box) + "\" Source=\"" + file + "\"/>";
  }
  return test::xml_file("PImageData", list + "</PImageData>");
}

constexpr IndexBox left{{0, 0, 0}, {12, 17, 14}}, near_right{{11, 0, 0}, {12, 17, 8}},
    far_right{{11, 0, 7}, {12, 17, 7}};

class VtkParts : public test::ScratchFolder {
 protected:
  void SetUp() override {
    test::ScratchFolder::SetUp();
    write("l.vti", image(left, values_));
    write("n.vti", image(near_right, values_));
    write("f.vti", image(far_right, values_));
  }
  fs::path list(const std::vector<std::pair<IndexBox, std::string>>& pieces) const {
    return write("a.pvti", list_of(pieces));
  }
  fs::path good_list() const {
    return list({{left, "l.vti"}, {near_right, "n.vti"}, {far_right, "f.vti"}});
  }

  const std::vector<int> values_ = some_values<int>();
};

TEST_F(VtkParts, OfOneFile) {
  write("a.vti", image(everything, values_));
  for (const char* array : {"p", "c"}) expect_parts(path("a.vti"), options_of(array));
}

TEST_F(VtkParts, OfAppendedBytesAndComponents) {
  const auto values = some_values<std::int16_t>(3 * points);
  const std::vector<std::uint64_t> size{3 * 2 * points};
  write("a.vti",
        "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\"><ImageData WholeExtent=\"" +
            extent_of(everything) + "\"" + placed + "><Piece Extent=\"" + extent_of(everything) +
            "\"><PointData><DataArray type=\"Int16\" Name=\"p\" "
            "NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></PointData>"
            "</Piece></ImageData><AppendedData encoding=\"raw\">_" +
            test::bytes_of(size) + test::bytes_of(values) + "</AppendedData></VTKFile>");
  ReadOptions options;
  options.component = 1;
  expect_parts(path("a.vti"), options);
}

TEST_F(VtkParts, OfPieces) {
  const fs::path file = good_list();
  for (const char* array : {"p", "c"}) {
    expect_parts(file, options_of(array));
    const Volume whole = read_volume(file, options_of(array));
    write("a.vti", image(everything, values_));
    IndexBox all{{0, 0, 0}, whole.description().dimensions};
    expect_part(read_volume(path("a.vti"), options_of(array)), whole, all);
  }
}

TEST_F(VtkParts, ReadNoPieceThatTheyDoNotNeed) {
  const fs::path file = good_list();
  fs::remove(path("f.vti"));
  const IndexBox near{{5, 3, 0}, {18, 10, 8}};
  EXPECT_EQ(part_of(file, options_of("p"), near).description().dimensions, near.count);
  const std::string error = error_of([&] {
    part_of(file, options_of("p"), {{12, 0, 0}, {2, 2, 14}});
  });
  EXPECT_TRUE(contains(error, "f.vti")) << error;
  EXPECT_TRUE(contains(error_of([&] { read_volume(file, options_of("p")); }), "f.vti"));
}

TEST_F(VtkParts, WherePiecesOverlapTheFirstSpeaks) {
  // The pieces disagree where two have a point.
  std::vector<int> others = values_;
  for (int& value : others) value = 500 - value;
  const IndexBox wide{{4, 0, 0}, {19, 17, 14}};
  write("w.vti", image(wide, others));
  for (const bool first : {false, true}) {
    const fs::path file =
        first ? list({{left, "l.vti"}, {wide, "w.vti"}}) : list({{wide, "w.vti"}, {left, "l.vti"}});
    expect_parts(file, options_of("p"));
    const Volume whole = read_volume(file, options_of("p"));
    for (int i = 0; i < sides[0]; ++i) {
      const bool of_left = first ? i < 12 : i < 4;
      const auto at = static_cast<std::size_t>(i);
      EXPECT_EQ(test::value_at(whole, i, 0, 0), of_left ? values_[at] : others[at]) << i;
    }
  }
}

TEST_F(VtkParts, PiecesThatLieAreRefused) {
  const IndexBox far{{14, 0, 10}, {4, 4, 4}};
  const auto refused = [&](const fs::path& file) {
    for (const bool whole : {false, true}) {
      const std::string error =
          error_of([&] { part_of(file, options_of("p"), whole ? everything : far); });
      EXPECT_TRUE(error.starts_with(file.string() + ": ")) << error;
      EXPECT_EQ(error.find("0x"), error.npos) << error;
    }
  };
  // A gap, and a list without pieces.
  refused(list({{left, "l.vti"}, {near_right, "n.vti"}}));
  refused(list({}));
  // A piece that has less than the list says, and one of another type.
  refused(list({{left, "l.vti"}, {{{11, 0, 0}, {12, 17, 14}}, "n.vti"}}));
  write("o.vti", image(far_right, values_, "Float64"));
  refused(list({{left, "l.vti"}, {near_right, "n.vti"}, {far_right, "o.vti"}}));
  // One that is cut off, and one that has not the array.
  const std::string piece = read(path("f.vti"));
  write("f.vti", piece.substr(0, piece.size() / 2));
  refused(good_list());
  std::string other = piece;
  other.replace(other.find("\"p\""), 3, "\"q\"");
  write("f.vti", other);
  refused(good_list());
  // Extents that are no numbers.
  std::string list = list_of({{left, "l.vti"}});
  list.replace(list.find("<Piece Extent=\"10 21"), 20, "<Piece Extent=\"10 no");
  const std::string error = error_of([&] { read_volume(write("a.pvti", list)); });
  EXPECT_TRUE(contains(error, "Extent")) << error;
}

#endif

}  // namespace
}  // namespace pellucid::test_file_parts
