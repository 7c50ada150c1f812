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
std::optional<ExportFormat> export_format_from_name(std::string_view name) noexcept;

struct ExportOptions {
  ExportFormat format = ExportFormat::slicer;
  /// How far what is written may be from the function: each channel of its color, in linear light,
  /// and |ln| of the ratio of the extinctions.
  double deviation = 1e-4;
};

struct ExportedTransferFunction {
  std::string text;
  /// Bounds; of an opacity table with deviations of its own beside those.
  double extinction_deviation = 0, color_deviation = 0;
  std::vector<std::string> notes;  ///< for people, a line each
};

/// The function in the form of another program: opacities of the table's unit distance, or of 1 in
/// world units where it has extinctions, and sRGB signals, both linear in the value between the
/// nodes that are written. Throws Error for a function of several channels and for a preset, where
/// a color is above 1, and where too many nodes would be needed.
ExportedTransferFunction export_transfer_function(const TransferFunctionDescription& function,
                                                  const ExportOptions& options);

}  // namespace pellucid
