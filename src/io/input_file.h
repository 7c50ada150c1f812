// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace pellucid {

/// The size of a file that is there, regular and readable. Throws Error otherwise.
std::uintmax_t check_input_file(const std::filesystem::path& path);

}  // namespace pellucid
