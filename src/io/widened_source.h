// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "volume_source.h"

namespace pellucid {

/// The type that values of a type which volumes do not have are kept as: half floats ("f16") as
/// f32, whole numbers of 64 bits ("i64", "u64") as f64, which rounds those beyond 2^53; nothing for
/// others.
std::optional<std::string> widened_type(const std::string& stored);

/// Such values, `count` of them from byte `layout.offset` of the source, as if they stood in a
/// source of their own in the wider type and this machine's byte order. `layout.type` is the stored
/// one. Throws Error where the source ends before the last of them.
ByteSource widened_source(const ByteSource& source, const ValueLayout& layout, std::size_t count);

}  // namespace pellucid
