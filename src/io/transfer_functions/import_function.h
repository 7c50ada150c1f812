// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/import_transfer_function.h"

/// Transfer functions of other programs, as those programs mean them: what the readers of their
/// files give, and what fit() turns into an opacity table.
namespace pellucid::imported {

/// A corner of a way of straight lines from one color to the next.
struct WayPoint {
  double share = 0;  ///< of the way, ascending
  Rgb<double> color{};
};

/// A node of vtkColorTransferFunction; midpoint and sharpness shape the way to the next one.
struct ColorNode {
  double x = 0;
  Rgb<double> color{};  ///< numbers as in the file, 0 to 1
  double midpoint = 0.5, sharpness = 0;
  bool logarithmic = false;     ///< the way to the next one goes by ln x
  std::vector<WayPoint> way{};  ///< of ColorSpace::way: to the next one, of shares 0 to 1
};

/// A node of vtkPiecewiseFunction.
struct OpacityNode {
  double x = 0, opacity = 0;
  double midpoint = 0.5, sharpness = 0;
  bool logarithmic = false;  ///< the way to the next one goes by ln x
  bool jumps = true;         ///< at a sharpness above 0.99, as up to VTK 9.2; in 9.3 it is a curve
};

/// A control point of VisIt's and vtk.js's Gaussians, which reaches from x - width to x + width.
struct GaussianNode {
  double x = 0, height = 0, width = 0;
  double x_bias = 0;  ///< moves the top, by less than the width
  double y_bias = 0;  ///< 0 Gaussian, 1 parabola, 2 box
};

/// In what the way from one color to the next is straight; `way`: along ColorNode::way.
enum class ColorSpace { rgb, hsv, hsv_without_wrap, lab, diverging, step, way };

/// The largest number of nodes of a file.
inline constexpr std::size_t max_nodes = 100'000;
/// The largest number of Gaussians, of which each is looked at at every value.
inline constexpr std::size_t max_gaussians = 100;

struct Function {
  std::string format;  ///< for people: "ParaView color map"
  std::string name;    ///< in the file; may be empty
  std::vector<ColorNode> colors;
  ColorSpace space = ColorSpace::rgb;
  ColorEncoding numbers = ColorEncoding::srgb;
  std::vector<OpacityNode> opacities;
  /// In place of `opacities`: the largest of them at each value, between these values and constant
  /// beyond them.
  std::vector<GaussianNode> gaussians;
  double lower = 0, upper = 1;
  /// Largest numbers, above which they are cut, if numbers of nodes are not from 0 to 1.
  double largest_color = 1, largest_opacity = 1;
  double unit_distance = 1;
  std::optional<Shading> shading;
  std::vector<OpacityNode> gradient_opacity;  ///< by the gradient per mean spacing; empty: 1
  std::vector<std::string> notes;             ///< what was left out or supposed
};

/// Sets a gradient opacity, unless it is 1 everywhere.
void set_gradient_opacity(std::vector<OpacityNode> nodes, Function& function);
/// Sets a shading, its power moved into what is admitted; a note says so.
void set_shading(const Shading& shading, Function& function);
/// Fits shading and gradient opacity. Throws Error.
void fit_light(const Function& function, ImportedTransferFunction& imported);

/// Returns the function as an opacity table within the deviations asked for.
ImportedTransferFunction fit(const Function& function, const ImportOptions& options);

}  // namespace pellucid::imported
