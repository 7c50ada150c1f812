// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/io/transfer_function_description.h"

namespace pellucid {

/// slicer: a volume property of 3D Slicer as JSON; paraview: a color map with opacities as JSON;
/// table: CSV with the columns value,r,g,b,a.
enum class ExportFormat { slicer, paraview, table };
/// Returns the format of this name, or none.
std::optional<ExportFormat> export_format_from_name(std::string_view name) noexcept;

/// Format and accuracy of an export.
struct ExportOptions {
  ExportFormat format = ExportFormat::slicer;
  /// Largest deviation from the function: of each color channel in linear light, and of the
  /// extinction as |ln| of the ratio.
  double deviation = 1e-4;
};

/// A transfer function in another program's format.
struct ExportedTransferFunction {
  std::string text;
  /// Bounds on the deviation from the function. The deviations of an opacity table itself come on
  /// top.
  double extinction_deviation = 0, color_deviation = 0;
  std::vector<std::string> notes;  ///< messages for the user, one line each
};

/// Converts a function to another program's format: opacities of the table's unit distance (1 in
/// world units for a function with extinctions) and sRGB signals, both linear in the value between
/// the nodes. Throws Error for a function of several channels, for a preset, if a color is above 1,
/// or if too many nodes would be needed.
ExportedTransferFunction export_transfer_function(const TransferFunctionDescription& function,
                                                  const ExportOptions& options);
/// Converts a function with its shading and gradient opacity. A volume property of 3D Slicer holds
/// them; of other formats, and what a volume property cannot hold, a note says that it is left out.
ExportedTransferFunction export_transfer_function(const LookDescription& look,
                                                  const ExportOptions& options);

}  // namespace pellucid
