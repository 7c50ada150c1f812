// SPDX-License-Identifier: Apache-2.0
#include "tests/device_check/kernel_table.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace pellucid::device_check {
namespace {

using Json = nlohmann::ordered_json;

/// The fields of a line, which stand in quotation marks; none if it has another form.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::size_t at = 0;
  while (at < line.size() && line[at] == '"') {
    std::string field;
    for (++at; at < line.size(); ++at) {
      if (line[at] != '"') {
        field += line[at];
      } else if (at + 1 < line.size() && line[at + 1] == '"') {
        field += line[++at];
      } else {
        break;
      }
    }
    fields.push_back(field);
    at += 2;  // the mark and the comma behind it
  }
  return fields;
}

/// Numbers have commas between thousands.
double number_of(std::string text) {
  std::erase(text, ',');
  return std::strtod(text.c_str(), nullptr);
}

}  // namespace

std::vector<Json> kernels_of(std::string_view csv) {
  constexpr const char* time = "gpu__time_duration.sum";
  std::istringstream stream{std::string(csv)};
  std::vector<std::string> header;
  std::vector<Json> kernels;
  for (std::string line; std::getline(stream, line);) {
    const std::vector<std::string> fields = fields_of(line);
    if (header.empty()) {
      if (std::ranges::find(fields, "Kernel Name") != fields.end()) header = fields;
      continue;
    }
    if (fields.size() != header.size() || fields[0].empty()) continue;
    Json launch;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (header[i] == "Kernel Name") launch["kernel"] = fields[i];
      if (header[i].find("__") != std::string::npos) launch[header[i]] = fields[i];
    }
    const auto same = std::ranges::find_if(
        kernels, [&](const Json& kernel) { return kernel.at("kernel") == launch.at("kernel"); });
    launch["launches"] = 1;
    if (same == kernels.end()) {
      kernels.push_back(launch);
      continue;
    }
    launch["launches"] = same->at("launches").get<int>() + 1;
    if (number_of(launch.value(time, "0")) > number_of(same->value(time, "0"))) {
      *same = launch;
    } else {
      (*same)["launches"] = launch["launches"];
    }
  }
  return kernels;
}

}  // namespace pellucid::device_check
