// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pellucid {

/// Tells `note` in one line which keys of a header are not taken into account, the first of them by
/// name and the rest by number. Says nothing if there is none. `name` is the file's.
void note_ignored_keys(const std::function<void(const std::string&)>& note, const std::string& name,
                       const std::vector<std::string>& keys);

}  // namespace pellucid
