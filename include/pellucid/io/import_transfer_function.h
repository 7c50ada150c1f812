// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/io/transfer_function_description.h"

namespace pellucid {

/// What a file's color numbers are: signals of a display, or linear light as they stand.
enum class ColorEncoding { srgb, linear };

struct ImportOptions {
  /// How far the table may be from the function that the file means: each channel of its color, in
  /// linear light, and |ln| of the ratio of the extinctions. What is a straight line already is
  /// taken as it is.
  double deviation = 1e-4;
  /// The color map to take, where a file has several; the first of them where this is empty.
  std::string name;
  /// The values that the first and the last node are moved to, all others in proportion.
  std::optional<std::array<double, 2>> range;
  /// In place of the file's, or of 1 where it has none; in world units.
  std::optional<double> unit_distance;
  /// In place of what the format means: linear for ANARI, sRGB for all others. With `linear` an
  /// RGB color map is exact, and pictures are composited from its numbers, as VTK does.
  std::optional<ColorEncoding> encoding;
};

/// Limits of ImportOptions::deviation.
inline constexpr double smallest_deviation = 1e-7;
inline constexpr double largest_deviation = 0.1;

struct ImportedTransferFunction {
  OpacityTable table;  ///< its deviations are bounds
  std::string format;  ///< for people, as "ParaView color map"
  std::string name;    ///< in the file; may be empty
  /// For people, a line each: what was exact, what was fitted and how far it is off, what was left
  /// out or supposed.
  std::vector<std::string> notes;
};

/// A transfer function of another program. Which one is seen by what is in it:
///
/// | format | taken from |
/// |---|---|
/// | ParaView and VTK color maps, JSON and XML | vtkColorTransferFunction, vtkPiecewiseFunction |
/// | 3D Slicer volume properties, .vp.json and .vp | the same, VolumeRendering's schema 1.0.0 |
/// | vtk.js Gaussians, JSON | vtkPiecewiseGaussianWidget::computeOpacities |
/// | VisIt volume attributes, XML | VolumeAttributes::GetGaussianOpacities |
/// | ANARI transferFunction1D, JSON | the specification, 4.5; positions as VisRTX has them |
/// | color tables, CSV | rows r,g,b[,a] or value,r,g,b[,a] |
///
/// The formulas stand, with their sources, in src/io/foreign_curves.h. `name` (the file's) opens
/// every message. Throws Error: one line that names the place, for what is not one of these, and
/// for numbers that are not finite, not in order or out of range.
ImportedTransferFunction import_transfer_function(std::string_view text, const std::string& name,
                                                  const ImportOptions& options = {});
/// The same of a file of at most 64 MiB.
ImportedTransferFunction import_transfer_function(const std::filesystem::path& file,
                                                  const ImportOptions& options = {});
/// Whether the text is not a transfer function of our own (parse_transfer_function), by the keys at
/// its top.
bool is_foreign_transfer_function(std::string_view text);

}  // namespace pellucid
