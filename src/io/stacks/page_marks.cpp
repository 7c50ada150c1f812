// SPDX-License-Identifier: Apache-2.0
#include "page_marks.h"

#include <algorithm>
#include <utility>

#include "text/printable.h"
#include "text/readable_number.h"

namespace pellucid {

PageMarks::PageMarks(std::vector<PageMark> first) {
  for (PageMark& mark : first) differences_.push_back({std::move(mark), {}, {}, 0});
}

void PageMarks::compare(const std::vector<PageMark>& marks, const std::string& which) {
  for (Difference& difference : differences_) {
    const auto other = std::ranges::find(marks, difference.first.key, &PageMark::key);
    if (other == marks.end() || other->value == difference.first.value) continue;
    if (other->may_lack && other->value.empty()) continue;
    if (difference.pages++ > 0) continue;
    difference.value = other->value;
    difference.which = which;
  }
}

std::vector<std::string> PageMarks::notes() const {
  const auto text = [](const std::string& value) {
    return value.empty() ? std::string("not said") : printable(value);
  };
  std::vector<std::string> notes;
  for (const Difference& difference : differences_) {
    if (difference.pages == 0) continue;
    const std::size_t more = difference.pages - 1;
    notes.push_back("its pages differ in " + difference.first.key + ": " +
                    text(difference.first.value) + " at the first, " + text(difference.value) +
                    " at " + printable(difference.which) +
                    (more == 0   ? ""
                     : more == 1 ? " (and 1 other differs)"
                                 : " (and " + std::to_string(more) + " others differ)") +
                    (difference.first.is_of_first ? "; the first's is taken for all"
                                                  : "; all are read as they are stored"));
  }
  return notes;
}

PageMark distances_mark(const PageDescription& said) {
  std::string text;
  const auto add = [&](const std::string& word) { text += (text.empty() ? "" : " x ") + word; };
  for (const auto& length : said.spacing) {
    if (length) {
      add(readable_number(length->value) + (length->unit.empty() ? "" : " " + length->unit));
    }
  }
  std::string origin;
  for (const double index : said.first_index) {
    origin += (origin.empty() ? "" : ", ") + readable_number(index);
  }
  if (std::ranges::any_of(said.first_index, [](double index) { return index != 0; })) {
    text += (text.empty() ? "" : ", ") + ("origin at pixel " + origin);
  }
  return {"the distances that their descriptions have", text, true};
}

}  // namespace pellucid
