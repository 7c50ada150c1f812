// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace pellucid {

/// Lets `work` fill so many bytes in a process of its own, for libraries that a damaged file brings
/// down. Nothing where it returns false, throws, crashes, or takes longer than five minutes or much
/// more memory than the bytes. What it prints is not seen. Throws std::bad_alloc where there is no
/// memory for the bytes or no process to be had.
std::optional<std::vector<std::byte>> run_contained(
    std::size_t bytes, const std::function<bool(std::span<std::byte>)>& work);

}  // namespace pellucid
