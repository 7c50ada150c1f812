// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_line.h"
#include "pellucid/io/import_transfer_function.h"

namespace pellucid::cli {

/// The options that say how a transfer function of another program is meant.
struct ImportArguments {
  std::string map, range, colors;
  std::optional<double> unit_distance;
  std::vector<Option*> given;  ///< all but --range, to ask which were used

  /// Adds --range alone.
  void add_range_to(CommandLine& command);
  /// Adds all but --range.
  void add_to(CommandLine& command);
  /// Throws UsageError.
  ImportOptions options(double deviation) const;
  /// Throws UsageError where one but --range is used, saying that it does not apply to `what`.
  void refuse(const std::string& what) const;
};

/// Returns the notes on an import, a line each.
std::vector<std::string> import_lines(const ImportedTransferFunction& imported,
                                      const std::string& file);

}  // namespace pellucid::cli
