// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/math/rgb.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/function_change.h"
#include "pellucid/scene/scene.h"

namespace pellucid::cli {

/// The command line itself is wrong: exit code 2 instead of 1.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// A picture is, or two differ by, more than the tolerance: exit code 3.
class OverTolerance : public Error {
 public:
  using Error::Error;
};

/// Returns the text as one line that a terminal can show: line breaks and control characters become
/// spaces.
std::string one_line(std::string_view text);
/// Returns the text with small letters; ASCII letters only.
std::string lower_case(std::string text);

/// Read texts of options. Each throws UsageError that names the option and shows what it expects.
std::array<double, 3> parse_triple(const std::string& option, const std::string& text);
std::array<int, 3> parse_dimensions(const std::string& option, const std::string& text);
/// Reads "640x480", or "512" for a square.
ImageSize parse_size(const std::string& option, const std::string& text);
/// Reads "256" for each of so many axes, or "256x128" for two; each from 1 to 4096.
std::vector<int> parse_bins(const std::string& option, const std::string& text, std::size_t axes);
/// Reads "LOWER,UPPER": two finite numbers of which the first is the smaller.
std::array<double, 2> parse_range(const std::string& option, const std::string& text);
/// Reads LOW:HIGH or LOW,HIGH, values or percentages of the data's values, as in 2%:98%.
RangeEnds parse_value_range(const std::string& option, const std::string& text);
/// Returns a finite positive number, or the quotient of two: "0.001", "1e-4", "1/512".
double parse_tolerance(const std::string& option, const std::string& text);
/// A tolerance of a picture, or the share of its largest channel that it is.
struct PictureTolerance {
  double value = 0;
  bool is_share = false;
};
/// Returns a tolerance as above; or percent, "1%" up to "100%", which is a share.
PictureTolerance parse_picture_tolerance(const std::string& option, const std::string& text);
/// Returns a length on paper in mm: "85", "85mm", "8.5cm" or "3.35in".
double parse_paper_length(const std::string& option, const std::string& text);
/// Reads "plane:X,Y,Z,NX,NY,NZ", "box:X0,Y0,Z0,X1,Y1,Z1", "sphere:X,Y,Z,R" or
/// "cylinder:X0,Y0,Z0,X1,Y1,Z1,R"; "-" in front cuts the shape away.
Clip parse_clip(const std::string& option, const std::string& text);
/// Reads "white", "black", "#RRGGBB" in sRGB or linear "R,G,B", each >= 0.
Rgb<double> parse_color(const std::string& option, const std::string& text);
/// Reads "AMBIENT,DIFFUSE,SPECULAR" or "AMBIENT,DIFFUSE,SPECULAR,POWER".
Shading parse_shading(const std::string& option, const std::string& text);
/// Reads "head", "directional:X,Y,Z" or "point:X,Y,Z"; a color may follow behind a colon.
Light parse_light(const std::string& option, const std::string& text);
/// Reads "VALUE", "VALUE:COLOR" or "VALUE:COLOR:OPACITY"; an empty color is white.
Isosurface parse_isosurface(const std::string& option, const std::string& text);
/// Reads "x=VALUE", "y=VALUE", "z=VALUE" or "X,Y,Z,NX,NY,NZ"; an opacity may follow behind a colon.
Slice parse_slice(const std::string& option, const std::string& text);

}  // namespace pellucid::cli
