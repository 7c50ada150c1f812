// SPDX-License-Identifier: Apache-2.0
//
// Part of HDF5's module: the group VTKHDF of a file, as Kitware lays it out
// (https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html#vtkhdf-file-format).
#include <algorithm>
#include <utility>

#include "hdf5_parts.h"
#include "process/module_answer.h"
#include "volumes/stored_numbers.h"
#include "vtk_hdf.h"

namespace pellucid {

namespace {

constexpr const char* root = "/VTKHDF";

std::string group_of(VtkHdfArray::Place place) {
  return place == VtkHdfArray::Place::root    ? root
         : place == VtkHdfArray::Place::point ? std::string(root) + "/PointData"
                                              : std::string(root) + "/CellData";
}

/// Returns a text of fixed or of variable length; empty where there is none.
std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return "";
  const Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, name);
  const Id type(H5Aget_type(attribute.get()), H5Tclose, "the type of an attribute");
  const Id space(H5Aget_space(attribute.get()), H5Sclose, "the size of an attribute");
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1) {
    return "";
  }
  constexpr std::size_t longest = 4096;
  if (H5Tis_variable_str(type.get()) > 0) {
    const Id memory(H5Tcopy(H5T_C_S1), H5Tclose, "a type");
    H5Tset_size(memory.get(), H5T_VARIABLE);
    H5Tset_cset(memory.get(), H5Tget_cset(type.get()));
    char* text = nullptr;
    if (H5Aread(attribute.get(), memory.get(), &text) < 0 || text == nullptr) return "";
    std::string value(text, std::find(text, text + longest, '\0'));
    H5free_memory(text);
    return value;
  }
  const std::size_t size = H5Tget_size(type.get());
  if (size < 1 || size > longest) return "";
  std::string value(size, '\0');
  if (H5Aread(attribute.get(), type.get(), value.data()) < 0) return "";
  value.resize(std::min(value.find('\0'), size));
  while (!value.empty() && value.back() == ' ') value.pop_back();  // padded with spaces
  return value;
}

/// Returns the numbers of an attribute, few of them; none where it is not there or is something
/// else.
std::vector<double> number_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, name);
  const Id type(H5Aget_type(attribute.get()), H5Tclose, "the type of an attribute");
  const Id space(H5Aget_space(attribute.get()), H5Sclose, "the size of an attribute");
  const H5T_class_t kind = H5Tget_class(type.get());
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  constexpr hssize_t most = 16;
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || count < 1 || count > most) return {};
  std::vector<double> values(static_cast<std::size_t>(count));
  if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, values.data()) < 0) return {};
  return values;
}

VtkHdfArray describe(hid_t group, const std::string& name, VtkHdfArray::Place place) {
  VtkHdfArray array;
  array.place = place;
  array.name = name;
  const Id dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
  const Id space(H5Dget_space(dataset.get()), H5Sclose, "the axes of a dataset");
  const Id type(H5Dget_type(dataset.get()), H5Tclose, "the type of a dataset");
  const int rank = H5Sget_simple_extent_ndims(space.get());
  constexpr int max_axes = 5;
  std::optional<std::string> kept = type_of(type.get());
  if (kept && is_stored_only(*kept)) kept = "f64";
  if (!kept || rank < 1 || rank > max_axes) {
    array.fault = kept ? "an array of " + std::to_string(rank) + " axes" : "no array of numbers";
    return array;
  }
  std::vector<hsize_t> sides(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.get(), sides.data(), nullptr);
  for (const hsize_t side : sides) {
    constexpr hsize_t most = hsize_t{1} << 60;
    array.sides.push_back(static_cast<std::int64_t>(std::min(side, most)));
  }
  array.type = *kept;
  try {
    check_kind(dataset.get(), type.get());
  } catch (const Error& error) {
    array.fault = error.what();
  }
  return array;
}

herr_t take_name(hid_t, const char* name, const H5L_info_t* about, void* names) {
  // Links to other places could lead to other files.
  if (about->type == H5L_TYPE_HARD) static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}

void list_arrays(hid_t file, VtkHdfArray::Place place, VtkHdfContents& contents) {
  const std::string path = group_of(place);
  if (H5Lexists(file, path.c_str(), H5P_DEFAULT) <= 0) return;
  const Id group(H5Gopen2(file, path.c_str(), H5P_DEFAULT), H5Gclose, path.c_str());
  std::vector<std::string> names, left_out;
  if (H5Literate(group.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, take_name, &names) < 0) {
    throw Error("HDF5 cannot read its list of arrays; the file is damaged");
  }
  if (place != VtkHdfArray::Place::root) {
    (place == VtkHdfArray::Place::point ? contents.point_scalars : contents.cell_scalars) =
        text_attribute(group.get(), "Scalars");
    left_out = {text_attribute(group.get(), "GlobalIds"),
                text_attribute(group.get(), "PedigreeIds")};
  }
  for (const std::string& name : names) {
    H5O_info_t about;
    if (H5Oget_info_by_name(group.get(), name.c_str(), &about, H5P_DEFAULT) < 0) {
      throw Error("HDF5 cannot read its list of arrays; the file is damaged");
    }
    if (about.type != H5O_TYPE_DATASET) continue;
    if (std::ranges::find(left_out, name) != left_out.end()) continue;
    contents.arrays.push_back(describe(group.get(), name, place));
  }
}

/// Adds the lists of numbers in a group of Steps that have one number, or one first, for each step.
void list_steps(hid_t group, const std::string& before, VtkHdfContents& contents) {
  std::vector<std::string> names;
  if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, take_name, &names) < 0) {
    throw Error("HDF5 cannot read its list of steps; the file is damaged");
  }
  for (const std::string& name : names) {
    H5O_info_t about;
    if (H5Oget_info_by_name(group, name.c_str(), &about, H5P_DEFAULT) < 0) continue;
    if (about.type == H5O_TYPE_GROUP && before.empty()) {
      const Id inner(H5Gopen2(group, name.c_str(), H5P_DEFAULT), H5Gclose, name.c_str());
      list_steps(inner.get(), name + "/", contents);
    }
    if (about.type != H5O_TYPE_DATASET) continue;
    const VtkHdfArray array = describe(group, name, VtkHdfArray::Place::root);
    constexpr std::int64_t most = 1 << 20;
    if (!array.fault.empty() || array.sides.size() > 2 || array.sides[0] != contents.steps)
      continue;
    const std::int64_t columns = array.sides.size() == 2 ? array.sides[1] : 1;
    if (columns < 1 || columns > 16 || contents.steps > most) continue;
    std::vector<double> numbers(static_cast<std::size_t>(contents.steps * columns));
    const Id dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
    if (H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) <
        0) {
      throw unreadable_values(dataset.get(), name);
    }
    VtkHdfStepList list{before + name, {}};
    for (std::size_t i = 0; i < numbers.size(); i += static_cast<std::size_t>(columns)) {
      list.numbers.push_back(numbers[i]);
    }
    contents.step_lists.push_back(std::move(list));
  }
}

void list(const std::filesystem::path& path, VtkHdfContents& contents) {
  const Id file(open_file(path), H5Fclose, "the file");
  if (H5Lexists(file.get(), root, H5P_DEFAULT) <= 0) return;
  const Id group(H5Gopen2(file.get(), root, H5P_DEFAULT), H5Gclose, root);
  contents.type = text_attribute(group.get(), "Type");
  if (contents.type.empty()) {
    throw Error("its group VTKHDF does not say of which type the data are (attribute Type)");
  }
  const std::vector<double> version = number_attribute(group.get(), "Version");
  if (!version.empty()) contents.version = static_cast<std::int64_t>(version.front());
  contents.extent = number_attribute(group.get(), "WholeExtent");
  contents.origin = number_attribute(group.get(), "Origin");
  contents.spacing = number_attribute(group.get(), "Spacing");
  contents.direction = number_attribute(group.get(), "Direction");
  const std::string steps = std::string(root) + "/Steps";
  if (H5Lexists(file.get(), steps.c_str(), H5P_DEFAULT) > 0) {
    const Id of_steps(H5Oopen(file.get(), steps.c_str(), H5P_DEFAULT), H5Oclose, "the steps");
    const std::vector<double> count = number_attribute(of_steps.get(), "NSteps");
    contents.steps = count.empty() || !(count[0] <= 0x1p53)
                         ? 1
                         : std::max<std::int64_t>(1, static_cast<std::int64_t>(count[0]));
    list_steps(of_steps.get(), "", contents);
  }
  for (const auto place :
       {VtkHdfArray::Place::root, VtkHdfArray::Place::point, VtkHdfArray::Place::cell}) {
    list_arrays(file.get(), place, contents);
  }
}

void read_one(hid_t file, const VtkHdfWanted& wanted) {
  const std::string path = group_of(wanted.array.place);
  const Id group(H5Gopen2(file, path.c_str(), H5P_DEFAULT), H5Gclose, path.c_str());
  const std::string& name = wanted.array.name;
  const VtkHdfArray now = describe(group.get(), name, wanted.array.place);
  if (now.sides != wanted.array.sides || now.type != wanted.array.type || !now.fault.empty()) {
    throw Error("the file was changed while it was read");
  }
  const Id dataset(H5Dopen2(group.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
  const Id space(H5Dget_space(dataset.get()), H5Sclose, "the axes of a dataset");
  std::vector<hsize_t> start(now.sides.size(), 0), count(now.sides.begin(), now.sides.end());
  if (wanted.component) {
    start.back() = static_cast<hsize_t>(*wanted.component);
    count.back() = 1;
  }
  if (wanted.rows) {
    start.front() = static_cast<hsize_t>(wanted.rows->front());
    count.front() = static_cast<hsize_t>(wanted.rows->back());
  }
  if (wanted.box) {
    const std::size_t slowest = wanted.rows ? 3 : 2;
    for (std::size_t a = 0; a < 3; ++a) {
      start.at(slowest - a) = static_cast<hsize_t>(wanted.box->first[a]);
      count.at(slowest - a) = static_cast<hsize_t>(wanted.box->count[a]);
    }
  }
  hsize_t values = 1;
  for (const hsize_t side : count) values *= side;
  if (wanted.to.size() != values * H5Tget_size(memory_type(now.type))) {
    throw Error("the file was changed while it was read");
  }
  if (values == 0) return;
  const Id memory(H5Screate_simple(1, &values, nullptr), H5Sclose, "the axes of a dataset");
  const bool done = H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr,
                                        count.data(), nullptr) >= 0 &&
                    H5Dread(dataset.get(), memory_type(now.type), memory.get(), space.get(),
                            H5P_DEFAULT, wanted.to.data()) >= 0;
  if (!done) throw unreadable_values(dataset.get(), name);
}

}  // namespace

}  // namespace pellucid

extern "C" __attribute__((visibility("default"))) void pellucid_list_vtk_hdf_2(
    const std::filesystem::path& path, pellucid::VtkHdfContents& contents) {
  pellucid::answer(contents.error, "split the file", [&] { pellucid::list(path, contents); });
}

extern "C" __attribute__((visibility("default"))) void pellucid_read_vtk_hdf_3(
    const std::filesystem::path& path, std::span<const pellucid::VtkHdfWanted> wanted,
    std::string& error) {
  pellucid::answer(error, "split the file", [&] {
    const pellucid::Id file(pellucid::open_file(path), H5Fclose, "the file");
    for (const pellucid::VtkHdfWanted& one : wanted) pellucid::read_one(file.get(), one);
  });
}
