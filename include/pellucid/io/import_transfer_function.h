// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/io/transfer_function_description.h"

namespace pellucid {

/// Encoding of a file's color numbers: display signals, or linear light.
enum class ColorEncoding { srgb, linear };

struct ImportOptions {
  /// Largest deviation of the table from the file's function: of each color channel in linear
  /// light, and of the extinction as |ln| of the ratio. Straight lines are converted exactly.
  double deviation = 1e-4;
  /// Name of the color map to read from a file with several; empty: the first.
  std::string name;
  /// New values of the first and the last node; all others are moved in proportion, and so are the
  /// magnitudes of a gradient opacity.
  std::optional<std::array<double, 2>> range;
  /// Replaces the file's unit distance, or 1 if the file has none; in world units.
  std::optional<double> unit_distance;
  /// Replaces the encoding of the format, which is linear for ANARI and sRGB for all others. With
  /// `linear` an RGB color map is converted exactly, and its numbers are composited as VTK does.
  std::optional<ColorEncoding> encoding;
};

/// Limits of ImportOptions::deviation.
inline constexpr double smallest_deviation = 1e-7;
inline constexpr double largest_deviation = 0.1;

/// A transfer function of another program as an opacity table.
struct ImportedTransferFunction {
  OpacityTable table;  ///< its deviations are upper bounds
  std::optional<Shading> shading;
  /// Its unit is the voxel: VTK's magnitudes are per mean spacing. It multiplies the extinction:
  /// VTK multiplies the opacity of a sample, which is the same in the limit of short steps. Null:
  /// there is none.
  std::shared_ptr<const GradientOpacity> gradient_opacity;
  std::string format;  ///< shown to the user, such as "ParaView color map"
  std::string name;    ///< in the file; may be empty
  /// Messages for the user, one line each: what is exact, what is fitted and with which deviation,
  /// what is left out or assumed.
  std::vector<std::string> notes;
};

/// Reads a transfer function of another program. The format is recognized by the content:
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
/// src/io/transfer_functions/import_curves.h has the formulas with their sources. `name` (the
/// file's) opens every message. Throws Error, with one line that names the position, if the text
/// has none of these formats, or numbers are not finite, not in order or out of range.
ImportedTransferFunction import_transfer_function(std::string_view text, const std::string& name,
                                                  const ImportOptions& options = {});
/// Reads the same from a file of at most 64 MiB.
ImportedTransferFunction import_transfer_function(const std::filesystem::path& file,
                                                  const ImportOptions& options = {});
/// Returns whether a text is for import_transfer_function() and not in our own format
/// (parse_transfer_function()), judged by its top-level keys.
bool needs_import(std::string_view text);

}  // namespace pellucid
