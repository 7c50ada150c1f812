// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "pellucid/scene/error.h"

// What the readers of HDF5's module share.

namespace pellucid {

/// Closed by the function that belongs to its kind.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close) {
    if (id < 0) throw Error(std::string("HDF5 cannot read ") + what + "; the file is damaged");
  }
  ~Id() { close_(id_); }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  hid_t get() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

inline hid_t open_file(const std::filesystem::path& path) {
  // What it would print stands in our own words in exceptions.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  if (H5Fis_hdf5(path.c_str()) <= 0) throw Error("is no HDF5 file, or damaged");
  return H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
}

/// Returns whether a type is what h5py writes for truth values: FALSE and TRUE in a byte.
inline bool is_truth(hid_t type) {
  constexpr std::array names{"FALSE", "TRUE"};
  if (H5Tget_size(type) != 1 || H5Tget_nmembers(type) != 2) return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    signed char value = 0;
    if (H5Tenum_valueof(type, names[i], &value) < 0 || value != static_cast<int>(i)) return false;
  }
  return true;
}

/// Returns the type of the values, "i64" and "u64" among them; nothing where they are no plain
/// numbers.
inline std::optional<std::string> type_of(hid_t type) {
  const std::size_t bytes = H5Tget_size(type);
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return bytes <= 4 ? "f32" : "f64";
    case H5T_ENUM: {
      const Id base(H5Tget_super(type), H5Tclose, "a type");
      return is_truth(type) ? "u8" : type_of(base.get());
    }
    case H5T_INTEGER: {
      if (bytes > 8) return "f64";
      const std::string sign = H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "i";
      return sign + (bytes == 1 ? "8" : bytes == 2 ? "16" : bytes <= 4 ? "32" : "64");
    }
    default:
      return std::nullopt;
  }
}

inline hid_t memory_type(const std::string& type) {
  if (type == "u8") return H5T_NATIVE_UINT8;
  if (type == "i8") return H5T_NATIVE_INT8;
  if (type == "u16") return H5T_NATIVE_UINT16;
  if (type == "i16") return H5T_NATIVE_INT16;
  if (type == "u32") return H5T_NATIVE_UINT32;
  if (type == "i32") return H5T_NATIVE_INT32;
  if (type == "u64") return H5T_NATIVE_UINT64;
  if (type == "i64") return H5T_NATIVE_INT64;
  return type == "f32" ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
}

/// Throws Error for values that lie in other files, which a file from elsewhere could name at will,
/// and for types that are no numbers though they look like some.
inline void check_kind(hid_t dataset, hid_t type) {
  const Id how(H5Dget_create_plist(dataset), H5Pclose, "the layout of a dataset");
  if (H5Pget_layout(how.get()) == H5D_VIRTUAL) {
    throw Error("a virtual dataset, whose values lie in others; save it as one of its own");
  }
  if (H5Pget_external_count(how.get()) > 0) {
    throw Error(
        "a dataset of external storage, whose values lie in other files; save it as one of "
        "its own");
  }
  if (H5Tget_class(type) == H5T_BITFIELD) {
    throw Error("a dataset of bit fields, which are no numbers; save it as integers");
  }
}

/// Returns the error of values that HDF5 could not read. It names the first filter that they need
/// and HDF5 has not.
inline Error unreadable_values(hid_t dataset, const std::string& name) {
  const std::string what = "HDF5 cannot read the values of \"" + name + "\"; ";
  const Id how(H5Dget_create_plist(dataset), H5Pclose, "the layout of a dataset");
  const int filters = H5Pget_nfilters(how.get());
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t parameters = 0;
    std::array<char, 80> text{};
    const H5Z_filter_t filter =
        H5Pget_filter2(how.get(), static_cast<unsigned>(i), &flags, &parameters, nullptr,
                       text.size() - 1, text.data(), nullptr);
    if (filter < 0 || H5Zfilter_avail(filter) > 0) continue;
    std::string title = "filter " + std::to_string(filter);
    if (text[0] != '\0') title += " (" + std::string(text.data()) + ")";
    return Error(what + "they need " + title +
                 ", which HDF5 lacks here; name the folder of its plug-in in HDF5_PLUGIN_PATH, or "
                 "save them with gzip");
  }
  return Error(what + "the file is cut off or damaged");
}

}  // namespace pellucid
