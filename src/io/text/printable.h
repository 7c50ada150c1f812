// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// Returns text from a file as it may stand in a one-line message: control characters escaped, long
/// text cut.
std::string printable(std::string_view text);

/// Returns " (did you mean "x"?)" where a known word differs by a slip or two, else nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace pellucid
