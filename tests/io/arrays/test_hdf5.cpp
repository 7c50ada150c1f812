// SPDX-License-Identifier: Apache-2.0
#ifdef PELLUCID_HAVE_HDF5

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_hdf5 {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;

/// Writes datasets by HDF5 itself.
class Hdf5 : public test::ScratchFolder {
 protected:
  void SetUp() override {
    ScratchFolder::SetUp();
    file_ = H5Fcreate(path("a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(file_, 0);
  }
  void TearDown() override {
    close();
    ScratchFolder::TearDown();
  }
  void close() {
    if (file_ >= 0) H5Fclose(file_);
    file_ = -1;
  }

  /// Values of type `memory`, stored as `stored`, in chunks with deflate where asked.
  void add(const std::string& name, const std::vector<hsize_t>& sides, hid_t stored, hid_t memory,
           const void* values, bool packed = false) {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    if (packed) {
      std::vector<hsize_t> chunk(sides);
      for (hsize_t& side : chunk) side = (side + 1) / 2;
      H5Pset_chunk(how, static_cast<int>(sides.size()), chunk.data());
      H5Pset_shuffle(how);
      H5Pset_deflate(how, 9);
    }
    const hid_t space = H5Screate_simple(static_cast<int>(sides.size()), sides.data(), nullptr);
    const hid_t set = H5Dcreate2(file_, name.c_str(), stored, space, links, how, H5P_DEFAULT);
    ASSERT_GE(set, 0) << name;
    EXPECT_GE(H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(how);
    H5Pclose(links);
  }
  template <class Value>
  void add_counting(const std::string& name, hid_t stored, hid_t memory, bool packed = false) {
    add(name, {3, 4, 5}, stored, memory, counting<Value>().data(), packed);
  }
  Volume read(const std::string& array, std::optional<int> component = {}) {
    close();
    ReadOptions options;
    options.array = array;
    options.component = component;
    return read_volume(path("a.h5"), options);
  }

 private:
  hid_t file_ = -1;
};

TEST_F(Hdf5, RefusesValuesOfOtherFilesAndBitFields) {
  const hsize_t sides[] = {3, 4, 5};
  const hid_t space = H5Screate_simple(3, sides, nullptr);
  const hid_t outside = H5Pcreate(H5P_DATASET_CREATE), apart = H5Pcreate(H5P_DATASET_CREATE);
  close();
  H5Pset_external(outside, path("v.raw").c_str(), 0, 240);
  H5Pset_virtual(apart, space, path("b.h5").c_str(), "v", space);
  const hid_t file = H5Fcreate(path("a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  write("v.raw", test::bytes_of(counting()));
  H5Dclose(H5Dcreate2(file, "o", H5T_IEEE_F32LE, space, H5P_DEFAULT, outside, H5P_DEFAULT));
  H5Dclose(H5Dcreate2(file, "v", H5T_IEEE_F32LE, space, H5P_DEFAULT, apart, H5P_DEFAULT));
  H5Dclose(H5Dcreate2(file, "b", H5T_STD_B8LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  for (const hid_t how : {outside, apart}) H5Pclose(how);
  H5Sclose(space);
  H5Fclose(file);
  const std::string all = error_of([&] { read_volume(path("a.h5")); });
  for (const char* part : {"external storage", "a virtual dataset", "bit fields"}) {
    EXPECT_TRUE(contains(all, part)) << all;
  }
}

TEST_F(Hdf5, EveryTypeOfBothByteOrders) {
  add_counting<std::uint8_t>("u8", H5T_STD_U8LE, H5T_NATIVE_UINT8);
  add_counting<std::int8_t>("i8", H5T_STD_I8BE, H5T_NATIVE_INT8);
  add_counting<std::uint16_t>("u16", H5T_STD_U16BE, H5T_NATIVE_UINT16);
  add_counting<std::int16_t>("i16", H5T_STD_I16LE, H5T_NATIVE_INT16, true);
  add_counting<std::uint32_t>("u32", H5T_STD_U32BE, H5T_NATIVE_UINT32, true);
  add_counting<std::int32_t>("i32", H5T_STD_I32LE, H5T_NATIVE_INT32);
  add_counting<std::int64_t>("i64", H5T_STD_I64BE, H5T_NATIVE_INT64);
  add_counting<float>("f32", H5T_IEEE_F32BE, H5T_NATIVE_FLOAT, true);
  add_counting<double>("f64", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
  for (const char* type : {"u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64"}) {
    SCOPED_TRACE(type);
    expect_counting(read(type), type);
  }
  expect_counting(read("i64"), "u8");
}

TEST_F(Hdf5, HalfFloatsAndTruthValues) {
  // As h5py writes them.
  const hid_t half = H5Tcopy(H5T_IEEE_F32LE);
  H5Tset_fields(half, 15, 10, 5, 0, 10);
  H5Tset_size(half, 2);
  H5Tset_ebias(half, 15);
  add_counting<float>("half", half, H5T_NATIVE_FLOAT);
  H5Tclose(half);
  const hid_t truth = H5Tenum_create(H5T_NATIVE_INT8);
  const std::int8_t no = 0, yes = 1;
  H5Tenum_insert(truth, "FALSE", &no);
  H5Tenum_insert(truth, "TRUE", &yes);
  std::vector<std::int8_t> values(60);
  values[7] = 1;
  add("truth", {3, 4, 5}, truth, truth, values.data());
  H5Tclose(truth);
  expect_counting(read("half"), "f32");
  const Volume volume = read("truth");
  EXPECT_EQ(type_name(volume.data()), "u8");
  EXPECT_EQ(test::value_at(volume, 2, 1, 0), 1);
  EXPECT_EQ(volume.statistics().maximum, 1);
  EXPECT_EQ(volume.statistics().minimum, 0);
}

TEST_F(Hdf5, GroupsAreNamesWithSlashes) {
  add_counting<float>("/a/b/data", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT);
  add_counting<std::uint8_t>("/z", H5T_STD_U8LE, H5T_NATIVE_UINT8);
  const std::vector<double> flat(20);
  add("/a/flat", {4, 5}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, flat.data());
  expect_counting(read("/a/b/data"), "f32");
  expect_counting(read("a/b/data"), "f32");
  const std::string error = error_of([&] { read("/a/flat"); });
  EXPECT_TRUE(contains(error, "\"/a/flat\"") && contains(error, "/a/b/data, /z")) << error;
  const std::vector<VolumeArray> arrays = list_arrays(path("a.h5"));
  ASSERT_EQ(arrays.size(), 2u);
  EXPECT_EQ(arrays[0].name, "/a/b/data");
  EXPECT_TRUE(arrays[0].is_default);
  EXPECT_EQ(arrays[0].dimensions, (std::vector<int>{5, 4, 3}));
  EXPECT_EQ(arrays[1].type, "u8");
  EXPECT_EQ(arrays[1].components.front().maximum, 59);
  expect_counting(read_volume(path("a.h5")), "f32");
}

TEST_F(Hdf5, AFourthAxisIsComponents) {
  std::vector<float> colors, steps;
  for (int i = 0; i < 180; ++i) colors.push_back(static_cast<float>(i));
  for (int i = 0; i < 420; ++i) steps.push_back(static_cast<float>(i));
  add("colors", {3, 4, 5, 3}, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, colors.data(), true);
  add("steps", {7, 3, 4, 5}, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, steps.data());
  add("one", {1, 1, 3, 4, 5}, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, steps.data());
  add("behind", {7, 3, 4, 5, 1}, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, steps.data());
  EXPECT_EQ(test::value_at(read("colors", 2), 1, 0, 0), 5);
  EXPECT_EQ(test::value_at(read("steps", 2), 1, 0, 0), 121);
  EXPECT_EQ(test::value_at(read("behind", 2), 1, 0, 0), 121);
  expect_counting(read("one"), "f32");
  EXPECT_TRUE(contains(error_of([&] { read("colors"); }), "3 components (axis 3)"));
  EXPECT_TRUE(contains(error_of([&] { read("steps"); }), "7 components (axis 0)"));
  ReadOptions options;
  options.array = "steps";
  EXPECT_EQ(component_count(path("a.h5"), options), 7);
  options.time = 1;
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.h5"), options); }), "no steps"));
}

TEST_F(Hdf5, AxesAreChosen) {
  std::vector<std::int64_t> numbers(120);
  for (int i = 0; i < 120; ++i) numbers[static_cast<std::size_t>(i)] = i * 10;
  add("four", {2, 3, 4, 5}, H5T_STD_I64LE, H5T_NATIVE_INT64, numbers.data());
  add("three", {4, 5, 6}, H5T_STD_I64LE, H5T_NATIVE_INT64, numbers.data());
  close();
  std::string notes;
  ReadOptions options;
  options.array = "four";
  options.note = [&](const std::string& line) { notes += line + "\n"; };
  EXPECT_EQ(read_components(path("a.h5"), options).size(), 2u);
  EXPECT_TRUE(contains(notes, "axes czyx")) << notes;
  notes.clear();
  options.axes = "xyzc";
  const std::vector<Volume> five = read_components(path("a.h5"), options);
  ASSERT_EQ(five.size(), 5u);
  EXPECT_EQ(notes, "");
  EXPECT_EQ(five[4].description().dimensions, (std::array<int, 3>{2, 3, 4}));
  EXPECT_EQ(type_name(five[4].data()), "u16");
  EXPECT_EQ(test::value_at(five[4], 1, 2, 3), 10 * (((1 * 3 + 2) * 4 + 3) * 5 + 4));
  options.array = "three";
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.h5"), options); }), "3 axes"));
  options.axes = "yxz";
  EXPECT_EQ(test::value_at(read_volume(path("a.h5"), options), 4, 3, 5), 10 * 119);
  EXPECT_EQ(test::value_at(read_volume(path("a.h5"), options), 2, 0, 1), 10 * 13);
}

TEST_F(Hdf5, WholeNumbersThatAreRoundedAreTold) {
  std::vector<std::int64_t> numbers(60, 3);
  numbers[5] = 9007199254740993;
  add("large", {3, 4, 5}, H5T_STD_I64BE, H5T_NATIVE_INT64, numbers.data());
  close();
  std::string note;
  ReadOptions options;
  options.note = [&](const std::string& line) { note = line; };
  const Volume volume = read_volume(path("a.h5"), options);
  EXPECT_EQ(type_name(volume.data()), "f64");
  EXPECT_TRUE(contains(note, "1 of 60 whole numbers of 64 bits")) << note;
}

TEST_F(Hdf5, RefusesWhatIsNone) {
  const std::vector<double> flat(20);
  add("flat", {4, 5}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, flat.data());
  close();
  const std::string error = error_of([&] { read_volume(path("a.h5")); });
  EXPECT_TRUE(contains(error, "three or four axes") && contains(error, "/flat")) << error;
  EXPECT_TRUE(contains(error_of([&] { read_volume(write("b.h5", "no")); }), "no HDF5"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(write("c.h5", "")); }), "no HDF5"));
  error_of([&] { read_volume(path("none.h5")); });
}

TEST_F(Hdf5, SizesBeyondMemoryAreRefused) {
  // In chunks of which none is written, which takes no room in the file.
  const std::vector<hsize_t> sides{1 << 20, 1 << 20, 1 << 20}, chunk{64, 64, 64};
  const hid_t file = H5Fcreate(path("b.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(how, 3, chunk.data());
  const hid_t space = H5Screate_simple(3, sides.data(), nullptr);
  H5Dclose(H5Dcreate2(file, "huge", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT));
  H5Sclose(space);
  H5Pclose(how);
  H5Fclose(file);
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("b.h5")); }), "its values"));
}

/// Turns all bits around, by a number of those that HDF5's authors leave for tests.
constexpr H5Z_filter_t own_filter = 300;

std::size_t turn_bits(unsigned, std::size_t, const unsigned[], std::size_t bytes, std::size_t*,
                      void** buffer) {
  auto* const at = static_cast<unsigned char*>(*buffer);
  for (std::size_t i = 0; i < bytes; ++i) at[i] = static_cast<unsigned char>(~at[i]);
  return bytes;
}

TEST_F(Hdf5, AFilterThatIsMissingIsNamed) {
  const H5Z_class2_t filter{H5Z_CLASS_T_VERS, own_filter, 1,       1,
                            "bits of tests",  nullptr,    nullptr, turn_bits};
  ASSERT_GE(H5Zregister(&filter), 0);
  const hsize_t sides[] = {3, 4, 5};
  const hid_t how = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(3, sides, nullptr);
  H5Pset_chunk(how, 3, sides);
  H5Pset_shuffle(how);
  H5Pset_filter(how, own_filter, H5Z_FLAG_MANDATORY, 0, nullptr);
  const hid_t file = H5Fcreate(path("b.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t set = H5Dcreate2(file, "v", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
  const std::vector<double> values = counting<double>();
  EXPECT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Pclose(how);
  H5Fclose(file);
  expect_counting(read_volume(path("b.h5")), "f64");
  ASSERT_GE(H5Zunregister(own_filter), 0);
  const std::string error = error_of([&] { read_volume(path("b.h5")); });
  EXPECT_TRUE(contains(error, "filter 300 (bits of tests)")) << error;
  EXPECT_TRUE(contains(error, "HDF5_PLUGIN_PATH")) << error;
#ifdef PELLUCID_HAVE_NETCDF
  write("b.nc", ScratchFolder::read(path("b.h5")));
  const std::string by_net_cdf = error_of([&] { read_volume(path("b.nc")); });
  EXPECT_TRUE(contains(by_net_cdf, "HDF5_PLUGIN_PATH")) << by_net_cdf;
#endif
  // A file that is damaged needs none.
  add_counting<double>("packed", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, true);
  close();
  const std::string whole = ScratchFolder::read(path("a.h5"));
  std::string damaged = whole;
  for (std::size_t i = whole.size() / 2; i < whole.size(); ++i) damaged[i] = '\x5a';
  write("c.h5", damaged);
  EXPECT_FALSE(contains(error_of([&] { read_volume(path("c.h5")); }), "filter"));
}

TEST_F(Hdf5, CutOffIsAnError) {
  add_counting<double>("plain", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
  add_counting<double>("packed", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, true);
  close();
  const std::string whole = ScratchFolder::read(path("a.h5"));
  for (std::size_t length = 0; length < whole.size(); length += 97) {
    SCOPED_TRACE(length);
    write("cut.h5", whole.substr(0, length));
    error_of([&] { read_volume(path("cut.h5")); });
  }
}

}  // namespace
}  // namespace pellucid::test_hdf5

#endif
