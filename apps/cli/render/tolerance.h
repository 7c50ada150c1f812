// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "pellucid/cpu/render.h"

namespace pellucid::cli {

/// Returns a message if pixels are over the tolerance: how many, by how much, and what to do. The
/// exit code is 3 then.
std::optional<std::string> over_tolerance(const RenderReport& report,
                                          const Integration& integration);

/// Returns "all", "none" or percent; what is neither all nor none is not rounded to it.
std::string share_text(std::uint64_t part, std::uint64_t whole);

}  // namespace pellucid::cli
