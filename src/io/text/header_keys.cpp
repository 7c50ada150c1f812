// SPDX-License-Identifier: Apache-2.0
#include "header_keys.h"
#include "printable.h"

#include <algorithm>
#include <cstddef>

namespace pellucid {

void note_ignored_keys(const std::function<void(const std::string&)>& note, const std::string& name,
                       const std::vector<std::string>& keys) {
  if (!note || keys.empty()) return;
  std::vector<std::string> once;
  for (const std::string& key : keys) {
    if (std::ranges::find(once, key) == once.end()) once.push_back(key);
  }
  constexpr std::size_t most = 12, longest = 60;
  std::string list;
  for (std::size_t i = 0; i < std::min(most, once.size()); ++i) {
    list += (i == 0 ? "" : ", ") + printable(once[i].substr(0, longest));
  }
  if (once.size() > most) list += " and " + std::to_string(once.size() - most) + " more";
  note(name + ": the header says more than is taken into account: " + list);
}

}  // namespace pellucid
