// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace pellucid::view {

/// A file of the page, as it is embedded in the program (page/, embed_page.cmake).
struct PageFile {
  std::string_view name;          ///< such as "style.css"
  std::string_view content_type;  ///< of HTTP
  std::string_view content;
};

/// Returns all files of the page.
std::span<const PageFile> page_files() noexcept;
/// Returns the file of a path, such as "/style.css", or null; "/" is "index.html".
const PageFile* find_page_file(std::string_view path) noexcept;

}  // namespace pellucid::view
