// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace pellucid {

/// The size of a file that is there, regular and readable. Throws Error otherwise.
std::uintmax_t check_input_file(const std::filesystem::path& path);

/// Throws Error where `bytes` exceed the machine's memory, before anything is allocated.
void check_memory(std::uintmax_t bytes, const std::string& name);

}  // namespace pellucid
