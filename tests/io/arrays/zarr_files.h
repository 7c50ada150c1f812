// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "tests/io/volume_files.h"

// Stores of Zarr written by its specification, by nothing that the library reads them with.
namespace pellucid::test {

using Encode = std::function<std::string(const std::string&)>;

/// The metadata of one array as text, and how its chunks become files.
struct ZarrStore {
  std::vector<int> shape{3, 4, 5}, chunk{2, 3, 2};
  std::string type = "<f4";                                        ///< of version 2
  std::string order = "C", compressor = "null", filters = "null";  ///< of version 2
  std::string fill = "0";
  std::string separator = ".";
  std::string more;  ///< members behind the others
  Encode encode = [](const std::string& bytes) { return bytes; };
  std::vector<std::string> left_out;  ///< keys of chunks that are not written

  static std::string list(const std::vector<int>& numbers) {
    std::string text;
    for (const int n : numbers) text += (text.empty() ? "" : ", ") + std::to_string(n);
    return "[" + text + "]";
  }

  std::string array_2() const {
    return "{\"zarr_format\": 2, \"shape\": " + list(shape) + ", \"chunks\": " + list(chunk) +
           ", \"dtype\": \"" + type + "\", \"order\": \"" + order +
           "\", \"compressor\": " + compressor + ", \"filters\": " + filters +
           ", \"fill_value\": " + fill + ", \"dimension_separator\": \"" + separator + "\"" + more +
           "}";
  }
  std::string array_3(const std::string& data_type, const std::string& codecs,
                      const std::string& keys) const {
    return "{\"zarr_format\": 3, \"node_type\": \"array\", \"shape\": " + list(shape) +
           ", \"data_type\": \"" + data_type +
           "\", \"chunk_grid\": {\"name\": \"regular\", \"configuration\": {\"chunk_shape\": " +
           list(chunk) + "}}, \"chunk_key_encoding\": " + keys + ", \"fill_value\": " + fill +
           ", \"codecs\": " + codecs + more + "}";
  }

  /// Bytes of a box of the values, padded with 0; `axes` are those of the array in stored order.
  static std::string box(const std::string& values, std::size_t size, const std::vector<int>& sides,
                         const std::vector<int>& first, const std::vector<int>& count,
                         const std::vector<int>& axes) {
    std::string bytes;
    std::vector<int> at(axes.size(), 0);
    for (;;) {
      std::vector<int> index(sides.size());
      bool inside = true;
      for (std::size_t i = 0; i < axes.size(); ++i) {
        const auto axis = static_cast<std::size_t>(axes[i]);
        index[axis] = first[axis] + at[i];
        inside = inside && index[axis] < sides[axis];
      }
      std::size_t place = 0;
      for (std::size_t a = 0; a < sides.size(); ++a) {
        place = place * static_cast<std::size_t>(sides[a]) + static_cast<std::size_t>(index[a]);
      }
      bytes += inside ? values.substr(place * size, size) : std::string(size, '\0');
      std::size_t i = axes.size();
      while (i > 0 && ++at[i - 1] == count[static_cast<std::size_t>(axes[i - 1])]) at[--i] = 0;
      if (i == 0) return bytes;
    }
  }

  /// Writes the files of all chunks. `values` are bytes in C order, each of `size` bytes.
  void write_chunks(const std::filesystem::path& folder, const std::string& values,
                    std::size_t size, const std::string& prefix = "",
                    std::vector<int> axes = {}) const {
    if (axes.empty()) {
      for (std::size_t a = 0; a < shape.size(); ++a) {
        axes.push_back(static_cast<int>(order == "F" ? shape.size() - 1 - a : a));
      }
    }
    std::vector<int> index(shape.size(), 0);
    for (;;) {
      std::string key = prefix;
      std::vector<int> first;
      for (std::size_t a = 0; a < shape.size(); ++a) {
        key += (key.empty() ? "" : separator) + std::to_string(index[a]);
        first.push_back(index[a] * chunk[a]);
      }
      if (std::ranges::find(left_out, key) == left_out.end()) {
        const std::filesystem::path file = folder / key;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary)
            << encode(box(values, size, shape, first, chunk, axes));
      }
      std::size_t a = shape.size();
      while (a > 0 && ++index[a - 1] * chunk[a - 1] >= shape[a - 1]) index[--a] = 0;
      if (a == 0) return;
    }
  }

  void write_2(const std::filesystem::path& folder, const std::string& values,
               std::size_t size) const {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / ".zarray") << array_2();
    write_chunks(folder, values, size);
  }
};

}  // namespace pellucid::test
