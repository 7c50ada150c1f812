// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netcdf.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Throws Error with what NetCDF says of `what`, where it is not well.
void check_net_cdf(int status, const std::string& what);

/// A file of NetCDF's, open while this lives.
class NetCdfFile {
 public:
  explicit NetCdfFile(const std::filesystem::path& path);
  ~NetCdfFile() { nc_close(id_); }
  NetCdfFile(const NetCdfFile&) = delete;
  NetCdfFile& operator=(const NetCdfFile&) = delete;
  int id() const { return id_; }

 private:
  int id_ = 0;
};

struct NetCdfVariable {
  int group = 0, id = 0;
  std::string name;  ///< with its groups in front
  nc_type type = NC_NAT;
  std::vector<int> axes;
  std::vector<std::size_t> sides;
};

/// Those of the group and of the groups in it, whose names stand in front.
std::vector<NetCdfVariable> net_cdf_variables(int group);

std::string net_cdf_axis(const NetCdfVariable& variable, std::size_t axis);

/// Whether it counts time, as the CF conventions mark it: units "days since 1990-1-1", axis "T".
bool is_time_axis(const NetCdfVariable& variable, std::size_t axis);

/// The type that the values have in memory, whole numbers of 64 bits double; nothing where they are
/// no numbers.
std::optional<std::string> stored_type(const NetCdfVariable& variable);

/// value = scale · stored + offset; what is missing is NaN.
struct NetCdfMeaning {
  double scale = 1, offset = 0;
  std::vector<double> missing;

  bool is_plain() const { return scale == 1 && offset == 0; }
};
/// Throws Error where a scale or an offset stands there and is no finite number.
NetCdfMeaning meaning_of(const NetCdfVariable& variable);

/// The numbers of the variable that is named like the axis, here or in a group around; none where
/// there is no such one.
struct NetCdfPositions {
  std::vector<double> numbers;
  double rounding = 0;  ///< the largest relative error that their type leaves them
};
NetCdfPositions positions_of(const NetCdfVariable& variable, std::size_t axis);

}  // namespace pellucid
