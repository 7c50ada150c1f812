// SPDX-License-Identifier: Apache-2.0
#include "netcdf_variables.h"

#include <array>
#include <cmath>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid {

void check_net_cdf(int status, const std::string& what) {
  if (status == NC_NOERR) return;
  if (status == NC_ENOFILTER) {
    throw Error("NetCDF cannot read " + what +
                ", which needs a filter that HDF5 lacks here; name the folder of its plug-in in "
                "HDF5_PLUGIN_PATH, or save it with deflate");
  }
  throw Error("NetCDF cannot read " + what + " (" + nc_strerror(status) +
              "); the file is cut off or damaged");
}

NetCdfFile::NetCdfFile(const std::filesystem::path& path) {
  check_net_cdf(nc_open(path.c_str(), NC_NOWRITE, &id_), "the file");
}

namespace {

NetCdfVariable variable_of(int group, int id, const std::string& folder) {
  NetCdfVariable variable{group, id, "", NC_NAT, {}, {}};
  std::array<char, NC_MAX_NAME + 1> name{};
  std::array<int, NC_MAX_VAR_DIMS> axes{};
  int count = 0;
  check_net_cdf(nc_inq_var(group, id, name.data(), &variable.type, &count, axes.data(), nullptr),
                "a variable");
  variable.name = folder + name.data();
  for (int a = 0; a < count; ++a) {
    variable.axes.push_back(axes[static_cast<std::size_t>(a)]);
    variable.sides.push_back(0);
    check_net_cdf(nc_inq_dimlen(group, variable.axes.back(), &variable.sides.back()), "an axis");
  }
  return variable;
}

void find_variables(int group, const std::string& folder, std::vector<NetCdfVariable>& list) {
  int count = 0;
  check_net_cdf(nc_inq_nvars(group, &count), "its list of variables");
  for (int id = 0; id < count; ++id) list.push_back(variable_of(group, id, folder));
  check_net_cdf(nc_inq_grps(group, &count, nullptr), "its groups");
  std::vector<int> groups(static_cast<std::size_t>(count));
  if (count > 0) check_net_cdf(nc_inq_grps(group, &count, groups.data()), "its groups");
  for (const int inner : groups) {
    std::array<char, NC_MAX_NAME + 1> name{};
    check_net_cdf(nc_inq_grpname(inner, name.data()), "a group");
    find_variables(inner, folder + name.data() + "/", list);
  }
}

/// The attribute's numbers; none where it is missing, or text.
std::vector<double> numbers_of(const NetCdfVariable& variable, const char* attribute) {
  nc_type type = NC_NAT;
  std::size_t count = 0;
  constexpr std::size_t most = 1024;
  if (nc_inq_att(variable.group, variable.id, attribute, &type, &count) != NC_NOERR ||
      type == NC_CHAR || type >= NC_STRING || count > most) {
    return {};
  }
  std::vector<double> numbers(count);
  if (count > 0 &&
      nc_get_att_double(variable.group, variable.id, attribute, numbers.data()) != NC_NOERR) {
    return {};
  }
  return numbers;
}

/// Whether its whole numbers, which the classic formats have with a sign alone, are meant without.
bool is_unsigned(const NetCdfVariable& variable) {
  std::size_t length = 0;
  if (nc_inq_attlen(variable.group, variable.id, "_Unsigned", &length) != NC_NOERR || length > 8) {
    return false;
  }
  std::string text(length, '\0');
  return nc_get_att_text(variable.group, variable.id, "_Unsigned", text.data()) == NC_NOERR &&
         text.starts_with("true");
}

/// As they are meant: an unsigned one of a byte may be written as -1, and is 255.
std::vector<double> missing_of(const NetCdfVariable& variable, const char* attribute) {
  std::vector<double> numbers = numbers_of(variable, attribute);
  const double bits = variable.type == NC_BYTE ? 8 : variable.type == NC_SHORT ? 16 : 32;
  for (double& number : numbers) {
    if (number < 0 && is_unsigned(variable)) number += std::exp2(bits);
  }
  return numbers;
}

}  // namespace

std::vector<NetCdfVariable> net_cdf_variables(int group) {
  std::vector<NetCdfVariable> list;
  find_variables(group, "", list);
  return list;
}

std::optional<std::string> stored_type(const NetCdfVariable& variable) {
  const std::string sign = is_unsigned(variable) ? "u" : "i";
  switch (variable.type) {
    case NC_BYTE:
      return sign + "8";
    case NC_UBYTE:
      return "u8";
    case NC_SHORT:
      return sign + "16";
    case NC_USHORT:
      return "u16";
    case NC_INT:
      return sign + "32";
    case NC_UINT:
      return "u32";
    case NC_FLOAT:
      return "f32";
    case NC_INT64:
    case NC_UINT64:
    case NC_DOUBLE:
      return "f64";
    default:
      return std::nullopt;
  }
}

NetCdfMeaning meaning_of(const NetCdfVariable& variable) {
  NetCdfMeaning meaning;
  const auto first = [&](const char* attribute, double& number) {
    int id = 0;
    if (nc_inq_attid(variable.group, variable.id, attribute, &id) != NC_NOERR) return;
    const std::vector<double> numbers = numbers_of(variable, attribute);
    if (numbers.empty() || !std::isfinite(numbers[0])) {
      throw Error("the " + std::string(attribute) + " of \"" + variable.name +
                  "\" is no finite number; mend the attribute");
    }
    number = numbers[0];
  };
  first("scale_factor", meaning.scale);
  first("add_offset", meaning.offset);
  meaning.missing = missing_of(variable, "_FillValue");
  // What is never written has this value in files that name no other.
  if (meaning.missing.empty() && (variable.type == NC_FLOAT || variable.type == NC_DOUBLE)) {
    meaning.missing.push_back(static_cast<double>(NC_FILL_FLOAT));
  }
  for (const double number : missing_of(variable, "missing_value")) {
    meaning.missing.push_back(number);
  }
  return meaning;
}

std::string net_cdf_axis(const NetCdfVariable& variable, std::size_t axis) {
  std::array<char, NC_MAX_NAME + 1> name{};
  check_net_cdf(nc_inq_dimname(variable.group, variable.axes[axis], name.data()), "an axis");
  return name.data();
}

namespace {

/// The variable that is named like the axis, here or in a group around.
std::optional<NetCdfVariable> coordinate_of(const NetCdfVariable& variable, std::size_t axis) {
  const std::string name = net_cdf_axis(variable, axis);
  int group = variable.group, id = 0;
  while (nc_inq_varid(group, name.c_str(), &id) != NC_NOERR) {
    if (nc_inq_grp_parent(group, &group) != NC_NOERR) return std::nullopt;
  }
  return variable_of(group, id, "");
}

/// An attribute of text; empty where there is none.
std::string text_of(const NetCdfVariable& variable, const char* attribute) {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  constexpr std::size_t most = 1024;
  if (nc_inq_att(variable.group, variable.id, attribute, &type, &length) != NC_NOERR ||
      type != NC_CHAR || length > most) {
    return {};
  }
  std::string text(length, '\0');
  const int status = nc_get_att_text(variable.group, variable.id, attribute, text.data());
  return status == NC_NOERR ? text : std::string();
}

}  // namespace

bool is_time_axis(const NetCdfVariable& variable, std::size_t axis) {
  const auto coordinate = coordinate_of(variable, axis);
  return coordinate && (text_of(*coordinate, "units").find(" since ") != std::string::npos ||
                        text_of(*coordinate, "axis").starts_with('T'));
}

NetCdfPositions positions_of(const NetCdfVariable& variable, std::size_t axis) {
  const auto coordinate = coordinate_of(variable, axis);
  if (!coordinate) return {};
  const NetCdfVariable& found = *coordinate;
  if (found.sides != std::vector{variable.sides[axis]} || !stored_type(found)) return {};
  NetCdfPositions positions{std::vector<double>(variable.sides[axis]), 0x1p-53};
  check_net_cdf(nc_get_var_double(found.group, found.id, positions.numbers.data()),
                "the positions along " + found.name);
  if (found.type == NC_FLOAT) positions.rounding = 0x1p-24;
  const NetCdfMeaning meaning = meaning_of(found);
  for (double& number : positions.numbers) number = meaning.scale * number + meaning.offset;
  return positions;
}

}  // namespace pellucid
