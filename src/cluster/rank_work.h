// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pellucid {

/// Does the work and returns what became of it, in words that ranks exchange.
std::string outcome_of(const std::function<void()>& work);
bool is_done(const std::string& outcome) noexcept;
/// Throws what agreed() throws for the outcomes of all ranks.
void throw_unless_done(const std::vector<std::string>& outcomes);

}  // namespace pellucid
