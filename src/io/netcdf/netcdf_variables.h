// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netcdf.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "axes/axis_meaning.h"
#include "axes/value_meaning.h"
#include "axes/variable_attributes.h"

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
  std::vector<std::int64_t> sides;
  VariableAttributes attributes;
};

/// Returns the variables of the group and of the groups in it, whose names stand in front.
std::vector<NetCdfVariable> net_cdf_variables(int group);

/// Returns the variable of this name, here or in a group around.
std::optional<NetCdfVariable> net_cdf_variable(int group, const std::string& name);

std::string net_cdf_axis(const NetCdfVariable& variable, std::size_t axis);

/// Returns the type that the values have in memory, whole numbers of 64 bits double; nothing where
/// they are no numbers.
std::optional<std::string> stored_type(const NetCdfVariable& variable);

/// Returns the byte that the library writes where nothing is written, which may as well be a value;
/// nothing for other types, or where the variable states a fill or has none.
std::optional<std::uint8_t> unmarked_fill(const NetCdfVariable& variable);

/// Returns the attributes' meaning of values, and the library's default fill. `notes` is told what
/// is not applied. Throws Error where a scale or an offset stands there and is no finite number.
ValueMeaning meaning_of(const NetCdfVariable& variable, std::vector<std::string>& notes);

/// An axis of a variable with its coordinate: the variable that is named like the axis, or else one
/// that the attribute `coordinates` names and that has this axis alone.
struct NetCdfAxis {
  AxisText text;
  std::optional<NetCdfVariable> coordinate;
};
std::vector<NetCdfAxis> net_cdf_axes(const NetCdfVariable& variable);

/// Returns the positions along an axis of so many values; missing ones are NaN.
AxisPositions positions_of(const NetCdfAxis& axis, std::int64_t side);

}  // namespace pellucid
