// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Whole numbers of 64 bits as volumes keep them, each list by itself but all in one type: the
/// first of u8, i8, u16, i16, u32, i32 and f64 that holds every one of them. `note` is told how
/// many f64 had to round; it may be missing. Throws Error that begins with `name` where memory is
/// short.
std::vector<VolumeData> kept_whole_numbers(const std::vector<std::span<const std::int64_t>>& lists,
                                           const std::string& name,
                                           const std::function<void(const std::string&)>& note);
std::vector<VolumeData> kept_whole_numbers(const std::vector<std::span<const std::uint64_t>>& lists,
                                           const std::string& name,
                                           const std::function<void(const std::string&)>& note);

/// IEEE 754 binary16, exactly.
float float_of_half(std::uint16_t bits) noexcept;

}  // namespace pellucid
