// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

namespace pellucid::test {

/// Writes a VTKHDF file with HDF5 itself.
class VtkHdfWriter {
 public:
  enum class Text { fixed, variable, padded };

  explicit VtkHdfWriter(const std::filesystem::path& path, const std::string& type,
                        Text text = Text::fixed, bool latest = false) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (latest) H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    root_ = H5Gcreate2(file_, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (!type.empty()) this->text(root_, "Type", type, text);
  }
  ~VtkHdfWriter() { close(); }
  VtkHdfWriter(const VtkHdfWriter&) = delete;
  VtkHdfWriter& operator=(const VtkHdfWriter&) = delete;

  void close() {
    if (file_ < 0) return;
    H5Gclose(root_);
    H5Fclose(file_);
    file_ = -1;
  }

  template <class Value>
  void attribute(const std::string& name, const std::vector<Value>& values,
                 const std::string& group = "") {
    const hid_t at = open(group);
    const hsize_t count = values.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t attribute =
        H5Acreate2(at, name.c_str(), type<Value>(), space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type<Value>(), values.data());
    H5Aclose(attribute);
    H5Sclose(space);
    H5Gclose(at);
  }
  /// Marks an array of a group: "PointData", "Scalars", its name.
  void mark(const std::string& group, const std::string& what, const std::string& name) {
    const hid_t at = open(group);
    text(at, what, name, Text::fixed);
    H5Gclose(at);
  }

  /// `group`: "", "PointData", "CellData" …; compressed where asked.
  template <class Value>
  void array(const std::string& group, const std::string& name, const std::vector<hsize_t>& sides,
             const std::vector<Value>& values, bool packed = false) {
    const hid_t at = open(group);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (packed) {
      H5Pset_chunk(how, static_cast<int>(sides.size()), sides.data());
      H5Pset_deflate(how, 6);
    }
    const hid_t space = H5Screate_simple(static_cast<int>(sides.size()), sides.data(), nullptr);
    const hid_t set =
        H5Dcreate2(at, name.c_str(), type<Value>(), space, H5P_DEFAULT, how, H5P_DEFAULT);
    if (!values.empty()) {
      H5Dwrite(set, type<Value>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(how);
    H5Gclose(at);
  }
  void group(const std::string& name) { H5Gclose(open(name)); }

 private:
  template <class Value>
  static hid_t type() {
    if constexpr (std::is_same_v<Value, double>) return H5T_NATIVE_DOUBLE;
    if constexpr (std::is_same_v<Value, float>) return H5T_NATIVE_FLOAT;
    if constexpr (std::is_same_v<Value, std::int64_t>) return H5T_NATIVE_INT64;
    if constexpr (std::is_same_v<Value, std::int32_t>) return H5T_NATIVE_INT32;
    if constexpr (std::is_same_v<Value, std::int16_t>) return H5T_NATIVE_INT16;
    if constexpr (std::is_same_v<Value, std::uint8_t>) return H5T_NATIVE_UINT8;
  }
  hid_t open(const std::string& name) {
    if (name.empty()) return H5Gopen2(root_, ".", H5P_DEFAULT);
    if (H5Lexists(root_, name.c_str(), H5P_DEFAULT) > 0) {
      return H5Gopen2(root_, name.c_str(), H5P_DEFAULT);
    }
    return H5Gcreate2(root_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  }
  static void text(hid_t at, const std::string& name, const std::string& value, Text kind) {
    const hid_t string = H5Tcopy(H5T_C_S1);
    std::string bytes = value;
    if (kind == Text::variable) {
      H5Tset_size(string, H5T_VARIABLE);
      H5Tset_cset(string, H5T_CSET_UTF8);
    } else {
      if (kind == Text::padded) bytes.resize(value.size() + 5, ' ');
      H5Tset_size(string, bytes.size());
      H5Tset_strpad(string, kind == Text::padded ? H5T_STR_SPACEPAD : H5T_STR_NULLPAD);
    }
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(at, name.c_str(), string, space, H5P_DEFAULT, H5P_DEFAULT);
    const char* const pointer = bytes.c_str();
    H5Awrite(attribute, string,
             kind == Text::variable ? static_cast<const void*>(&pointer)
                                    : static_cast<const void*>(pointer));
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(string);
  }

  hid_t file_ = -1, root_ = -1;
};

}  // namespace pellucid::test
