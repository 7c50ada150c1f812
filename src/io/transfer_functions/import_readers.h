// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "import_function.h"
#include "text/json_document.h"

namespace pellucid::imported {

using scene_json::Node;

/// Read a format each; all throw Error that begins with the name of the file. A map, or an array of
/// them of which `wanted` names one.
Function read_paraview(const Node& document, const std::string& wanted);
Function read_slicer(const Node& document);
Function read_vtk_js(const Node& document);
Function read_anari(const Node& document);
/// Returns the legacy text of 3D Slicer.
Function read_slicer_text(std::string_view text, const std::string& name);
Function read_color_table(std::string_view text, const std::string& name);
/// Reads ParaView's color maps or VisIt's volume attributes.
Function read_xml(std::string_view text, const std::string& name, const std::string& wanted);

/// Returns a number in [0, 1], and a color of three of them.
double share(const Node& node);
Rgb<double> color(const Node& node);
/// Reads [value, …] of four numbers a node: vtkPiecewiseFunction's x, y, midpoint, sharpness.
std::vector<OpacityNode> opacity_nodes(const Node& flat);
/// Colors and opacities in ascending order, each at most max_nodes, at least one of each. A
/// function without opacities gets a ramp from 0 to 1 over its colors, one without colors white,
/// and a note says so. `where` opens the messages.
void complete(Function& function, const std::string& where);

}  // namespace pellucid::imported
