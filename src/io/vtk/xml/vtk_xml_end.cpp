// SPDX-License-Identifier: Apache-2.0
#include "vtk_xml_end.h"

#include <cstdint>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "files/input_file.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

std::string bytes_at(const fs::path& path, std::uintmax_t from, std::size_t most) {
  std::ifstream stream(path, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(from));
  std::string bytes(most, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

/// Returns the values of the attributes that name files: those of pieces, blocks and steps.
std::vector<std::string> files_named(std::string_view text) {
  std::vector<std::string> names;
  for (const std::string_view attribute : {" Source=", " file="}) {
    for (std::size_t at = text.find(attribute); at != text.npos;
         at = text.find(attribute, at + 1)) {
      const std::size_t open = at + attribute.size();
      if (open >= text.size() || (text[open] != '"' && text[open] != '\'')) continue;
      const std::size_t close = text.find(text[open], open + 1);
      if (close != text.npos) names.emplace_back(text.substr(open + 1, close - open - 1));
    }
  }
  return names;
}

void check(const fs::path& path, const fs::path& of, std::set<fs::path>& seen) {
  std::error_code error;
  // VTK says what is wrong with those that are not there, but would wait for a pipe.
  if (!fs::exists(path, error) || fs::is_directory(path, error)) return;
  check_input_file(path);
  if (!seen.insert(path.lexically_normal()).second) return;
  // Those that name others have no values, and are short.
  constexpr std::size_t longest_head = std::size_t{1} << 20, longest_end = 256;
  const std::uintmax_t size = fs::file_size(path, error);
  const std::string head = bytes_at(path, 0, longest_head);
  if (error || !head.starts_with("<") || head.find("<VTKFile") == head.npos) return;
  const std::uintmax_t from = size > longest_end ? size - longest_end : 0;
  if (bytes_at(path, from, longest_end).find("</VTKFile") == std::string::npos) {
    throw Error(of.string() + ": " +
                (path == of ? "the file" : "its part " + path.filename().string()) +
                " is cut off: it does not end with </VTKFile>");
  }
  const std::string_view elements = std::string_view(head).substr(0, head.find("<AppendedData"));
  for (const std::string& name : files_named(elements)) check(path.parent_path() / name, of, seen);
}

}  // namespace

std::set<fs::path> check_vtk_xml_end(const fs::path& path) {
  std::set<fs::path> seen;
  check(path, path, seen);
  return seen;
}

}  // namespace pellucid
