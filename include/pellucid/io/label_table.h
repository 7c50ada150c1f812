// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/label_volume.h"

namespace pellucid {

/// Reads a table of labels with names and colors: a label description file of ITK-SNAP (lines of
/// number, red, green, blue, opacity from 0 to 1, visibility, visibility of the surface, and the
/// name in quotes) or a color table of 3D Slicer (lines of number, name without spaces, red, green,
/// blue and opacity from 0 to 255). `#` begins a comment. Colors are taken as sRGB. A name
/// that is not UTF-8 is taken as Latin-1 (ISO 8859-1).
///
/// The extinction of a label is `extinction` times its opacity; 0 if ITK-SNAP hides it. Throws
/// Error with the line if the file cannot be read, a line is neither, or a label is a duplicate.
std::vector<LabelStyle> read_label_table(const std::filesystem::path& path, double extinction);
/// Returns the same for the text of such a file; `name` begins the messages.
std::vector<LabelStyle> parse_label_table(std::string_view text, const std::string& name,
                                          double extinction);

}  // namespace pellucid
