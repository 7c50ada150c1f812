// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef PELLUCID_HAVE_NETCDF
#include <netcdf.h>
#endif

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pellucid::test {

/// Whether this build reads Exodus II, and can write it.
#if defined(PELLUCID_HAVE_VTK) && defined(PELLUCID_HAVE_NETCDF)
inline constexpr bool has_exodus = true;
#else
inline constexpr bool has_exodus = false;
#endif

/// A unit cube of one hexahedron in Exodus II, by NetCDF and the document of its names.
struct SmallExodus {
  /// Whether readers are told to expect values of nodes in arrays of their own, as they are here.
  bool has_file_size = true;
  bool has_axes = true;  ///< places of nodes in three arrays; else in one
  std::vector<std::string> nodal{"T"};
  std::vector<std::string> of_elements{};
  int steps = 1;
  int written_steps = 1;             ///< those behind are left as NetCDF fills them
  std::vector<double> step_times{};  ///< times of the steps; empty: 0, 0.5, 1 and so on
  bool has_last_time = true;
  bool in_floats = false;
  int last_corner = 8;  ///< of the hexahedron's nodes 1 to 8, the last one

  /// Variable v of step s at node n is 100 s + 10 v + n; that of the element is 1000 + v.
  void write([[maybe_unused]] const std::filesystem::path& path) const {
#ifdef PELLUCID_HAVE_NETCDF
    int file = 0;
    nc_create(path.c_str(), NC_CLOBBER | NC_64BIT_OFFSET, &file);
    const auto dimension = [&](const std::string& name, std::size_t length) {
      int id = 0;
      nc_def_dim(file, name.c_str(), length, &id);
      return id;
    };
    const int string = dimension("len_string", 33), time = dimension("time_step", NC_UNLIMITED);
    const int nodes = dimension("num_nodes", 8), blocks = dimension("num_el_blk", 1);
    const int in_block = dimension("num_el_in_blk1", 1), per = dimension("num_nod_per_el1", 8);
    const int sides = dimension("num_dim", 3);
    dimension("num_elem", 1);
    const float version = 5.1F;
    nc_put_att_float(file, NC_GLOBAL, "api_version", NC_FLOAT, 1, &version);
    nc_put_att_float(file, NC_GLOBAL, "version", NC_FLOAT, 1, &version);
    const int word = in_floats ? 4 : 8, large = 1;
    nc_put_att_int(file, NC_GLOBAL, "floating_point_word_size", NC_INT, 1, &word);
    if (has_file_size) nc_put_att_int(file, NC_GLOBAL, "file_size", NC_INT, 1, &large);
    nc_put_att_text(file, NC_GLOBAL, "title", 4, "cube");
    const auto variable = [&](const std::string& name, nc_type type, const std::vector<int>& of) {
      int id = 0;
      nc_def_var(file, name.c_str(), type, static_cast<int>(of.size()), of.data(), &id);
      return id;
    };
    const nc_type real = in_floats ? NC_FLOAT : NC_DOUBLE;
    const int times = variable("time_whole", real, {time});
    const int status = variable("eb_status", NC_INT, {blocks});
    const int ids = variable("eb_prop1", NC_INT, {blocks});
    nc_put_att_text(file, ids, "name", 2, "ID");
    std::vector<int> axes;
    if (has_axes) {
      for (const char* axis : {"coordx", "coordy", "coordz"}) {
        axes.push_back(variable(axis, real, {nodes}));
      }
    } else {
      axes.push_back(variable("coord", real, {sides, nodes}));
    }
    const int connect = variable("connect1", NC_INT, {in_block, per});
    nc_put_att_text(file, connect, "elem_type", 3, "HEX");
    std::vector<int> names, values;
    const auto results = [&](const std::vector<std::string>& list, const std::string& kind,
                             int places) {
      if (list.empty()) return;
      const int number = dimension("num_" + kind + "_var", list.size());
      names.push_back(variable("name_" + kind + "_var", NC_CHAR, {number, string}));
      for (std::size_t v = 1; v <= list.size(); ++v) {
        values.push_back(
            variable("vals_" + kind + "_var" + std::to_string(v) + (kind == "elem" ? "eb1" : ""),
                     real, {time, places}));
      }
    };
    results(nodal, "nod", nodes);
    results(of_elements, "elem", in_block);
    nc_enddef(file);

    const int one = 1;
    nc_put_var_int(file, status, &one);
    nc_put_var_int(file, ids, &one);
    std::array corners{1, 2, 3, 4, 5, 6, 7, 8};
    corners.back() = last_corner;
    nc_put_var_int(file, connect, corners.data());
    const std::array<std::array<double, 8>, 3> places{
        {{0, 1, 1, 0, 0, 1, 1, 0}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}}};
    for (std::size_t a = 0; a < axes.size(); ++a) {
      nc_put_var_double(file, axes[a], places[a].data());
    }
    std::size_t list = 0;
    for (const auto* of : {&nodal, &of_elements}) {
      if (of->empty()) continue;
      for (std::size_t v = 0; v < of->size(); ++v) {
        const std::array<std::size_t, 2> at{v, 0}, count{1, (*of)[v].size()};
        nc_put_vara_text(file, names[list], at.data(), count.data(), (*of)[v].c_str());
      }
      ++list;
    }
    for (std::size_t s = 0; s < static_cast<std::size_t>(steps); ++s) {
      const double seconds = step_times.empty() ? 0.5 * static_cast<double>(s) : step_times[s];
      const bool is_last = s + 1 == static_cast<std::size_t>(steps);
      if (has_last_time || !is_last) nc_put_var1_double(file, times, &s, &seconds);
      for (std::size_t v = 0; v < values.size(); ++v) {
        const bool is_nodal = v < nodal.size();
        std::array<double, 8> numbers{};
        for (std::size_t n = 0; n < 8; ++n) {
          numbers[n] = is_nodal ? static_cast<double>(100 * s + 10 * v + n)
                                : 1000 + static_cast<double>(v - nodal.size());
        }
        const std::array<std::size_t, 2> at{s, 0}, count{1, is_nodal ? 8U : 1U};
        const std::array<std::size_t, 2> last{s, count[1] - 1};
        if (s < static_cast<std::size_t>(written_steps)) {
          nc_put_vara_double(file, values[v], at.data(), count.data(), numbers.data());
        } else if (!has_last_time && is_last) {
          // The record is there, as it is filled.
          const double fill = NC_FILL_DOUBLE;
          nc_put_var1_double(file, values[v], last.data(), &fill);
        }
      }
    }
    nc_close(file);
#endif
  }
};

}  // namespace pellucid::test
