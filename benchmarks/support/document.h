// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace pellucid::bench {

/// Replaces what stands between the lines "<!-- NAME: begin -->" and "<!-- NAME: end -->" of a
/// Markdown file. Throws Error where the file or the marks are missing.
void replace_section(const std::filesystem::path& file, const std::string& name,
                     const std::string& text);

/// printf into a string: for numbers in tables.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

}  // namespace pellucid::bench
