// SPDX-License-Identifier: Apache-2.0
#include "parse.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "pellucid/scene/srgb.h"

namespace pellucid::cli {

namespace {

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || text.empty()) return std::nullopt;
  return number;
}

template <class Number>
std::vector<Number> parse_list(const std::string& option, const std::string& text, char separator,
                               std::string_view expected) {
  std::vector<Number> numbers;
  std::string_view rest = text;
  while (true) {
    const std::size_t cut = rest.find(separator);
    const std::optional<Number> number = parse_number<Number>(rest.substr(0, cut));
    if (!number) throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
    numbers.push_back(*number);
    if (cut == std::string_view::npos) return numbers;
    rest.remove_prefix(cut + 1);
  }
}

template <class Number>
std::array<Number, 3> parse_three(const std::string& option, const std::string& text,
                                  std::string_view expected) {
  const std::vector<Number> n = parse_list<Number>(option, text, ',', expected);
  if (n.size() != 3) throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  return {n[0], n[1], n[2]};
}

}  // namespace

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool control = byte < 0x20 || byte == 0x7f;
    if (control && (line.empty() || line.back() == ' ')) continue;
    line += control ? ' ' : c;
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

std::array<double, 3> parse_triple(const std::string& option, const std::string& text) {
  constexpr std::string_view expected = "three finite numbers X,Y,Z";
  const auto triple = parse_three<double>(option, text, expected);
  for (const double x : triple) {
    if (!std::isfinite(x)) {
      throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
    }
  }
  return triple;
}

std::array<int, 3> parse_dimensions(const std::string& option, const std::string& text) {
  constexpr std::string_view expected = "three counts X,Y,Z of at least 1";
  const auto dimensions = parse_three<int>(option, text, expected);
  for (const int n : dimensions) {
    if (n < 1) throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  }
  return dimensions;
}

ImageSize parse_size(const std::string& option, const std::string& text) {
  constexpr std::string_view expected = "WIDTHxHEIGHT in pixels, each 1 to 65536, as in 640x480";
  const std::vector<int> n = parse_list<int>(option, text, 'x', expected);
  const int width = n.front(), height = n.back();
  if (n.size() > 2 || width < 1 || height < 1 || width > 65536 || height > 65536) {
    throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  }
  return {width, height};
}

double parse_paper_length(const std::string& option, const std::string& text) {
  constexpr std::pair<std::string_view, double> units[] = {{"mm", 1}, {"cm", 10}, {"in", 25.4}};
  std::string_view number = text;
  double mm = 1;
  for (const auto& [unit, size] : units) {
    if (!number.ends_with(unit)) continue;
    number.remove_suffix(unit.size());
    mm = size;
    break;
  }
  const std::optional<double> length = parse_number<double>(number);
  if (!length || !std::isfinite(*length) || !(*length > 0)) {
    throw UsageError(
        fmt::format("{} '{}': expected mm, or a length as in 8.5cm or 3.35in", option, text));
  }
  return *length * mm;
}

std::vector<int> parse_bins(const std::string& option, const std::string& text, std::size_t axes) {
  constexpr int most = 4096;
  const std::string expected =
      fmt::format("a number of bins from 1 to {}{}", most, axes == 2 ? ", or two as NxM" : "");
  std::vector<int> bins = parse_list<int>(option, text, 'x', expected);
  if (bins.size() == 1) bins.resize(axes, bins[0]);
  bool good = bins.size() == axes;
  for (const int n : bins) good = good && n >= 1 && n <= most;
  if (!good) throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  return bins;
}

std::array<double, 2> parse_range(const std::string& option, const std::string& text) {
  constexpr std::string_view expected = "two finite numbers LOWER,UPPER, the smaller one first";
  const std::vector<double> ends = parse_list<double>(option, text, ',', expected);
  if (ends.size() != 2 || !(ends[0] < ends[1]) || !std::isfinite(ends[1] - ends[0])) {
    throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  }
  return {ends[0], ends[1]};
}

RangeEnds parse_value_range(const std::string& option, const std::string& text) {
  constexpr std::string_view expected =
      "two ascending values LOW:HIGH, or percentages from 0% to 100%, as in 10:90 or 2%:98%";
  const auto fail = [&] {
    throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  };
  const std::size_t middle = text.find_first_of(":,");
  if (middle == std::string::npos) fail();
  const auto parse_end = [&](std::string end) {
    RangeEnd made;
    made.is_percent = end.ends_with('%');
    if (made.is_percent) end.pop_back();
    const std::vector<double> number = parse_list<double>(option, end, ',', expected);
    made.number = number[0];
    const bool good =
        made.is_percent ? made.number >= 0 && made.number <= 100 : std::isfinite(made.number);
    if (number.size() != 1 || !good) fail();
    return made;
  };
  const RangeEnds range{parse_end(text.substr(0, middle)), parse_end(text.substr(middle + 1))};
  const bool comparable = range[0].is_percent == range[1].is_percent;
  if (comparable && !(range[0].number < range[1].number)) fail();
  return range;
}

double parse_tolerance(const std::string& option, const std::string& text) {
  constexpr std::string_view expected = "a positive number or fraction, as in 0.001, 1e-4 or 1/512";
  const std::vector<double> n = parse_list<double>(option, text, '/', expected);
  const double tolerance = n.size() == 2 ? n[0] / n[1] : n[0];
  bool good = n.size() <= 2 && tolerance > 0 && std::isfinite(tolerance);
  for (const double x : n) good = good && x > 0 && std::isfinite(x);
  if (!good) throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  return tolerance;
}

PictureTolerance parse_picture_tolerance(const std::string& option, const std::string& text) {
  if (!text.ends_with('%')) return {parse_tolerance(option, text), false};
  constexpr std::string_view expected =
      "percent of the picture's largest channel, above 0% and up to 100%, as in 1% or 0.5%";
  std::string number = text.substr(0, text.size() - 1);
  while (number.ends_with(' ')) number.pop_back();
  const std::vector<double> n = parse_list<double>(option, number, ',', expected);
  if (n.size() != 1 || !(n[0] > 0 && n[0] <= 100)) {
    throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  }
  return {n[0] / 100, true};
}

Clip parse_clip(const std::string& option, const std::string& text) {
  constexpr std::string_view expected =
      "plane:X,Y,Z,NX,NY,NZ, box:X0,Y0,Z0,X1,Y1,Z1, sphere:X,Y,Z,R or "
      "cylinder:X0,Y0,Z0,X1,Y1,Z1,R, with '-' in front to cut the shape away";
  const auto fail = [&]() -> Clip {
    throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  };
  Clip clip;
  clip.keep_inside = !text.starts_with('-');
  const std::string shape = clip.keep_inside ? text : text.substr(1);
  const std::size_t colon = shape.find(':');
  if (colon == std::string::npos) return fail();
  const std::string name = shape.substr(0, colon);
  const std::size_t count = name == "sphere"                   ? 4
                            : name == "plane" || name == "box" ? 6
                            : name == "cylinder"               ? 7
                                                               : 0;
  if (count == 0) return fail();
  const std::vector<double> n = parse_list<double>(option, shape.substr(colon + 1), ',', expected);
  if (n.size() != count) return fail();
  const auto point = [&](std::size_t i) { return Vec3<double>{n[i], n[i + 1], n[i + 2]}; };
  if (name == "plane") clip.shape = ClipPlane{point(0), point(3)};
  if (name == "box") clip.shape = ClipBox{point(0), point(3)};
  if (name == "sphere") clip.shape = ClipSphere{point(0), n[3]};
  if (name == "cylinder") clip.shape = ClipCylinder{point(0), point(3), n[6]};
  try {
    check_clip(clip, fmt::format("{} '{}'", option, text));
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
  return clip;
}

Rgb<double> parse_color(const std::string& option, const std::string& text) {
  if (text == "white") return {1, 1, 1};
  if (text == "black") return {0, 0, 0};
  constexpr std::string_view expected =
      "white, black, #RRGGBB in sRGB, or three linear numbers R,G,B of at least 0, as in "
      "0.2,0.2,0.2";
  if (text.starts_with('#')) {
    std::uint32_t rgb = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + 1, end, rgb, 16);
    if (text.size() != 7 || error != std::errc() || stop != end) {
      throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
    }
    const auto part = [&](int shift) { return srgb_to_linear((rgb >> shift & 0xff) / 255.0); };
    return {part(16), part(8), part(0)};
  }
  const auto [r, g, b] = parse_three<double>(option, text, expected);
  for (const double x : {r, g, b}) {
    if (!std::isfinite(x) || x < 0) {
      throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
    }
  }
  return {r, g, b};
}

namespace {

/// Returns the parts of a text between colons.
std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

Shading parse_shading(const std::string& option, const std::string& text) {
  constexpr std::string_view expected =
      "on, off, or numbers AMBIENT,DIFFUSE,SPECULAR from 0 to 1000, and perhaps a POWER from 1 to "
      "1000, as in 0.2,0.7,0.2,20";
  const std::vector<double> n = parse_list<double>(option, text, ',', expected);
  bool good = n.size() == 3 || n.size() == 4;
  for (std::size_t i = 0; i < n.size(); ++i) good = good && n[i] >= (i < 3 ? 0 : 1) && n[i] <= 1e3;
  if (!good) throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  Shading shading;
  shading.ambient = n[0];
  shading.diffuse = n[1];
  shading.specular = n[2];
  if (n.size() == 4) shading.power = n[3];
  return shading;
}

Light parse_light(const std::string& option, const std::string& text) {
  constexpr std::string_view expected =
      "head, directional:X,Y,Z or point:X,Y,Z, and perhaps :COLOR behind it";
  const std::vector<std::string> parts = parts_of(text);
  const bool head = parts[0] == "head";
  const std::size_t color_at = head ? 1 : 2;
  const bool known = head || parts[0] == "directional" || parts[0] == "point";
  if (!known || parts.size() < color_at || parts.size() > color_at + 1) {
    throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  }
  Light light;
  if (!head) {
    const auto [x, y, z] = parse_triple(option, parts[1]);
    if (parts[0] == "point") {
      light.kind = PointLight{{x, y, z}};
    } else {
      light.kind = DirectionalLight{{x, y, z}};
    }
  }
  if (parts.size() > color_at) light.color = parse_color(option, parts[color_at]);
  try {
    check_light(light, fmt::format("{} '{}'", option, text));
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
  return light;
}

Isosurface parse_isosurface(const std::string& option, const std::string& text) {
  constexpr std::string_view expected =
      "VALUE, VALUE:COLOR or VALUE:COLOR:OPACITY with an opacity from 0 to 1, as in "
      "300:#ffe6cc:0.5";
  const auto fail = [&] {
    throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  };
  const std::vector<std::string> parts = parts_of(text);
  const std::optional<double> value = parse_number<double>(parts[0]);
  if (parts.size() > 3 || !value || !(std::abs(*value) <= 2.1e37)) fail();
  Isosurface surface;
  surface.value = *value;
  if (parts.size() > 1 && !parts[1].empty()) surface.color = parse_color(option, parts[1]);
  if (parts.size() < 3) return surface;
  const std::optional<double> opacity = parse_number<double>(parts[2]);
  if (!opacity || !(*opacity >= 0 && *opacity <= 1)) fail();
  surface.opacity = *opacity;
  return surface;
}

Slice parse_slice(const std::string& option, const std::string& text) {
  constexpr std::string_view expected =
      "x=VALUE, y=VALUE, z=VALUE or X,Y,Z,NX,NY,NZ with a normal that is not 0, and perhaps "
      ":OPACITY from 0 to 1 behind it, as in z=12.5:0.8";
  const auto fail = [&] {
    throw UsageError(fmt::format("{} '{}': expected {}", option, text, expected));
  };
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() > 2) fail();
  Slice slice;
  const std::string& plane = parts[0];
  if (plane.size() > 2 && plane[1] == '=' && plane[0] >= 'x' && plane[0] <= 'z') {
    const std::optional<double> value = parse_number<double>(std::string_view(plane).substr(2));
    if (!value || !(std::abs(*value) <= 1e30)) fail();
    const int axis = plane[0] - 'x';
    slice.normal = {0, 0, 0};
    slice.normal[axis] = 1;
    slice.point[axis] = *value;
  } else {
    const std::vector<double> n = parse_list<double>(option, plane, ',', expected);
    bool good = n.size() == 6;
    for (const double x : n) good = good && std::abs(x) <= 1e30;
    if (!good || !(std::hypot(n[3], n[4], n[5]) > 0)) fail();
    slice.point = {n[0], n[1], n[2]};
    slice.normal = {n[3], n[4], n[5]};
  }
  if (parts.size() < 2) return slice;
  const std::optional<double> opacity = parse_number<double>(parts[1]);
  if (!opacity || !(*opacity >= 0 && *opacity <= 1)) fail();
  slice.opacity = *opacity;
  return slice;
}

}  // namespace pellucid::cli
