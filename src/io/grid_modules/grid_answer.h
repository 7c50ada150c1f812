// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "grid_module.h"

namespace pellucid {

/// Writes the contents that a module found as bytes that go from process to process. Returns
/// whether there is room for them.
bool write_grid_contents(const GridContents& contents, std::span<std::byte> to);
/// Nothing where that does not stand there: the process may have written anything.
std::optional<GridContents> read_grid_contents(std::span<const std::byte> from);

}  // namespace pellucid
