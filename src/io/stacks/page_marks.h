// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "page_description.h"

namespace pellucid {

/// A statement of a page beside its values, which other pages of a stack may make otherwise.
struct PageMark {
  std::string key;           ///< as the file calls it: "Orientation"
  std::string value;         ///< in words; empty: not said
  bool is_of_first = false;  ///< whether the first page's holds for all; else values stay as stored
  bool may_lack = false;     ///< whether pages that do not say it agree with the first
};

/// Compares the marks of a stack's pages with those of its first.
class PageMarks {
 public:
  PageMarks() = default;
  explicit PageMarks(std::vector<PageMark> first);

  /// Counts the marks that differ from the first page's. `which` names the page: "page 3".
  void compare(const std::vector<PageMark>& marks, const std::string& which);
  /// Returns a note for each mark that differs on some page.
  std::vector<std::string> notes() const;

 private:
  struct Difference {
    PageMark first;
    std::string value, which;  ///< of the first page that differs
    std::size_t pages = 0;     ///< that differ
  };
  std::vector<Difference> differences_;
};

/// Returns the distances and the origin of a description as a mark.
PageMark distances_mark(const PageDescription& said);

}  // namespace pellucid
