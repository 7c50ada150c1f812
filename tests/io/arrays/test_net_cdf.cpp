// SPDX-License-Identifier: Apache-2.0
#ifdef PELLUCID_HAVE_NETCDF

#include <netcdf.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_net_cdf {
namespace {

using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::world_of;

/// Numbers of a classic file: big-endian, padded to four bytes.
class Classic {
 public:
  Classic& number(std::uint32_t n) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(n >> shift);
    return *this;
  }
  Classic& text(const std::string& name) {
    number(static_cast<std::uint32_t>(name.size()));
    bytes += name;
    while (bytes.size() % 4 != 0) bytes += '\0';
    return *this;
  }
  std::string bytes;
};

/// A classic file byte by byte: the variable v of floats on axes z, y, x of 3, 4, 5, and x at
/// 10, 12, 14, 16, 18.
std::string classic() {
  Classic file;
  file.bytes = std::string("CDF\1", 4);
  file.number(0).number(10).number(3);
  file.text("z").number(3).text("y").number(4).text("x").number(5);
  file.number(0).number(0);         // no attributes
  file.number(11).number(2);        // variables
  const std::uint32_t first = 148;  // where values begin, checked below
  file.text("v").number(3).number(0).number(1).number(2).number(0).number(0);
  file.number(5).number(240).number(first);
  file.text("x").number(1).number(2).number(0).number(0).number(5).number(20).number(first + 240);
  EXPECT_EQ(file.bytes.size(), first);
  const auto add = [&](float value) { file.number(std::bit_cast<std::uint32_t>(value)); };
  for (const float value : counting()) add(value);
  for (int i = 0; i < 5; ++i) add(static_cast<float>(10 + 2 * i));
  return file.bytes;
}

class NetCdf : public test::ScratchFolder {
 protected:
  /// A file of four axes t, z, y, x of 2, 3, 4, 5, to which more is added by NetCDF itself.
  void create(int mode) {
    ok(nc_create(path("a.nc").c_str(), mode, &file_));
    const char* const names[] = {"t", "z", "y", "x"};
    for (int a = 0; a < 4; ++a) ok(nc_def_dim(file_, names[a], sides[a], &axes_[a]));
  }
  int define(const std::string& name, nc_type type, int first = 1, int count = 3) {
    int id = -1;
    ok(nc_def_var(file_, name.c_str(), type, count, axes_ + first, &id));
    return id;
  }
  void finish() {
    ok(nc_close(file_));
    file_ = -1;
  }
  Volume parse(const std::string& array = "") const {
    ReadOptions options;
    if (!array.empty()) options.array = array;
    return read_volume(path("a.nc"), options);
  }
  static void ok(int status) { ASSERT_EQ(status, NC_NOERR) << nc_strerror(status); }

  static constexpr std::size_t sides[] = {2, 3, 4, 5};
  int file_ = -1;
  int axes_[4] = {};
};

TEST_F(NetCdf, ClassicByteByByte) {
  write("a.nc", classic());
  const Volume volume = parse();
  expect_counting(volume, "f32");
  expect_near(world_of(volume, 0, 0, 0), {10, 0, 0}, 0);
  expect_near(world_of(volume, 4, 3, 2), {18, 3, 2}, 0);
  for (std::size_t length = 0; length < classic().size(); length += 13) {
    SCOPED_TRACE(length);
    write("a.nc", classic().substr(0, length));
    error_of([&] { parse(); });
  }
}

TEST_F(NetCdf, ScalesThatAreTextAreNamed) {
  for (const char* attribute : {"scale_factor", "add_offset"}) {
    create(NC_CLOBBER);
    const int id = define("v", NC_FLOAT);
    ok(nc_put_att_text(file_, id, attribute, 3, "0.5"));
    ok(nc_enddef(file_));
    ok(nc_put_var_float(file_, id, counting().data()));
    finish();
    const std::string message = error_of([&] { parse(); });
    EXPECT_TRUE(contains(message, std::string(attribute) + " of \"v\" is no finite number"))
        << message;
  }
}

// Each component that is looked at takes a process of its own; and one array that is not read does
// not hide the others.
TEST_F(NetCdf, ListsManyStepsAndArraysThatAreNotRead) {
  ok(nc_create(path("a.nc").c_str(), NC_CLOBBER, &file_));
  const char* const names[] = {"t", "z", "y", "x"};
  for (int a = 0; a < 4; ++a) ok(nc_def_dim(file_, names[a], a == 0 ? 70 : 2, &axes_[a]));
  define("v", NC_FLOAT, 0, 4);
  const int bad = define("bad", NC_FLOAT);
  ok(nc_put_att_text(file_, bad, "scale_factor", 3, "0.5"));
  ok(nc_enddef(file_));
  finish();
  const std::vector<VolumeArray> arrays = list_arrays(path("a.nc"));
  ASSERT_EQ(arrays.size(), 2u);
  EXPECT_EQ(arrays[0].components.size(), 64u);
  EXPECT_EQ(arrays[0].more_components, 6);
  EXPECT_EQ(arrays[1].name, "bad");
  EXPECT_TRUE(contains(arrays[1].unreadable_reason, "scale_factor")) << arrays[1].unreadable_reason;
}

TEST_F(NetCdf, TimeIsNotDepth) {
  for (const auto& [attribute, text] : {std::pair{"units", "days since 1990-1-1"},
                                        std::pair{"axis", "T"}, std::pair{"units", "m"}}) {
    create(NC_CLOBBER);
    const int id = define("v", NC_FLOAT), z = define("z", NC_FLOAT, 1, 1);
    ok(nc_put_att_text(file_, z, attribute, std::strlen(text), text));
    ok(nc_enddef(file_));
    ok(nc_put_var_float(file_, id, counting().data()));
    const float depths[] = {0, 1, 2};
    ok(nc_put_var_float(file_, z, depths));
    finish();
    if (std::string(text) == "m") {
      expect_counting(parse(), "f32");
    } else {
      const std::string message = error_of([&] { parse(); });
      EXPECT_TRUE(contains(message, "axis z is time and not z")) << message;
    }
  }
}

// What a header says of a variable's bytes is redundant: the lengths of its axes count.
TEST_F(NetCdf, AxesBeyondTheFileAreRefused) {
  std::string bytes = classic();
  const std::size_t length_of_y = bytes.find('y') + 4;
  bytes[length_of_y + 2] = 1;  // 260 in place of 4
  write("a.nc", bytes);
  EXPECT_TRUE(contains(error_of([&] { parse(); }), "header says 15748"));
  // One byte of the last value.
  bytes = classic();
  write("a.nc", bytes.substr(0, bytes.size() - 1));
  EXPECT_TRUE(contains(error_of([&] { parse(); }), "cut off"));
}

TEST_F(NetCdf, RecordsAreCountedWithTheirPadding) {
  for (const int variables : {1, 2}) {
    SCOPED_TRACE(variables);
    ok(nc_create(path("a.nc").c_str(), NC_CLOBBER, &file_));
    int axes[4] = {}, id = 0;
    ok(nc_def_dim(file_, "t", NC_UNLIMITED, &axes[0]));
    for (int a = 1; a < 4; ++a)
      ok(nc_def_dim(file_, std::string(1, "tzyx"[a]).c_str(), 3, &axes[a]));
    for (int v = 0; v < variables; ++v) {
      ok(nc_def_var(file_, std::string(1, static_cast<char>('a' + v)).c_str(), NC_BYTE, 4, axes,
                    &id));
    }
    ok(nc_enddef(file_));
    const std::vector<signed char> values(81, 5);
    const std::size_t start[4] = {}, count[4] = {3, 3, 3, 3};
    for (int v = 0; v < variables; ++v)
      ok(nc_put_vara_schar(file_, v, start, count, values.data()));
    finish();
    const std::string whole = ScratchFolder::read(path("a.nc"));
    ReadOptions options;
    options.array = variables == 1 ? "a" : "b";
    options.component = 2;
    EXPECT_EQ(read_volume(path("a.nc"), options).statistics().minimum, 5);
    write("a.nc", whole.substr(0, whole.size() - 4));
    EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.nc"), options); }), "cut off"));
  }
}

TEST_F(NetCdf, EveryTypeOfEveryFormat) {
  for (const int mode : {NC_CLOBBER, NC_CLOBBER | NC_64BIT_OFFSET, NC_CLOBBER | NC_64BIT_DATA,
                         NC_CLOBBER | NC_NETCDF4}) {
    SCOPED_TRACE(mode);
    const bool new_types = (mode & (NC_NETCDF4 | NC_64BIT_DATA)) != 0;
    create(mode);
    std::vector<std::pair<std::string, nc_type>> types{
        {"i8", NC_BYTE}, {"i16", NC_SHORT}, {"i32", NC_INT}, {"f32", NC_FLOAT}, {"f64", NC_DOUBLE}};
    if (new_types) {
      types.insert(types.end(), {{"u8", NC_UBYTE},
                                 {"u16", NC_USHORT},
                                 {"u32", NC_UINT},
                                 {"i64", NC_INT64},
                                 {"u64", NC_UINT64}});
    }
    std::vector<int> ids;
    for (const auto& [name, type] : types) ids.push_back(define(name, type));
    ok(nc_enddef(file_));
    for (const int id : ids) ok(nc_put_var_double(file_, id, counting<double>().data()));
    finish();
    for (const auto& [name, type] : types) {
      SCOPED_TRACE(name);
      expect_counting(parse(name), name == "i64" || name == "u64" ? "u8" : name);
    }
    EXPECT_EQ(list_arrays(path("a.nc")).size(), types.size());
  }
}

TEST_F(NetCdf, PositionsOfTheAxes) {
  create(NC_CLOBBER);
  const int v = define("v", NC_FLOAT);
  const int x = define("x", NC_DOUBLE, 3, 1), y = define("y", NC_FLOAT, 2, 1),
            z = define("z", NC_INT, 1, 1);
  ok(nc_enddef(file_));
  ok(nc_put_var_double(file_, v, counting<double>().data()));
  const double longitudes[] = {0, 0.5, 1, 1.5, 2}, latitudes[] = {45.3, 45.2, 45.1, 45},
               levels[] = {1000, 850, 500};
  ok(nc_put_var_double(file_, x, longitudes));
  ok(nc_put_var_double(file_, y, latitudes));
  ok(nc_put_var_double(file_, z, levels));
  finish();
  const Volume volume = parse();
  const Volume::Description& d = volume.description();
  EXPECT_EQ(d.placement.spacing.x, 0.5);
  // Descending in binary32, but of one distance as far as it can tell.
  EXPECT_TRUE(d.coordinates[1].empty());
  EXPECT_NEAR(d.placement.spacing.y, 0.1, 1e-6);
  EXPECT_EQ(d.placement.direction.column[1].y, -1);
  EXPECT_EQ(d.coordinates[2], (std::vector<double>{-1000, -850, -500}));
  expect_near(volume.world_from_grid().point(volume.grid_lower()), {0, 45.3, 1000}, 1e-5);
  ReadOptions options;
  options.spacing = {1, 1, 2};
  expect_near(world_of(read_volume(path("a.nc"), options), 4, 3, 2), {4, 3, 4}, 0);
}

TEST_F(NetCdf, ScaledAndMissing) {
  create(NC_CLOBBER | NC_NETCDF4);
  const int packed = define("packed", NC_SHORT), plain = define("plain", NC_BYTE),
            filled = define("filled", NC_FLOAT), unwritten = define("unwritten", NC_FLOAT),
            bytes = define("bytes", NC_BYTE);
  const double scale = 0.5, offset = 100;
  const short fill = 7;
  ok(nc_put_att_double(file_, packed, "scale_factor", NC_DOUBLE, 1, &scale));
  ok(nc_put_att_double(file_, packed, "add_offset", NC_DOUBLE, 1, &offset));
  ok(nc_put_att_short(file_, packed, "_FillValue", NC_SHORT, 1, &fill));
  const signed char absent = 99, minus = -1;
  ok(nc_put_att_schar(file_, plain, "_FillValue", NC_BYTE, 1, &absent));
  // An attribute of another type than the values.
  const double missing[] = {8, 9};
  ok(nc_put_att_double(file_, filled, "missing_value", NC_DOUBLE, 2, missing));
  ok(nc_put_att_text(file_, bytes, "_Unsigned", 4, "true"));
  ok(nc_put_att_schar(file_, bytes, "_FillValue", NC_BYTE, 1, &minus));
  ok(nc_enddef(file_));
  for (const int id : {packed, plain, filled}) {
    ok(nc_put_var_double(file_, id, counting<double>().data()));
  }
  std::vector<signed char> of_bytes(60, -56);
  of_bytes[1] = -1;
  ok(nc_put_var_schar(file_, bytes, of_bytes.data()));
  finish();
  (void)unwritten;
  const Volume scaled = parse("packed");
  EXPECT_EQ(type_name(scaled.data()), "f32");
  EXPECT_TRUE(std::isnan(test::value_at(scaled, 2, 1, 0)));
  EXPECT_EQ(test::value_at(scaled, 3, 1, 0), 104);
  EXPECT_EQ(scaled.statistics().nan, 1u);
  // No value is missing, and the type stays.
  expect_counting(parse("plain"), "i8");
  EXPECT_EQ(parse("filled").statistics().nan, 2u);
  EXPECT_EQ(parse("unwritten").statistics().nan, 60u);
  const Volume wide = parse("bytes");
  EXPECT_TRUE(std::isnan(test::value_at(wide, 1, 0, 0)));
  EXPECT_EQ(test::value_at(wide, 0, 0, 0), 200);
}

TEST_F(NetCdf, StepsInTime) {
  create(NC_CLOBBER);
  const int v = define("v", NC_INT, 0, 4), t = define("t", NC_DOUBLE, 0, 1);
  ok(nc_enddef(file_));
  std::vector<int> values(120);
  for (int i = 0; i < 120; ++i) values[static_cast<std::size_t>(i)] = i;
  const double times[] = {0.5, 6};
  ok(nc_put_var_int(file_, v, values.data()));
  ok(nc_put_var_double(file_, t, times));
  finish();
  EXPECT_TRUE(contains(error_of([&] { parse(); }), "2 steps (axis t) in \"v\""));
  ReadOptions options;
  options.time = 5;
  EXPECT_EQ(test::value_at(read_volume(path("a.nc"), options), 0, 0, 0), 60);
  EXPECT_EQ(read_components(path("a.nc"), options).size(), 1u);
  for (const double time : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    options.time = time;
    EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.nc"), options); }), "finite number"));
  }
  options.time = -1e9;
  EXPECT_EQ(test::value_at(read_volume(path("a.nc"), options), 0, 0, 0), 0);
  options.component = 1;
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.nc"), options); }), "not both"));
  options.time.reset();
  EXPECT_EQ(test::value_at(read_volume(path("a.nc"), options), 4, 3, 2), 119);
}

TEST_F(NetCdf, PositionsAreScaledAndThoseOfAGroupAround) {
  create(NC_CLOBBER | NC_NETCDF4);
  const int x = define("x", NC_SHORT, 3, 1);
  const double scale = 0.25, offset = 10;
  ok(nc_put_att_double(file_, x, "scale_factor", NC_DOUBLE, 1, &scale));
  ok(nc_put_att_double(file_, x, "add_offset", NC_DOUBLE, 1, &offset));
  int group = -1, id = -1;
  ok(nc_def_grp(file_, "inner", &group));
  ok(nc_def_var(group, "v", NC_DOUBLE, 3, axes_ + 1, &id));
  ok(nc_enddef(file_));
  ok(nc_put_var_double(group, id, counting<double>().data()));
  const short places[] = {0, 2, 4, 6, 8};
  ok(nc_put_var_short(file_, x, places));
  finish();
  const Volume volume = parse("inner/v");
  EXPECT_EQ(volume.description().placement.spacing.x, 0.5);
  expect_near(world_of(volume, 4, 0, 0), {12, 0, 0}, 0);
}

TEST_F(NetCdf, GroupsAndWhatIsNoVolume) {
  create(NC_CLOBBER | NC_NETCDF4);
  define("line", NC_FLOAT, 3, 1);
  define("letters", NC_CHAR);
  int group = -1, id = -1;
  ok(nc_def_grp(file_, "inner", &group));
  ok(nc_def_var(group, "v", NC_DOUBLE, 3, axes_ + 1, &id));
  ok(nc_enddef(file_));
  ok(nc_put_var_double(group, id, counting<double>().data()));
  finish();
  expect_counting(parse("inner/v"), "f64");
  expect_counting(parse(), "f64");
  EXPECT_TRUE(contains(error_of([&] { parse("line"); }), "inner/v"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(write("b.nc", "no")); }), "NetCDF cannot"));
  error_of([&] { read_volume(write("c.nc", "")); });
}

}  // namespace
}  // namespace pellucid::test_net_cdf

#endif
