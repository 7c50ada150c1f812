// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "variable_attributes.h"

// What variables say of each other by the CF conventions. NetCDF and Zarr share it.

namespace pellucid {

/// Variables that belong to others: bounds of cells, coordinates of several axes, areas.
class VariableHelpers {
 public:
  /// Adds what a variable names. `name` has its groups in front.
  void add(const std::string& name, const VariableAttributes& attributes);

  bool is_bounds(const std::string& name) const { return bounds_.contains(name); }
  bool is_auxiliary(const std::string& name) const { return auxiliary_.contains(name); }

 private:
  std::set<std::string> bounds_, auxiliary_;
};

/// A variable that another one names.
struct NamedVariable {
  VariableAttributes attributes;
  std::vector<std::string> axes;
};
using FindVariable = std::function<std::optional<NamedVariable>(const std::string& name)>;

/// Returns notes on what a variable says of its grid and is not read. `space` are the names of its
/// axes x, y and z.
std::vector<std::string> variable_notes(const std::string& name,
                                        const VariableAttributes& attributes,
                                        const std::array<std::string, 3>& space,
                                        const FindVariable& find);

}  // namespace pellucid
