// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "pellucid/math/rgb.h"

namespace pellucid {

/// Returns the linear light of an sRGB signal in [0, 1] (IEC 61966-2-1).
inline double srgb_to_linear(double signal) {
  return signal <= 0.04045 ? signal / 12.92 : std::pow((signal + 0.055) / 1.055, 2.4);
}

/// Returns the sRGB signal of linear light. The two branches differ by up to 3e-8 where they meet,
/// because the standard's constants are rounded.
inline double linear_to_srgb(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

inline Rgb<double> srgb_to_linear(const Rgb<double>& signal) {
  return {srgb_to_linear(signal.r), srgb_to_linear(signal.g), srgb_to_linear(signal.b)};
}

inline Rgb<double> linear_to_srgb(const Rgb<double>& light) {
  return {linear_to_srgb(light.r), linear_to_srgb(light.g), linear_to_srgb(light.b)};
}

}  // namespace pellucid
