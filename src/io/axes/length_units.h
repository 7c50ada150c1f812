// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

namespace pellucid {

/// Returns the metres of a unit of length by its name or symbol: "micrometer", "µm", "Å", "thou".
/// Symbols are read as they are written (Mm is no mm), names in any case, singular or plural.
/// Returns nothing for others, such as "pixel" and "reference frame".
std::optional<double> metres_of(const std::string& unit);

/// A length and its unit; the unit is empty where a file says none.
struct SaidLength {
  double value = 0;
  std::string unit;
};

/// Lengths along x, y and z in one unit.
struct CommonLengths {
  std::array<std::optional<double>, 3> value;
  std::string unit;  ///< the first that a length has
  std::string note;  ///< what was turned or could not be; empty: the units were one
};

/// Turns lengths into the unit of the first. Lengths without a unit have that unit. Where one of
/// several units is not known, the lengths stay as they are, and the note says so.
CommonLengths in_one_unit(const std::array<std::optional<SaidLength>, 3>& lengths);

}  // namespace pellucid
