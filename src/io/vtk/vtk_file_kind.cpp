// SPDX-License-Identifier: Apache-2.0
#include "vtk_file_kind.h"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "files/input_file.h"

namespace pellucid {

namespace {

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return text;
}

/// Returns the attribute "type" of the element VTKFile.
std::optional<VtkFileKind> xml_kind(std::string_view head) {
  const std::size_t begin = head.find("<VTKFile");
  if (begin == std::string_view::npos) return std::nullopt;
  head = head.substr(begin, head.find('>', begin) - begin);
  const std::size_t type = head.find("type");
  const std::size_t open = type == head.npos ? type : head.find_first_of("\"'", type);
  const std::size_t close = open == head.npos ? open : head.find(head[open], open + 1);
  if (close == head.npos) return std::nullopt;
  return VtkFileKind{true, std::string(head.substr(open + 1, close - open - 1)), std::nullopt};
}

std::optional<VtkFileKind> legacy_kind(const std::string& head) {
  std::istringstream lines(head);
  std::string line, word, dataset;
  std::getline(lines, line);
  std::getline(lines, line);  // the title
  lines >> word >> word >> dataset;
  if (upper_case(word) != "DATASET") return std::nullopt;
  VtkFileKind kind{false, upper_case(dataset), std::nullopt};
  // Origin and spacing may stand before them, each with three numbers.
  for (int i = 0; i < 9 && lines >> word && !kind.points; ++i) {
    if (upper_case(word) != "DIMENSIONS") continue;
    std::array<std::int64_t, 3> points{};
    if (lines >> points[0] >> points[1] >> points[2]) kind.points = points;
  }
  return kind;
}

}  // namespace

bool VtkFileKind::is_volume() const {
  if (!xml) return data == "STRUCTURED_POINTS" || data == "RECTILINEAR_GRID";
  const std::string_view name = data;
  const std::string_view piece = name.starts_with('P') ? name.substr(1) : name;
  return piece == "ImageData" || piece == "RectilinearGrid";
}

std::optional<VtkFileKind> vtk_file_kind(const std::filesystem::path& path) {
  constexpr std::size_t longest = 4096;
  const std::string head = first_bytes(path, longest);
  if (head.starts_with("# vtk DataFile")) return legacy_kind(head);
  if (head.starts_with("<")) return xml_kind(head);
  return std::nullopt;
}

}  // namespace pellucid
