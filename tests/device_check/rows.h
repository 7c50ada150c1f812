// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pellucid/scene/error.h"

namespace pellucid::device_check {

using Json = nlohmann::ordered_json;

/// Appends lines of JSON to a file. Safe to use from several threads.
class RowWriter {
 public:
  /// Throws Error if the file cannot be written.
  explicit RowWriter(const std::filesystem::path& file) : stream_(file, std::ios::app) {
    if (!stream_) throw Error(file.string() + " cannot be written");
  }
  void add(const Json& row) {
    const std::lock_guard lock(mutex_);
    stream_ << row.dump() << '\n' << std::flush;
    if (!stream_) throw Error("results cannot be written");
  }

 private:
  std::mutex mutex_;
  std::ofstream stream_;
};

/// Returns the rows of a file; none if there is no file. Leaves out a last line that was cut off.
inline std::vector<Json> read_rows(const std::filesystem::path& file) {
  std::vector<Json> rows;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    Json row = Json::parse(line, nullptr, false);
    if (!row.is_discarded()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace pellucid::device_check
