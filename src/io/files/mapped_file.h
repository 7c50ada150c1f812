// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

namespace pellucid {

/// Maps the first bytes of a file, in place, until the last owner goes. Null where the system does
/// not map it (a file system that cannot, no address space left). Throws Error where the file has
/// become shorter than that. Whoever shortens it later ends this program by a signal (SIGBUS), at
/// the first access behind its end.
std::shared_ptr<const std::byte> map_file(const std::filesystem::path& path, std::size_t bytes);

}  // namespace pellucid
