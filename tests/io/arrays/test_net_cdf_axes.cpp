// SPDX-License-Identifier: Apache-2.0
//
// Axes of NetCDF by what the file says of them, and not by their places.
#ifdef PELLUCID_HAVE_NETCDF

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "net_cdf_files.h"
#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_net_cdf_axes {
namespace {

using test::ClassicAttribute;
using test::ClassicFile;
using test::contains;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::value_at;
using test::world_of;

/// An axis with its side, and the coordinate's attributes, if it has one.
struct Axis {
  std::string name;
  int side = 1;
  std::vector<ClassicAttribute> attributes = {};
  std::vector<double> positions = {};
};

class NetCdfAxes : public test::ScratchFolder {
 protected:
  /// Writes v, whose values say their place: x + 5 y + 20 z + 60 more, where x, y, z are the axes
  /// of 5, 4 and 3 entries, and `more` counts those of other sides in their order.
  std::filesystem::path write_file(const std::vector<Axis>& axes,
                                   const std::vector<ClassicAttribute>& attributes = {},
                                   const std::vector<test::ClassicVariable>& others = {}) const {
    ClassicFile file;
    test::ClassicVariable v{"v", 'i', {}, {}, attributes};
    for (const Axis& axis : axes) {
      file.axes.emplace_back(axis.name, axis.side);
      v.axes.push_back(axis.name);
      if (axis.attributes.empty() && axis.positions.empty()) continue;
      std::vector<double> positions = axis.positions;
      for (int i = 0; positions.size() < static_cast<std::size_t>(axis.side); ++i) {
        positions.push_back(10 + 2 * i);
      }
      file.variables.push_back({axis.name, 'd', {axis.name}, positions, axis.attributes});
    }
    std::vector<int> index(axes.size(), 0);
    bool goes_on = std::ranges::all_of(axes, [](const Axis& axis) { return axis.side > 0; });
    while (goes_on) {
      int value = 0, more = 0;
      for (std::size_t a = 0; a < axes.size(); ++a) {
        const int side = axes[a].side;
        if (side == 5) value += index[a];
        if (side == 4) value += 5 * index[a];
        if (side == 3) value += 20 * index[a];
        if (side == 2 || side > 5) more = more * side + index[a];
      }
      v.values.push_back(value + 60 * more);
      std::size_t a = axes.size();
      while (a > 0 && ++index[a - 1] == axes[a - 1].side) index[--a] = 0;
      goes_on = a > 0;
    }
    for (const auto& other : others) file.variables.push_back(other);
    file.variables.push_back(v);
    return write("a.nc", file.bytes());
  }
  Volume read_file(const ReadOptions& given = {}) {
    notes_.clear();
    ReadOptions options = given;
    if (!options.array) options.array = "v";
    options.note = [this](const std::string& note) { notes_ += note + "\n"; };
    return read_volume(path("a.nc"), options);
  }
  void expect_volume(const std::vector<Axis>& axes) {
    write_file(axes);
    std::string names;
    for (const Axis& axis : axes) names += axis.name + " ";
    SCOPED_TRACE(names);
    expect_counting(read_file(), "i32");
  }
  std::string error_of_file() {
    return error_of([&] { read_file(); });
  }

  std::string notes_;
};

TEST_F(NetCdfAxes, AnyOrderByWhatMarksThem) {
  const ClassicAttribute east{"units", "degrees_east"}, north{"units", "degreesN"},
      pressure{"units", "hPa"};
  const std::vector<std::array<Axis, 3>> kinds{
      {Axis{"a", 5, {{"axis", "X"}}}, Axis{"b", 4, {{"axis", "Y"}}}, Axis{"c", 3, {{"axis", "Z"}}}},
      {Axis{"a", 5, {east}}, Axis{"b", 4, {north}}, Axis{"c", 3, {pressure}}},
      {Axis{"a", 5, {{"standard_name", "longitude"}}},
       Axis{"b", 4, {{"standard_name", "projection_y_coordinate"}}},
       Axis{"c", 3, {{"standard_name", "ocean_sigma_coordinate"}}}},
      {Axis{"a", 5, {{"_CoordinateAxisType", "Lon"}}}, Axis{"b", 4, {{"cartesian_axis", "Y"}}},
       Axis{"c", 3, {{"positive", "up"}}}},
      {Axis{"lon", 5}, Axis{"lat", 4}, Axis{"lev", 3}},
      {Axis{"longitude", 5}, Axis{"latitude", 4}, Axis{"altitude", 3}},
      {Axis{"nav_lon", 5}, Axis{"nav_lat", 4}, Axis{"deptht", 3}},
      {Axis{"xi_rho", 5}, Axis{"eta_rho", 4}, Axis{"s_rho", 3}},
      {Axis{"west_east", 5}, Axis{"south_north", 4}, Axis{"bottom_top", 3}},
      {Axis{"lon_0", 5}, Axis{"lat_0", 4}, Axis{"lv_ISBL0", 3}},
      {Axis{"grid_xt", 5}, Axis{"grid_yt", 4}, Axis{"pfull", 3}},
      {Axis{"x", 5}, Axis{"y", 4}, Axis{"isobaricInhPa", 3}},
      {Axis{"tomo_xdim", 5}, Axis{"tomo_ydim", 4}, Axis{"tomo_zdim", 3}},
      {Axis{"dim_x", 5}, Axis{"ny", 4}, Axis{"zdim", 3}},
      {Axis{"xspace", 5}, Axis{"yspace", 4}, Axis{"zspace", 3}},
      {Axis{"width", 5}, Axis{"height", 4}, Axis{"depth", 3}},
      // Two that say what they are, and one that does not.
      {Axis{"rlon", 5}, Axis{"rlat", 4}, Axis{"k", 3}},
      {Axis{"i", 5}, Axis{"rlat", 4}, Axis{"plev", 3}}};
  for (const auto& kind : kinds) {
    std::array<int, 3> order{0, 1, 2};
    do {
      expect_volume({kind[static_cast<std::size_t>(order[0])],
                     kind[static_cast<std::size_t>(order[1])],
                     kind[static_cast<std::size_t>(order[2])]});
    } while (std::ranges::next_permutation(order).found);
  }
  // What is marked counts more than what is named.
  expect_volume({Axis{"x", 3, {{"axis", "Z"}}}, Axis{"y", 5, {{"axis", "X"}}},
                 Axis{"z", 4, {{"axis", "Y"}}}});
  // None says anything, or all the same: by their places.
  expect_volume({Axis{"k", 3}, Axis{"j", 4}, Axis{"i", 5}});
  expect_volume({Axis{"x3", 3}, Axis{"x2", 4}, Axis{"x1", 5}});
  expect_volume({Axis{"phony_dim_0", 3}, Axis{"phony_dim_1", 4}, Axis{"phony_dim_2", 5}});
}

TEST_F(NetCdfAxes, TurnedAxesHaveTheirPositions) {
  write_file({Axis{"lon", 5, {{"units", "degrees_east"}}, {0, 0.5, 1, 1.5, 2}},
              Axis{"lat", 4, {{"units", "degrees_north"}}, {3, 2, 1, 0}},
              Axis{"lev", 3, {{"axis", "Z"}}, {0, 1, 5}}});
  const Volume volume = read_file();
  expect_counting(volume, "i32");
  const Volume::Description& d = volume.description();
  EXPECT_EQ(d.placement.spacing.x, 0.5);
  EXPECT_EQ(d.placement.direction.column[1].y, -1);
  EXPECT_EQ(d.coordinates[2], (std::vector<double>{0, 1, 5}));
  ReadOptions options;
  options.array = "v";
  options.part = [](const Volume::Description&) { return IndexBox{{1, 2, 0}, {3, 2, 2}}; };
  const Volume part = read_volume(path("a.nc"), options);
  EXPECT_EQ(value_at(part, 0, 0, 0), 1 + 5 * 2);
  EXPECT_EQ(value_at(part, 2, 1, 1), 3 + 5 * 3 + 20);
}

TEST_F(NetCdfAxes, TimeIsAnywhere) {
  const Axis x{"x", 5}, y{"y", 4}, z{"z", 3};
  const std::vector<Axis> times{{"t", 2},
                                {"time", 2},
                                {"ocean_time", 2},
                                {"time_counter", 2},
                                {"valid_time", 2},
                                {"step", 2},
                                {"month", 2},
                                {"a", 2, {{"units", "hours since 1900-01-01"}}},
                                {"a", 2, {{"axis", "T"}}},
                                {"a", 2, {{"standard_name", "time"}}},
                                {"a", 2, {{"standard_name", "forecast_period"}}}};
  for (const Axis& time : times) {
    for (std::size_t place = 0; place < 4; ++place) {
      SCOPED_TRACE(time.name + " " + std::to_string(place));
      std::vector<Axis> axes{z, y, x};
      axes.insert(axes.begin() + static_cast<std::ptrdiff_t>(place), time);
      write_file(axes);
      const std::string error = error_of_file();
      EXPECT_TRUE(contains(error, "2 steps (axis " + time.name + ")")) << error;
      ReadOptions options;
      options.time = time.attributes.empty() ? 1 : 12.1;
      const Volume volume = read_file(options);
      EXPECT_EQ(value_at(volume, 4, 3, 2), 119);
      EXPECT_EQ(value_at(volume, 0, 0, 0), 60);
      options.time.reset();
      options.component = 0;
      EXPECT_EQ(value_at(read_file(options), 4, 3, 2), 59);
    }
  }
}

TEST_F(NetCdfAxes, TimesThatAreMissingAreNotChosen) {
  write_file(
      {Axis{"time", 2, {{"units", "days since 2000-01-01"}, {"_FillValue", 'd', {9e9}}}, {9e9, 3}},
       Axis{"z", 3}, Axis{"y", 4}, Axis{"x", 5}});
  ReadOptions options;
  options.time = 9e9;
  EXPECT_EQ(value_at(read_file(options), 0, 0, 0), 60);
}

TEST_F(NetCdfAxes, OfTwoTimesTheValuesOwnIsTheTime) {
  const std::string since = "hours since 2000-01-01";
  const Axis x{"x", 5}, y{"y", 4}, z{"z", 3};
  const std::vector<std::array<std::string, 4>> cases{
      // Names and standard names: of the other time, of the time.
      {"reftime", "forecast_reference_time", "time", "time"},
      {"time", "forecast_reference_time", "valid", "time"},
      {"reftime", "", "valid", "time"},
      {"time", "forecast_reference_time", "valid_time", ""},
      {"analysis_time", "", "time", ""}};
  for (const auto& [other, of_other, time, of_time] : cases) {
    for (const bool time_is_first : {false, true}) {
      SCOPED_TRACE(other + " " + time + (time_is_first ? " first" : ""));
      Axis other_axis{other, 2, {{"units", since}}, {100, 200}};
      Axis time_axis{time, 2, {{"units", since}}, {0, 6}};
      if (!of_other.empty()) other_axis.attributes.emplace_back("standard_name", of_other);
      if (!of_time.empty()) time_axis.attributes.emplace_back("standard_name", of_time);
      write_file(time_is_first ? std::vector<Axis>{time_axis, other_axis, z, y, x}
                               : std::vector<Axis>{other_axis, time_axis, z, y, x});
      ReadOptions options;
      options.time = 6;
      options.component = 0;
      EXPECT_EQ(value_at(read_file(options), 0, 0, 0), 60 * (time_is_first ? 2 : 1));
      EXPECT_TRUE(contains(notes_, "its axis " + time +
                                       " is the time (--time); its other axes of "
                                       "time (" +
                                       other + ") are taken for components"))
          << notes_;
    }
  }
}

TEST_F(NetCdfAxes, MembersAndSteps) {
  const Axis x{"lon", 5}, y{"lat", 4}, z{"lev", 3};
  const Axis time{"time", 6, {{"units", "hours since 1900-01-01"}}, {0, 6, 12, 18, 24, 30}};
  for (const char* member : {"number", "ensemble", "realization", "ensemble_member"}) {
    for (const bool time_is_first : {false, true}) {
      SCOPED_TRACE(member);
      const Axis members{member, 2};
      write_file(time_is_first ? std::vector<Axis>{time, members, z, y, x}
                               : std::vector<Axis>{members, z, time, y, x});
      const std::string error = error_of_file();
      EXPECT_TRUE(contains(error, "2 members (axis " + std::string(member) + ")")) << error;
      EXPECT_TRUE(contains(error, "6 steps (axis time)")) << error;
      EXPECT_TRUE(contains(error, "0 to 11")) << error;
      ReadOptions options;
      options.component = 8;
      EXPECT_EQ(value_at(read_file(options), 1, 0, 0), 1 + 60 * 8);
      options.time = 13;
      options.component.reset();
      EXPECT_TRUE(contains(error_of([&] { read_file(options); }), "0 to 1"));
      options.component = 1;
      // Step 2 of member 1.
      const int place = time_is_first ? 2 * 2 + 1 : 1 * 6 + 2;
      EXPECT_EQ(value_at(read_file(options), 4, 3, 2), 59 + 60 * place);
    }
  }
}

TEST_F(NetCdfAxes, ImagesAreNoVolumes) {
  const Axis hours{"time", 3, {{"units", "hours since 1900-01-01"}}};
  const auto refusal = [&](const std::vector<Axis>& axes) {
    write_file(axes);
    return error_of_file();
  };
  // Time is neither z nor x nor y, and a member no z.
  EXPECT_TRUE(contains(refusal({hours, {"lat", 4}, {"lon", 5}}), "axis time is time and not z"));
  EXPECT_TRUE(contains(refusal({{"lat", 4}, {"lon", 5}, hours}), "axis time is time and not z"));
  EXPECT_TRUE(contains(refusal({{"lev", 4}, hours, {"lon", 5}}), "axis time is time and not y"));
  EXPECT_TRUE(contains(refusal({{"number", 3}, {"lat", 4}, {"lon", 5}}),
                       "axis number is members of an ensemble and not z"));
  EXPECT_TRUE(contains(refusal({{"realization", 3}, hours, {"lat", 4}, {"lon", 5}}), "not z"));
  // Nothing was written along it.
  EXPECT_TRUE(contains(refusal({{"time", 0}, {"lev", 3}, {"lat", 4}, {"lon", 5}}),
                       "axis time has no entries"));
  // Bands are slices, which is told.
  expect_volume({{"band", 3}, {"y", 4}, {"x", 5}});
  EXPECT_TRUE(contains(notes_, "its axis band is taken for z")) << notes_;
}

TEST_F(NetCdfAxes, PositiveDown) {
  const Axis x{"x", 5}, y{"y", 4};
  for (const bool descends : {false, true}) {
    const std::vector<double> depths =
        descends ? std::vector<double>{20, 10, 0} : std::vector<double>{0, 10, 20};
    write_file({Axis{"depth", 3, {{"positive", "down"}, {"units", "m"}}, depths}, y, x});
    const Volume volume = read_file();
    expect_counting(volume, "i32");
    expect_near(world_of(volume, 0, 0, 0), {0, 0, -depths[0]}, 0);
    expect_near(world_of(volume, 0, 0, 2), {0, 0, -depths[2]}, 0);
    EXPECT_TRUE(contains(notes_, "z is minus depth (positive: down)")) << notes_;
  }
  // Uneven ones, too; and those that are not marked are told of.
  write_file({Axis{"depth", 3, {{"positive", "down"}}, {0, 1, 5}}, y, x});
  const Volume uneven = read_file();
  expect_near(uneven.world_from_grid().point(uneven.grid_lower()), {0, 0, 0}, 1e-12);
  EXPECT_EQ(uneven.description().placement.direction.column[2].z, -1);
  write_file({Axis{"plev", 3, {{"units", "Pa"}}, {1, 2, 3}}, y, x});
  expect_near(world_of(read_file(), 0, 0, 2), {0, 0, 3}, 0);
  EXPECT_TRUE(contains(notes_, "z is plev, which grows downwards")) << notes_;
  for (const char* name : {"depth", "deptht", "ocean_depth_2"}) {
    write_file({Axis{name, 3, {{"units", "m"}}, {0, 10, 20}}, y, x});
    expect_near(world_of(read_file(), 0, 0, 2), {0, 0, 20}, 0);
    EXPECT_TRUE(contains(notes_, std::string("z is ") + name + ", which grows downwards"))
        << notes_;
  }
  write_file({Axis{"depth", 3, {{"positive", "up"}}, {0, 10, 20}}, y, x});
  read_file();
  EXPECT_FALSE(contains(notes_, "downwards")) << notes_;
  write_file({Axis{"p", 3, {{"_CoordinateZisPositive", "down"}}, {0, 10, 20}}, y, x});
  expect_near(world_of(read_file(), 0, 0, 2), {0, 0, -20}, 0);
  const std::string sigma = "atmosphere_hybrid_sigma_pressure_coordinate";
  write_file({Axis{"lev", 3, {{"standard_name", sigma}}, {1, 2, 3}}, y, x});
  read_file();
  EXPECT_TRUE(contains(notes_, "z is lev, which grows downwards")) << notes_;
}

TEST_F(NetCdfAxes, UnitsOfTheAxes) {
  const Axis y{"y", 4, {{"units", "km"}}, {0, 1, 2, 3}}, x{"x", 5, {{"units", "km"}}};
  write_file({Axis{"z", 3, {{"units", "metres"}}, {0, 500, 1000}}, y, x});
  EXPECT_NEAR(read_file().description().placement.spacing.z, 0.5, 1e-12);
  EXPECT_TRUE(contains(notes_, "lengths are turned into km")) << notes_;
  write_file({Axis{"z", 3, {{"units", "km"}}}, y, x});
  read_file();
  EXPECT_EQ(notes_, "");
  write_file({Axis{"z", 3, {{"units", "hPa"}, {"positive", "up"}}},
              Axis{"lat", 4, {{"units", "degrees_north"}}},
              Axis{"lon", 5, {{"units", "degrees_east"}}}});
  read_file();
  EXPECT_TRUE(contains(notes_, "its units (degrees_east, degrees_north, hPa) differ")) << notes_;
}

TEST_F(NetCdfAxes, LongitudesThatJump) {
  const Axis z{"z", 3}, y{"lat", 4};
  const auto first_and_last = [&](const std::vector<double>& longitudes) {
    write_file({z, y, Axis{"lon", 5, {{"units", "degrees_east"}}, longitudes}});
    const Volume volume = read_file();
    return std::vector<double>{world_of(volume, 0, 0, 0).x, world_of(volume, 4, 0, 0).x};
  };
  EXPECT_EQ(first_and_last({356, 358, 0, 2, 4}), (std::vector<double>{356, 364}));
  EXPECT_TRUE(contains(notes_, "longitudes go on")) << notes_;
  EXPECT_EQ(first_and_last({178, -180, -178, -176, -174}), (std::vector<double>{178, 186}));
  EXPECT_EQ(first_and_last({4, 2, 0, 358, 356}), (std::vector<double>{4, -4}));
  // Of other units a jump is none, and twice is too much.
  write_file({z, y, Axis{"x", 5, {{"units", "km"}}, {356, 358, 0, 2, 4}}});
  EXPECT_TRUE(contains(error_of_file(), "do not go on in one direction"));
  write_file({z, y, Axis{"lon", 5, {{"units", "degrees_east"}}, {356, 0, 356, 0, 4}}});
  EXPECT_TRUE(contains(error_of_file(), "do not go on in one direction"));
}

TEST_F(NetCdfAxes, CoordinatesThatAreNoPositions) {
  const Axis x{"x", 5}, y{"y", 4};
  const auto error = [&](const std::vector<double>& positions) {
    write_file({Axis{"z", 3, {{"_FillValue", 'd', {-1}}}, positions}, y, x});
    return error_of_file();
  };
  EXPECT_TRUE(contains(error({0, 1, -1}), "position along z of number 3 (z) is missing"));
  EXPECT_TRUE(contains(error({std::nan(""), 1, 2}), "number 1 (z) is missing"));
  EXPECT_TRUE(contains(error({0, 9.969209968386869e36, 2}), "do not go on") ||
              contains(error({0, 9.969209968386869e36, 2}), "is missing"));
  EXPECT_TRUE(contains(error({0, 2, 1}), "do not go on in one direction"));
  ReadOptions options;
  options.spacing = {1, 1, 1};
  expect_counting(read_file(options), "i32");
}

TEST_F(NetCdfAxes, ACoordinateOfAnotherName) {
  write_file({{"k", 3}, {"j", 4}, {"i", 5}}, {{"coordinates", "height lat lon"}},
             {{"lon", 'd', {"i"}, {0, 1, 2, 3, 4}, {{"units", "degrees_east"}}},
              {"height", 'd', {"k"}, {0, 3, 6}, {}}});
  const Volume volume = read_file();
  expect_counting(volume, "i32");
  EXPECT_EQ(volume.description().placement.spacing.z, 3);
}

TEST_F(NetCdfAxes, VariablesThatBelongToOthers) {
  const std::vector<double> sixty(60, 1);
  write_file(
      {
          Axis{"z", 3, {{"bounds", "z_bnds"}}},
          Axis{"y", 4},
          Axis{"x", 5},
      },
      {{"coordinates", "altitude"}},
      {{"z_bnds", 'd', {"z", "y", "x"}, sixty, {}}, {"altitude", 'd', {"z", "y", "x"}, sixty, {}}});
  ReadOptions options;
  // The first array that belongs to no other is shown.
  expect_counting(read_volume(path("a.nc")), "i32");
  options.array = "z_bnds";
  EXPECT_TRUE(contains(error_of([&] { read_file(options); }), "bounds of cells"));
  const std::vector<VolumeArray> arrays = list_arrays(path("a.nc"));
  ASSERT_EQ(arrays.size(), 3u);
  EXPECT_EQ(arrays[0].name, "v");
  EXPECT_EQ(arrays[1].name, "altitude");
  EXPECT_TRUE(contains(arrays[2].unreadable_reason, "bounds"));
  read_file();
  EXPECT_TRUE(contains(notes_, "curvilinear grid (coordinates altitude)")) << notes_;
  // An axis of corners makes bounds, too.
  write_file({{"y", 4}, {"x", 5}, {"vertices", 3}});
  EXPECT_TRUE(contains(error_of_file(), "bounds of cells (axis vertices)"));
}

}  // namespace
}  // namespace pellucid::test_net_cdf_axes

#endif
