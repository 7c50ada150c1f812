// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <optional>
#include <string>
#include <vector>

#include "tests/io/volume_files.h"

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
      if (!sides.empty()) {
        H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
      }
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
  /// Writes a text letter by letter, as Imaris does.
  void attach_letters(const std::string& set, const std::string& name,
                      const std::string& text) const {
    const hid_t type = H5Tcopy(H5T_C_S1);
    const hsize_t count = text.size();
    attach(set, name, type, H5Screate_simple(1, &count, nullptr), text.data());
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

/// A file as Imaris writes it: two channels at two times, of chunks that are larger than the image.
struct ImarisFile {
  std::string extent_max = "20.000";
  std::string size_x = "5";
  int times = 2;
  bool lacks_channel = false, has_plain_texts = false;

  void write(const std::filesystem::path& path) const {
    const Hdf5Writer file(path);
    const auto say = [&](const std::string& object, const std::string& key,
                         const std::string& text) {
      if (has_plain_texts) return file.attach_text(object, key, text);
      file.attach_letters(object, key, text);
    };
    say("/", "ImarisVersion", "5.5.0");
    say("/", "ImarisDataSet", "ImarisDataSet");
    for (const char* group : {"/DataSet", "/DataSetInfo", "/DataSetInfo/Image",
                              "/DataSetInfo/Channel 0", "/DataSetInfo/Channel 1", "/Thumbnail"}) {
      file.add_group(group);
    }
    say("/DataSetInfo/Image", "Unit", "um");
    for (int a = 0; a < 3; ++a) {
      say("/DataSetInfo/Image", "ExtMin" + std::to_string(a), "10.000");
      say("/DataSetInfo/Image", "ExtMax" + std::to_string(a), extent_max);
    }
    say("/DataSetInfo/Channel 0", "Name", "DAPI");
    say("/DataSetInfo/Channel 1", "Name", "GFP");
    file.add("/Thumbnail/Data", H5T_STD_U8LE, {4, 4, 4}, std::vector<double>(64, 9));
    for (int level = 0; level < 2; ++level) {
      const std::string resolution = "/DataSet/ResolutionLevel " + std::to_string(level);
      file.add_group(resolution);
      for (int t = 0; t < times; ++t) {
        const std::string time = resolution + "/TimePoint " + std::to_string(t);
        file.add_group(time);
        for (int c = 0; c < 2; ++c) {
          if (lacks_channel && t == 1 && c == 1) continue;
          const std::string channel = time + "/Channel " + std::to_string(c);
          file.add_group(channel);
          say(channel, "ImageSizeX", level == 0 ? size_x : "2");
          say(channel, "ImageSizeY", level == 0 ? "4" : "2");
          say(channel, "ImageSizeZ", level == 0 ? "3" : "2");
          std::vector<double> values;
          for (int z = 0; z < 4; ++z) {
            for (int y = 0; y < 8; ++y) {
              for (int x = 0; x < 8; ++x) {
                const bool is_inside = x < 5 && y < 4 && z < 3;
                values.push_back(is_inside ? x + 5 * y + 20 * z + 100 * c + 50 * t : 0);
              }
            }
          }
          file.add(channel + "/Data", H5T_STD_U16LE, {4, 8, 8}, values, {{4, 8, 8}, {}, {}});
        }
      }
    }
  }
};
}  // namespace pellucid::test
