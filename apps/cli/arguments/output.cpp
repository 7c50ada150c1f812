// SPDX-License-Identifier: Apache-2.0
#include "output.h"

#include <cstdio>

#include "parse.h"
#include "pellucid/scene/error.h"

namespace pellucid::cli {

void print_text(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw Error("stdout: cannot write; is the disk full or the pipe closed?");
  }
}

void print_json(const Json& json) {
  // File names need not be UTF-8; what is not is replaced instead of refused.
  print_text(json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

void print_note(const std::string& text) {
  std::fputs(("pellucid: " + one_line(text) + '\n').c_str(), stderr);
}

void print_error(const std::string& message) {
  print_note("error: " + message);
  std::fflush(stderr);
}

Json to_json(const Vec3<double>& v) {
  return Json::array({v.x, v.y, v.z});
}

Json dimensions_json(const Volume& volume) {
  const auto& n = volume.description().dimensions;
  return Json::array({n[0], n[1], n[2]});
}

std::string extension_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

}  // namespace pellucid::cli
