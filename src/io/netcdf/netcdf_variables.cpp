// SPDX-License-Identifier: Apache-2.0
#include "netcdf_variables.h"

#include <array>
#include <cmath>
#include <utility>

#include "pellucid/scene/error.h"
#include "text/text.h"

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

void read_attribute(int group, int id, const char* name, VariableAttributes& attributes) {
  nc_type type = NC_NAT;
  std::size_t count = 0;
  if (nc_inq_att(group, id, name, &type, &count) != NC_NOERR) return;
  VariableAttribute attribute;
  attribute.is_real = type == NC_FLOAT || type == NC_DOUBLE;
  attribute.is_text = type == NC_CHAR || type == NC_STRING;
  if (type == NC_CHAR) {
    if (count > longest_attribute_text) return;
    attribute.text.resize(count);
    if (nc_get_att_text(group, id, name, attribute.text.data()) != NC_NOERR) return;
  } else if (type == NC_STRING) {
    if (count == 0 || count > max_attribute_numbers) return;
    std::vector<char*> texts(count, nullptr);
    if (nc_get_att_string(group, id, name, texts.data()) != NC_NOERR) return;
    if (texts[0] != nullptr) attribute.text = texts[0];
    nc_free_string(count, texts.data());
  } else if (type < NC_STRING) {
    if (count > max_attribute_numbers) return;
    attribute.numbers.resize(count);
    if (count > 0 && nc_get_att_double(group, id, name, attribute.numbers.data()) != NC_NOERR) {
      return;
    }
  } else {
    return;
  }
  attributes[name] = std::move(attribute);
}

NetCdfVariable variable_of(int group, int id, const std::string& folder) {
  NetCdfVariable variable{group, id, "", NC_NAT, {}, {}, {}};
  std::array<char, NC_MAX_NAME + 1> name{};
  std::array<int, NC_MAX_VAR_DIMS> axes{};
  int count = 0, attributes = 0;
  check_net_cdf(
      nc_inq_var(group, id, name.data(), &variable.type, &count, axes.data(), &attributes),
      "a variable");
  variable.name = folder + name.data();
  for (int a = 0; a < count; ++a) {
    variable.axes.push_back(axes[static_cast<std::size_t>(a)]);
    std::size_t side = 0;
    check_net_cdf(nc_inq_dimlen(group, variable.axes.back(), &side), "an axis");
    variable.sides.push_back(static_cast<std::int64_t>(side));
  }
  for (int a = 0; a < attributes; ++a) {
    if (nc_inq_attname(group, id, a, name.data()) != NC_NOERR) continue;
    read_attribute(group, id, name.data(), variable.attributes);
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

/// Returns whether whole numbers, which the classic formats have with a sign alone, have none.
bool has_unsigned(const NetCdfVariable& variable, const char* text) {
  return in_small_letters(text_of(variable.attributes, "_Unsigned")).starts_with(text);
}

/// Returns the number that the library writes into unwritten values of a type; bytes have none.
std::optional<double> fill_of_type(const NetCdfVariable& variable) {
  const bool is_unsigned = has_unsigned(variable, "true");
  switch (variable.type) {
    case NC_SHORT:
      return NC_FILL_SHORT + (is_unsigned ? 0x1p16 : 0);
    case NC_USHORT:
      return NC_FILL_USHORT;
    case NC_INT:
      return NC_FILL_INT + (is_unsigned ? 0x1p32 : 0);
    case NC_UINT:
      return NC_FILL_UINT;
    case NC_INT64:
      return static_cast<double>(NC_FILL_INT64);
    case NC_UINT64:
      return static_cast<double>(NC_FILL_UINT64);
    case NC_FLOAT:
    case NC_DOUBLE:
      return static_cast<double>(NC_FILL_FLOAT);
    default:
      return std::nullopt;
  }
}

/// Returns whether the library fills unwritten values with a number that the file does not state.
bool has_default_fill(const NetCdfVariable& variable) {
  int has_none = 0;
  const int status = nc_inq_var_fill(variable.group, variable.id, &has_none, nullptr);
  return !variable.attributes.contains("_FillValue") && !(status == NC_NOERR && has_none != 0);
}

}  // namespace

std::optional<std::uint8_t> unmarked_fill(const NetCdfVariable& variable) {
  const bool is_byte = variable.type == NC_BYTE || variable.type == NC_UBYTE;
  if (!is_byte || !has_default_fill(variable)) return std::nullopt;
  return static_cast<std::uint8_t>(variable.type == NC_BYTE ? NC_FILL_BYTE : NC_FILL_UBYTE);
}

std::vector<NetCdfVariable> net_cdf_variables(int group) {
  std::vector<NetCdfVariable> list;
  find_variables(group, "", list);
  return list;
}

std::optional<NetCdfVariable> net_cdf_variable(int group, const std::string& name) {
  int id = 0;
  while (nc_inq_varid(group, name.c_str(), &id) != NC_NOERR) {
    if (nc_inq_grp_parent(group, &group) != NC_NOERR) return std::nullopt;
  }
  return variable_of(group, id, "");
}

std::optional<std::string> stored_type(const NetCdfVariable& variable) {
  const std::string sign = has_unsigned(variable, "true") ? "u" : "i";
  const std::string no_sign = has_unsigned(variable, "false") ? "i" : "u";
  switch (variable.type) {
    case NC_BYTE:
      // xarray writes truth values as bytes that say so.
      return text_of(variable.attributes, "dtype") == "bool" ? "u8" : sign + "8";
    case NC_UBYTE:
      return no_sign + "8";
    case NC_SHORT:
      return sign + "16";
    case NC_USHORT:
      return no_sign + "16";
    case NC_INT:
      return sign + "32";
    case NC_UINT:
      return no_sign + "32";
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

ValueMeaning meaning_of(const NetCdfVariable& variable, std::vector<std::string>& notes) {
  ValueMeaning meaning =
      value_meaning(variable.attributes, *stored_type(variable), variable.name, notes);
  if (has_default_fill(variable)) meaning.default_fill = fill_of_type(variable);
  return meaning;
}

std::string net_cdf_axis(const NetCdfVariable& variable, std::size_t axis) {
  std::array<char, NC_MAX_NAME + 1> name{};
  check_net_cdf(nc_inq_dimname(variable.group, variable.axes[axis], name.data()), "an axis");
  return name.data();
}

namespace {

/// Reads numbers as doubles, unsigned ones as they are meant.
std::vector<double> read_line(const NetCdfVariable& line) {
  std::vector<double> numbers(static_cast<std::size_t>(line.sides[0]));
  check_net_cdf(nc_get_var_double(line.group, line.id, numbers.data()),
                "the positions along " + line.name);
  const std::string type = *stored_type(line);
  const double span = std::exp2(type.ends_with("8") ? 8 : type.ends_with("16") ? 16 : 32);
  for (double& number : numbers) {
    if (type[0] == 'u' && number < 0) number += span;
    if (type[0] == 'i' && number >= span / 2) number -= span;
  }
  return numbers;
}

/// Returns a variable that the attribute `coordinates` names and that has this axis alone.
std::optional<NetCdfVariable> auxiliary_coordinate(const NetCdfVariable& variable,
                                                   std::size_t axis) {
  for (const std::string& name : words_of(variable.attributes, "coordinates")) {
    auto found = net_cdf_variable(variable.group, name);
    if (found && found->axes == std::vector{variable.axes[axis]} && stored_type(*found)) {
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<NetCdfAxis> net_cdf_axes(const NetCdfVariable& variable) {
  std::vector<NetCdfAxis> axes(variable.axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a) {
    axes[a].text.name = net_cdf_axis(variable, a);
    axes[a].coordinate = net_cdf_variable(variable.group, axes[a].text.name);
    const auto& found = axes[a].coordinate;
    if (found && found->sides.size() == 1) axes[a].text.coordinate = found->attributes;
    // One of several axes gives no positions, and a text no numbers.
    if (found && found->sides.size() == 1 && stored_type(*found)) continue;
    axes[a].coordinate = auxiliary_coordinate(variable, a);
    if (!axes[a].coordinate) continue;
    axes[a].text.coordinate = axes[a].coordinate->attributes;
    axes[a].text.coordinate_name = axes[a].coordinate->name;
  }
  return axes;
}

AxisPositions positions_of(const NetCdfAxis& axis, std::int64_t side) {
  AxisPositions positions = positions_along(axis.text);
  if (!axis.coordinate || axis.coordinate->sides != std::vector{side}) return positions;
  const NetCdfVariable& found = *axis.coordinate;
  positions.numbers = read_line(found);
  positions.rounding = found.type == NC_FLOAT ? 0x1p-24 : 0x1p-53;
  std::vector<std::string> notes;
  apply_meaning(positions.numbers, *stored_type(found), meaning_of(found, notes));
  return positions;
}

}  // namespace pellucid
