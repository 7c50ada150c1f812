// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace pellucid {

/// Memory that this program may take before somebody ends it or an allocation fails, and who says
/// so.
struct MemoryLimit {
  std::uintmax_t bytes;
  std::string of;  ///< "this machine", "the limit of …"
};

/// Returns the least of: the machine's memory that is free or can be freed (with swap), what the
/// control groups around this process allow (v1 and v2), and RLIMIT_AS and RLIMIT_DATA less what is
/// taken. `root` is where /proc and /sys stand.
MemoryLimit memory_limit(const std::filesystem::path& root = "/");

/// Throws Error where `bytes` exceed that, before anything is allocated. `what` is what they are
/// for: "brain.nii.gz: its values".
void check_memory(std::uintmax_t bytes, const std::string& what,
                  const std::filesystem::path& root = "/");
/// Throws the error of check_memory; also for an allocation that fails all the same.
[[noreturn]] void refuse_memory(std::uintmax_t bytes, const std::string& what,
                                const MemoryLimit& limit);

}  // namespace pellucid
