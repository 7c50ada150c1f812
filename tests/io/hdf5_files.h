// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <optional>
#include <string>
#include <vector>

#include "volume_files.h"

// Files that HDF5 itself writes, with attributes, labels and scales of the axes.
namespace pellucid::test {

/// A file of HDF5, open for writing while this lives.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
  ~Hdf5Writer() { H5Fclose(file_); }
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// The storage of a dataset.
  struct Storage {
    std::vector<hsize_t> chunk = {};
    std::optional<double> fill = {};
    std::vector<hsize_t> written = {};  ///< sides of the part that is written; empty: all
  };

  /// Writes values, doubles, as this type.
  void add(const std::string& name, hid_t type, const std::vector<hsize_t>& sides,
           const std::vector<double>& values, const Storage& storage) const {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (!storage.chunk.empty()) {
      H5Pset_chunk(how, static_cast<int>(sides.size()), storage.chunk.data());
    }
    if (storage.fill) H5Pset_fill_value(how, H5T_NATIVE_DOUBLE, &*storage.fill);
    const hid_t space = H5Screate_simple(static_cast<int>(sides.size()), sides.data(), nullptr);
    const hid_t set = H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    EXPECT_GE(set, 0) << name;
    if (!values.empty()) {
      const std::vector<hsize_t> count = storage.written.empty() ? sides : storage.written;
      const std::vector<hsize_t> start(sides.size(), 0);
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
      const hid_t memory = H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr);
      EXPECT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()), 0);
      H5Sclose(memory);
    }
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(how);
  }
  void add(const std::string& name, hid_t type, const std::vector<hsize_t>& sides,
           const std::vector<double>& values) const {
    add(name, type, sides, values, Storage{});
  }

  void add_group(const std::string& name) const {
    H5Gclose(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  }
  /// Links to a dataset of another file.
  void link(const std::string& name, const std::string& file, const std::string& object) const {
    H5Lcreate_external(file.c_str(), object.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }

  /// Writes an attribute of a dataset or a group.
  void attach(const std::string& set, const std::string& name,
              const std::vector<double>& numbers) const {
    const hsize_t count = numbers.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    attach(set, name, H5T_NATIVE_DOUBLE, space, numbers.data());
  }
  /// Writes a text of a fixed length, or of any as h5py does.
  void attach_text(const std::string& set, const std::string& name, const std::string& text,
                   bool is_fixed = true) const {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, is_fixed ? text.size() + 1 : H5T_VARIABLE);
    const char* const pointer = text.c_str();
    attach(set, name, type, H5Screate(H5S_SCALAR),
           is_fixed ? static_cast<const void*>(pointer) : static_cast<const void*>(&pointer));
    H5Tclose(type);
  }
  void attach_labels(const std::string& set, const std::vector<std::string>& labels) const {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    std::vector<const char*> pointers;
    for (const std::string& label : labels) pointers.push_back(label.c_str());
    const hsize_t count = labels.size();
    attach(set, "DIMENSION_LABELS", type, H5Screate_simple(1, &count, nullptr), pointers.data());
    H5Tclose(type);
  }
  /// Refers each axis of a dataset to a dataset of its positions; "": none.
  void attach_scales(const std::string& set, const std::vector<std::string>& scales) const {
    std::vector<hobj_ref_t> references(scales.size());
    std::vector<hvl_t> lists(scales.size());
    for (std::size_t a = 0; a < scales.size(); ++a) {
      lists[a] = {0, nullptr};
      if (scales[a].empty()) continue;
      EXPECT_GE(H5Rcreate(&references[a], file_, scales[a].c_str(), H5R_OBJECT, -1), 0);
      lists[a] = {1, &references[a]};
    }
    const hid_t type = H5Tvlen_create(H5T_STD_REF_OBJ);
    const hsize_t count = scales.size();
    attach(set, "DIMENSION_LIST", type, H5Screate_simple(1, &count, nullptr), lists.data());
    H5Tclose(type);
  }

 private:
  /// Closes the space.
  void attach(const std::string& set, const std::string& name, hid_t type, hid_t space,
              const void* values) const {
    const hid_t id = H5Oopen(file_, set.c_str(), H5P_DEFAULT);
    const hid_t attribute = H5Acreate2(id, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Awrite(attribute, type, values), 0) << name;
    H5Aclose(attribute);
    H5Sclose(space);
    H5Oclose(id);
  }

  hid_t file_;
};

}  // namespace pellucid::test
