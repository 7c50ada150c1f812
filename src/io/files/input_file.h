// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace pellucid {

/// Returns the size of a file that is there, regular and readable. Throws Error otherwise.
std::uintmax_t check_input_file(const std::filesystem::path& path);

/// Returns the first bytes of a regular file, at most so many; none where there is no such file or
/// it cannot be read. Opens no pipe and no device, where this could wait for ever.
std::string first_bytes(const std::filesystem::path& path, std::size_t most);

}  // namespace pellucid
