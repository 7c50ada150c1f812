// SPDX-License-Identifier: Apache-2.0
#include "vtk_polyhedra.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <system_error>

#include "mapped_file.h"

namespace pellucid {

namespace {

constexpr int polyhedron = 42;

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Whether a list of cell types, "N" and behind it N numbers, has that of polyhedra.
bool has_polyhedron(std::string_view list, bool binary) {
  const auto next = [&] {
    while (!list.empty() && is_space(list.front())) list.remove_prefix(1);
    int number = -1;
    const auto [end, error] = std::from_chars(list.data(), list.data() + list.size(), number);
    const auto length = static_cast<std::size_t>(end - list.data());
    list.remove_prefix(error == std::errc::invalid_argument ? 0 : length);
    return error == std::errc() ? number : -1;
  };
  const int count = next();
  if (binary) {
    list.remove_prefix(std::min(list.find('\n'), list.size() - 1) + 1);
    constexpr std::string_view bytes("\0\0\0\x2a", 4);
    for (int i = 0; i < count && list.size() >= bytes.size(); ++i) {
      if (list.starts_with(bytes)) return true;
      list.remove_prefix(bytes.size());
    }
    return false;
  }
  for (int i = 0; i < count; ++i) {
    const int number = next();
    if (number == polyhedron) return true;
    if (number < 0) return false;
  }
  return false;
}

bool has_polyhedra(std::string_view text) {
  if (text.starts_with("<")) return text.find("faceoffsets") != text.npos;
  // Legacy: wherever the word stands, in letters of either size, as VTK would find it.
  std::string_view rest = text;
  for (int line = 0; line < 2 && !rest.empty(); ++line) {
    rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
  }
  while (!rest.empty() && is_space(rest.front())) rest.remove_prefix(1);
  const bool binary = rest.starts_with("B") || rest.starts_with("b");
  constexpr std::string_view word = "cell_types";
  const auto is_word = [&](std::size_t at) {
    return std::ranges::equal(text.substr(at, word.size()), word, [](char a, char b) {
      return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
    });
  };
  for (std::size_t at = text.find_first_of("cC"); at != text.npos;
       at = text.find_first_of("cC", at + 1)) {
    if (is_word(at) && has_polyhedron(text.substr(at + word.size()), binary)) return true;
  }
  return false;
}

}  // namespace

bool has_vtk_polyhedra(const std::set<std::filesystem::path>& files) {
  return std::ranges::any_of(files, [](const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error || size == 0) return false;
    const std::shared_ptr<const std::byte> bytes = map_file(file, size);
    if (!bytes) return true;  // nobody knows
    return has_polyhedra({reinterpret_cast<const char*>(bytes.get()), size});
  });
}

}  // namespace pellucid
