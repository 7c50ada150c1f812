// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "import_function.h"
#include "jet.h"
#include "pellucid/scene/srgb.h"

/// The formulas of other programs, as templates for T = double and T = Jet.
///
/// Source: VTK 9.1, Rendering/Core/vtkColorTransferFunction.cxx (GetTable and the functions of
/// Msh), Common/DataModel/vtkPiecewiseFunction.cxx (GetTable), Common/Core/vtkMath.cxx (HSV, Lab,
/// XYZ); Msh: Moreland, Diverging Color Maps for Scientific Visualization, 2009. Gaussians: VisIt,
/// VolumeAttributes::GetGaussianOpacities; vtk.js, PiecewiseGaussianWidget::computeOpacities. VTK
/// 9.3 differs in OpacityNode::jumps alone.
/// Constants are theirs, rounded as theirs are: the truth here is what those programs show.
namespace pellucid::imported {

template <class T>
using Triple = std::array<T, 3>;

inline Triple<double> triple(const Rgb<double>& c) {
  return {c.r, c.g, c.b};
}

inline double ratio(double a, double b) {
  return a / b;
}
inline Jet ratio(const Jet& a, double b) {
  return a * Jet(1 / b);
}

/// Meets both ends to the bit.
inline double mix(double a, double b, double share) {
  return share < 1 ? a + (b - a) * share : b;
}
inline Jet mix(double a, double b, const Jet& share) {
  return Jet(a) + Jet(b - a) * share;
}

/// Converts by IEC 61966-2-1, and back with the threshold of vtkMath.
template <class T>
T light_of(const T& signal) {
  return branch(
      signal, 0.04045, [](const T& x) { return x * T(1 / 12.92); },
      [](const T& x) { return power((x + T(0.055)) * T(1 / 1.055), 2.4); });
}
template <class T>
T signal_of(const T& light) {
  return branch(
      light, 0.0031308, [](const T& x) { return x * T(12.92); },
      [](const T& x) { return T(1.055) * power(x, 1 / 2.4) - T(0.055); });
}

/// Returns the share of the way from one place to another.
template <class T>
T way_share(const T& value, double from, double to, bool logarithmic) {
  if (!logarithmic) return ratio(value - T(from), to - from);
  return ratio(logarithm(value) - T(std::log(from)), std::log(to) - std::log(from));
}
/// Returns the place at a share of the way.
inline double place_at(double share, double from, double to, bool logarithmic) {
  if (!logarithmic) return from + (to - from) * share;
  return std::exp(std::log(from) + (std::log(to) - std::log(from)) * share);
}

/// Returns the value, limited to 0 and the largest.
template <class T>
T limited(const T& value, double largest) {
  const T positive = larger(value, T(0));
  return largest < std::numeric_limits<double>::infinity() ? smaller(positive, T(largest))
                                                           : positive;
}

/// Returns the shape of the way from one node to the next, at the share s in [0,1] of it: 0 at the
/// first node, 1 at the second. Below the midpoint s is stretched to [0, 1/2], above it to [1/2,
/// 1]; then with sharpness σ in [0.01, 0.99]
///
///   s <- (2s)^(1 + 10σ)/2 for s < 1/2 and alike from the other end,
///   s <- 3s² - 2s³ + (1 - σ)(2s³ - 3s² + s)   (Hermite with slopes 1 - σ at both ends).
///
/// A σ below 0.01 counts as 0: s; one above 0.99 is a jump at the midpoint if `jumps`, else as
/// below. `second_half` says on which side of the midpoint the whole of s lies.
template <class T>
T node_shape(const T& share, double midpoint, double sharpness, bool second_half, bool hermite,
             bool jumps = true) {
  const double m = std::clamp(midpoint, 0.00001, 0.99999);
  if (jumps && sharpness > 0.99) return T(second_half ? 1 : 0);
  const T s = second_half ? T(0.5) + T(0.5) * ratio(share - T(m), 1 - m) : T(0.5) * ratio(share, m);
  if (sharpness < 0.01) return s;
  const double p = 1 + 10 * sharpness;
  const T bent =
      second_half ? T(1) - T(0.5) * power((T(1) - s) * T(2), p) : T(0.5) * power(s * T(2), p);
  if (!hermite) return bent;
  const T square = bent * bent, cube = square * bent;
  return T(3) * square - T(2) * cube + T(1 - sharpness) * (T(2) * cube - T(3) * square + bent);
}

inline double largest_value(double x) {
  return x;
}
inline double largest_value(const Jet& x) {
  return x.value.upper;
}

/// Converts linear light to the color that is asked for. What is out of gamut is handled as
/// vtkMath::XYZToRGB does: signals are divided by the largest of them where that exceeds 1, and
/// negative ones are 0.
template <class T>
Triple<T> color_of_light(const Triple<T>& light, ColorEncoding numbers) {
  bool outside = false;
  for (const T& x : light) outside = outside || largest_value(x) > 1;
  Triple<T> color;
  if (!outside && numbers == ColorEncoding::srgb) {
    for (std::size_t i = 0; i < 3; ++i) color[i] = larger(light[i], T(0));
    return color;
  }
  for (std::size_t i = 0; i < 3; ++i) color[i] = signal_of(light[i]);
  const T largest = larger(larger(larger(color[0], color[1]), color[2]), T(1));
  const T scale = reciprocal(largest);
  for (T& c : color) {
    c = larger(c * scale, T(0));
    if (numbers == ColorEncoding::srgb) c = light_of(c);
  }
  return color;
}

/// Returns a color of signals, as they are or as light.
template <class T>
Triple<T> color_of_signals(const Triple<T>& signals, ColorEncoding numbers) {
  if (numbers == ColorEncoding::linear) return signals;
  return {light_of(signals[0]), light_of(signals[1]), light_of(signals[2])};
}

// vtkMath::HSVToRGB. The hue lies in the sextant of that number, in which all is linear in it.
template <class T>
Triple<T> signals_of_hsv(const T& hue, const T& saturation, const T& value, double sextant) {
  const T rising = hue * T(6) - T(sextant), falling = T(1) - rising, one(1), zero(0);
  const std::array<Triple<T>, 6> pure{{{one, rising, zero},
                                       {falling, one, zero},
                                       {zero, one, rising},
                                       {zero, falling, one},
                                       {rising, zero, one},
                                       {one, zero, falling}}};
  const double turns = std::floor(sextant / 6);
  Triple<T> signals = pure[static_cast<std::size_t>(sextant - 6 * turns)];
  for (T& x : signals) x = (saturation * x + (one - saturation)) * value;
  return signals;
}

/// The largest step of a color where vtkMath's branches of Lab do not meet: 12.92 · 3.08 · 2.9e-8.
inline constexpr double lab_step = 1.2e-6;

// vtkMath::LabToXYZ and XYZToRGB, up to linear light. The branches leave a step of 2.9e-8 in XYZ.
template <class T>
Triple<T> light_of_lab(const T& l, const T& a, const T& b) {
  const T y = (l + T(16)) * T(1.0 / 116), x = a * T(1.0 / 500) + y, z = y - b * T(1.0 / 200);
  const auto expand = [](const T& t) {
    return branch(
        t, std::cbrt(0.008856), [](const T& v) { return (v - T(16.0 / 116)) * T(1 / 7.787); },
        [](const T& v) { return v * v * v; });
  };
  const T cx = expand(x) * T(0.9505), cy = expand(y), cz = expand(z) * T(1.089);
  return {cx * T(3.2406) + cy * T(-1.5372) + cz * T(-0.4986),
          cx * T(-0.9689) + cy * T(1.8758) + cz * T(0.0415),
          cx * T(0.0557) + cy * T(-0.2040) + cz * T(1.0570)};
}

/// Returns a control point of VisIt and vtk.js, at a value within x ± width of it; `right` says on
/// which side of its top. With t from -1 to 1 over its width, the top moved to x + x_bias, the
/// opacity is
///
///   height · (y_bias (1 - t²) + (1 - y_bias) e^(-4t²))      for y_bias < 1,
///   height · ((2 - y_bias) (1 - t²) + y_bias - 1)           else.
template <class T>
T gaussian_shape(const T& value, const GaussianNode& node, bool right) {
  const double reach = right ? node.width - node.x_bias : node.width + node.x_bias;
  const T t = reach > 0 ? ratio(value - T(node.x + node.x_bias), reach) : T(0);
  const T square = t * t, parabola = T(1) - square;
  if (node.y_bias < 1) {
    return T(node.height) *
           (T(node.y_bias) * parabola + T(1 - node.y_bias) * exponential(T(-4) * square));
  }
  return T(node.height) * (T(2 - node.y_bias) * parabola + T(node.y_bias - 1));
}

}  // namespace pellucid::imported
