// SPDX-License-Identifier: Apache-2.0
//
// Values of NetCDF that are missing, packed or out of range, and positions of the same kinds.
#ifdef PELLUCID_HAVE_NETCDF

#include <netcdf.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "net_cdf_files.h"
#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_net_cdf_values {
namespace {

using test::ClassicAttribute;
using test::ClassicFile;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::value_at;

class NetCdfValues : public test::ScratchFolder {
 protected:
  /// Writes v on z, y, x of 3, 4, 5, and x as stored.
  void write_file(char type, const std::vector<double>& values,
                  const std::vector<ClassicAttribute>& attributes = {}, char type_of_x = 'd',
                  const std::vector<double>& x = {0, 1, 2, 3, 4},
                  const std::vector<ClassicAttribute>& attributes_of_x = {}) const {
    ClassicFile file;
    file.axes = {{"z", 3}, {"y", 4}, {"x", 5}};
    file.variables = {{"x", type_of_x, {"x"}, x, attributes_of_x},
                      {"v", type, {"z", "y", "x"}, values, attributes}};
    write("a.nc", file.bytes());
  }
  Volume read_file() {
    notes_.clear();
    ReadOptions options;
    options.note = [this](const std::string& note) { notes_ += note + "\n"; };
    return read_volume(path("a.nc"), options);
  }
  std::size_t missing() { return read_file().statistics().nan; }

  std::string notes_;
};

TEST_F(NetCdfValues, DefaultFillsAreMissing) {
  const auto with = [](double fill) {
    std::vector<double> values = counting<double>();
    for (std::size_t i = 40; i < 60; ++i) values[i] = fill;
    return values;
  };
  write_file('h', with(-32767));
  EXPECT_EQ(missing(), 20u);
  EXPECT_TRUE(contains(notes_,
                       "20 values of \"v\" are -32767, which stands where nothing was "
                       "written, and are missing"))
      << notes_;
  EXPECT_EQ(type_name(read_file().data()), "f32");
  EXPECT_EQ(value_at(read_file(), 4, 3, 1), 39);
  write_file('i', with(-2147483647));
  EXPECT_EQ(missing(), 20u);
  EXPECT_EQ(type_name(read_file().data()), "f64");
  write_file('f', with(9.969209968386869e36));
  EXPECT_EQ(missing(), 20u);
  write_file('d', with(9.969209968386869e36));
  EXPECT_EQ(missing(), 20u);
  // Packed ones are missing, and not scaled.
  write_file('h', with(-32767), {{"scale_factor", 'd', {0.5}}});
  EXPECT_EQ(missing(), 20u);
  write_file('h', with(-32767), {{"_Unsigned", "true"}});
  EXPECT_EQ(missing(), 20u);
  // Bytes have no default, and a file that names a fill value has another.
  write_file('b', with(-127));
  EXPECT_EQ(missing(), 0u);
  write_file('h', with(-32767), {{"_FillValue", 'h', {-1}}});
  EXPECT_EQ(missing(), 0u);
  write_file('h', with(-32766));
  EXPECT_EQ(missing(), 0u);
  EXPECT_EQ(type_name(read_file().data()), "i16");
}

TEST_F(NetCdfValues, DefaultFillsOfTheNewerTypes) {
  const std::vector<std::pair<nc_type, double>> fills{{NC_USHORT, 65535},
                                                      {NC_UINT, 4294967295.0},
                                                      {NC_INT64, -9223372036854775806.0},
                                                      {NC_UINT64, 18446744073709551614.0}};
  for (const auto& [type, fill] : fills) {
    for (const bool has_fill : {true, false}) {
      SCOPED_TRACE(type);
      int file = -1, id = -1, axes[3] = {};
      ASSERT_EQ(nc_create(path("a.nc").c_str(), NC_CLOBBER | NC_NETCDF4, &file), NC_NOERR);
      const std::size_t sides[] = {3, 4, 5};
      const char* const names[] = {"z", "y", "x"};
      for (int a = 0; a < 3; ++a) nc_def_dim(file, names[a], sides[a], &axes[a]);
      nc_def_var(file, "v", type, 3, axes, &id);
      if (!has_fill) nc_def_var_fill(file, id, NC_NOFILL, nullptr);
      nc_enddef(file);
      const std::size_t start[] = {0, 0, 0}, count[] = {2, 4, 5};
      ASSERT_EQ(nc_put_vara_double(file, id, start, count, counting<double>().data()), NC_NOERR);
      if (!has_fill) {
        const std::size_t rest[] = {2, 0, 0}, one[] = {1, 4, 5};
        ASSERT_EQ(nc_put_vara_double(file, id, rest, one, counting<double>().data()), NC_NOERR);
      }
      ASSERT_EQ(nc_close(file), NC_NOERR);
      EXPECT_EQ(missing(), has_fill ? 20u : 0u);
      EXPECT_EQ(value_at(read_file(), 4, 3, 1), 39);
      EXPECT_EQ(value_at(read_file(), 1, 0, 0), 1);
    }
  }
}

TEST_F(NetCdfValues, SeveralMissingValues) {
  write_file('h', counting<double>(),
             {{"missing_value", 'h', {3, 4, 5}}, {"_FillValue", 'h', {7}}});
  EXPECT_EQ(missing(), 4u);
  // A fraction is no whole number, and neither is a number beyond the type.
  write_file('h', counting<double>(), {{"missing_value", 'd', {3.5, 1e9, -1e300}}});
  EXPECT_EQ(missing(), 0u);
  // 1e20 as double is another number than in float.
  std::vector<double> values = counting<double>();
  values[5] = values[6] = 1e20;
  write_file('f', values, {{"missing_value", 'd', {1e20}}});
  EXPECT_EQ(missing(), 2u);
  write_file('h', counting<double>(), {{"missing_value", "7"}});
  EXPECT_EQ(missing(), 0u);
  EXPECT_TRUE(contains(notes_, "the missing_value of \"v\" is no number")) << notes_;
}

TEST_F(NetCdfValues, ValidRanges) {
  const auto valid = [&](char type, const std::vector<ClassicAttribute>& attributes) {
    write_file(type, counting<double>(), attributes);
    return 60 - missing();
  };
  EXPECT_EQ(valid('h', {{"valid_range", 'h', {10, 19}}}), 10u);
  EXPECT_EQ(valid('f', {{"valid_range", 'd', {10, 19}}}), 10u);
  EXPECT_EQ(valid('i', {{"valid_min", 'i', {50}}}), 10u);
  EXPECT_EQ(valid('d', {{"valid_max", 'd', {8.5}}}), 9u);
  EXPECT_EQ(valid('b', {{"valid_min", 'b', {5}}, {"valid_max", 'b', {8}}}), 4u);
  // Of packed numbers in their own type, of values in another.
  write_file('h', counting<double>(), {{"scale_factor", 'd', {0.5, 2}}});
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.nc")); }), "has 2 numbers"));
  const ClassicAttribute scale{"scale_factor", 'd', {0.5}}, offset{"add_offset", 'd', {100}};
  EXPECT_EQ(valid('h', {scale, offset, {"valid_range", 'h', {10, 19}}}), 10u);
  EXPECT_EQ(valid('h', {scale, offset, {"valid_range", 'd', {105, 110}}}), 11u);
  EXPECT_EQ(valid('f', {scale, {"valid_max", 'f', {9}}}), 10u);
  // Unsigned bytes write theirs with a sign.
  EXPECT_EQ(valid('b', {{"_Unsigned", "true"}, {"valid_range", 'b', {0, -1}}}), 60u);
  // Those that say nothing are told of.
  EXPECT_EQ(valid('h', {{"valid_range", 'h', {10}}}), 60u);
  EXPECT_TRUE(contains(notes_, "valid_range of \"v\" is no pair of numbers")) << notes_;
  EXPECT_EQ(valid('h', {{"valid_range", 'h', {19, 10}}}), 60u);
  EXPECT_TRUE(contains(notes_, "is empty")) << notes_;
  EXPECT_EQ(valid('h', {{"valid_max", "19"}}), 60u);
  EXPECT_TRUE(contains(notes_, "valid_max")) << notes_;
}

TEST_F(NetCdfValues, PositionsArePackedUnsignedOrMissing) {
  const auto first_and_last = [&](char type, const std::vector<double>& stored,
                                  const std::vector<ClassicAttribute>& attributes) {
    write_file('f', counting<double>(), {}, type, stored, attributes);
    const Volume volume = read_file();
    return std::vector<double>{test::world_of(volume, 0, 0, 0).x,
                               test::world_of(volume, 4, 0, 0).x};
  };
  using Places = std::vector<double>;
  EXPECT_EQ(first_and_last('h', {30000, 32000, -31536, -29536, -27536}, {{"_Unsigned", "true"}}),
            (Places{30000, 38000}));
  EXPECT_EQ(first_and_last('b', {100, 120, -116, -96, -76}, {{"_Unsigned", "TRUE"}}),
            (Places{100, 180}));
  EXPECT_EQ(first_and_last('h', {0, 2, 4, 6, 8},
                           {{"scale_factor", 'd', {0.25}}, {"add_offset", 'd', {10}}}),
            (Places{10, 12}));
  const auto error = [&](char type, double stored,
                         const std::vector<ClassicAttribute>& attributes) {
    write_file('f', counting<double>(), {}, type, {0, 1, 2, 3, stored}, attributes);
    return error_of([&] { read_file(); });
  };
  // A grid of 1e37 would be the answer otherwise.
  for (const std::string& message :
       {error('f', 9.969209968386869e36, {}), error('d', 9.969209968386869e36, {}),
        error('h', -32767, {}), error('d', 4, {{"missing_value", 'd', {4}}}),
        error('d', 4, {{"valid_max", 'd', {3}}}),
        error('f', 1e20, {{"_FillValue", 'd', {1e20}}})}) {
    EXPECT_TRUE(contains(message, "position along x of number 5 (x) is missing")) << message;
    EXPECT_TRUE(contains(message, "give a spacing")) << message;
  }
}

// h5netcdf and others write attributes as texts of any length, which are another type.
TEST_F(NetCdfValues, AttributesOfTheNewerText) {
  int file = -1, id = -1, time = -1, axes[3] = {};
  ASSERT_EQ(nc_create(path("a.nc").c_str(), NC_CLOBBER | NC_NETCDF4, &file), NC_NOERR);
  const std::size_t sides[] = {3, 4, 5};
  const char* const names[] = {"a", "y", "x"};
  for (int a = 0; a < 3; ++a) nc_def_dim(file, names[a], sides[a], &axes[a]);
  nc_def_var(file, "v", NC_BYTE, 3, axes, &id);
  nc_def_var(file, "a", NC_DOUBLE, 1, axes, &time);
  const char *units = "days since 2000-01-01", *yes = "true";
  nc_put_att_string(file, time, "units", 1, &units);
  nc_put_att_string(file, id, "_Unsigned", 1, &yes);
  ASSERT_EQ(nc_close(file), NC_NOERR);
  EXPECT_TRUE(contains(error_of([&] { read_file(); }), "axis a is time and not z"));
}

}  // namespace
}  // namespace pellucid::test_net_cdf_values

#endif
