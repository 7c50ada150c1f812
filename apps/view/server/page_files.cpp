// SPDX-License-Identifier: Apache-2.0
#include "page_files.h"

#include <algorithm>

namespace pellucid::view {

const PageFile* find_page_file(std::string_view path) noexcept {
  if (path.empty() || path.front() != '/') return nullptr;
  path.remove_prefix(1);
  if (path.empty()) path = "index.html";
  const auto file = std::ranges::find(page_files(), path, &PageFile::name);
  return file == page_files().end() ? nullptr : &*file;
}

}  // namespace pellucid::view
