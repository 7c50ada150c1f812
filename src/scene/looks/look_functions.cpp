// SPDX-License-Identifier: Apache-2.0
#include "look_functions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "pellucid/scene/color_map.h"
#include "pellucid/scene/srgb.h"

namespace pellucid {
namespace {

/// 8-bit sRGB.
using Bytes = std::array<double, 3>;

Rgb<double> short_color(const Rgb<double>& color) {
  return {rounded(color.r, 3), rounded(color.g, 3), rounded(color.b, 3)};
}
Rgb<double> linear(const Bytes& bytes) {
  return short_color(srgb_to_linear({bytes[0] / 255, bytes[1] / 255, bytes[2] / 255}));
}

/// A color map whose colors have four digits.
class Palette {
 public:
  explicit Palette(std::string_view name) : map_(color_map(name)) {}
  Rgb<double> operator()(double place) const { return short_color(color_at(map_, place)); }

 private:
  ColorMap map_;
};

constexpr std::string_view viridis = "viridis", inferno = "inferno", cool_to_warm = "cool to warm";

const Shading soft_light{0.25, 0.8, 0.2, 25}, surface_light{0.3, 0.8, 0.3, 30};

Depths depths(const LookedAt& data) {
  return {data.values.values.size(), data.chord, data.filled};
}

/// Returns a haze of one value.
Look even_look(const LookedAt& data, const Rgb<double>& color) {
  Look look;
  const std::vector<double>& v = data.values.values;
  if (!v.empty())
    look.transfer_function = TransferFunction({{v.front(), depths(data)(1, 0), color}});
  return look;
}

/// Values that surfaces are laid through, ascending and apart from those that the data have:
/// half-way between whole numbers, or between neighbors among the values looked at.
class Levels {
 public:
  explicit Levels(const LookedAt& data) : data_(data) {}

  /// Adds the least value that at most this share of all values exceeds.
  void add_exceeded_by(double share) {
    const std::vector<double>& v = data_.values.values;
    const auto n = static_cast<double>(v.size());
    const auto i = static_cast<std::size_t>(std::min(std::max(n * (1 - share), 1.0), n - 1));
    add(v[i]);
  }
  void add(double value) {
    const std::vector<double>& v = data_.values.values;
    if (!(value > v.front() && value < v.back())) return;
    if (data_.whole_numbers) {
      value = std::floor(value) + 0.5;
    } else {
      const auto above = std::lower_bound(v.begin(), v.end(), value);
      const double below = above == v.begin() ? v.front() : *(above - 1);
      value = readable(below / 2 + (above == v.end() ? v.back() : *above) / 2,
                       (v.back() - v.front()) / 100);
    }
    if (value > v.front() && value < v.back()) levels_.push_back(value);
  }
  std::vector<double> take() {
    std::ranges::sort(levels_);
    levels_.erase(std::unique(levels_.begin(), levels_.end()), levels_.end());
    return std::move(levels_);
  }

 private:
  const LookedAt& data_;
  std::vector<double> levels_;
};

/// Returns the opacity of the i-th of surfaces from the outermost in.
double opacity_of(std::size_t i, std::size_t count) {
  const double in = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 1;
  return std::round(100 * (0.22 + 0.7 * std::pow(in, 1.3))) / 100;
}

/// Returns surfaces that are blue below 0 and red above, fainter toward 0.
std::vector<Isosurface> surfaces_of_both_signs(const LookedAt& data) {
  const std::vector<double>& v = data.values.values;
  const double largest = std::max(-v.front(), v.back());
  Levels levels(data);
  constexpr std::array<double, 3> shares{0.12, 0.35, 0.7};
  for (const double share : shares) {
    levels.add(share * largest);
    levels.add(-share * largest);
  }
  const Palette colors(cool_to_warm);
  std::vector<Isosurface> surfaces;
  for (const double value : levels.take()) {
    const double place = std::abs(value) / largest;
    Isosurface surface;
    surface.value = value;
    surface.color = colors(0.5 + std::copysign(0.2 + 0.3 * place, value));
    surface.opacity = std::round(100 * (0.2 + 0.75 * place)) / 100;
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

}  // namespace

bool is_around_zero(const ClassedValues& of) {
  const std::vector<double>& v = of.values;
  if (!of.differ) return false;
  const double low = -v.front(), high = v.back(), largest = std::max(low, high);
  const double quarter = v[v.size() / 4], three_quarters = v[v.size() - 1 - v.size() / 4];
  return std::min(low, high) >= 0.2 * largest && quarter >= -0.2 * largest &&
         three_quarters <= 0.2 * largest;
}

bool is_mostly_near_zero(const ClassedValues& of) {
  const std::vector<double>& v = of.values;
  const double near = 0.12 * std::max(-v.front(), v.back());
  const auto within = std::ranges::upper_bound(v, near) - std::ranges::lower_bound(v, -near);
  return static_cast<double>(within) > 0.7 * static_cast<double>(v.size());
}

Look ct_look(double air, bool skin, double chord) {
  struct Tissue {
    double hounsfield, depth;
    Bytes color;
  };
  // Depths of a centimetre of tissue. A head has chords of 15 cm.
  constexpr std::array<Tissue, 4> bone{{{150, 0, {204, 153, 115}},
                                        {250, 1, {235, 209, 168}},
                                        {450, 5, {247, 235, 209}},
                                        {1200, 10, {255, 252, 245}}}};
  constexpr std::array<Tissue, 5> body{{{-600, 0, {153, 107, 92}},
                                        {-300, 3, {217, 168, 143}},
                                        {-100, 5, {222, 173, 148}},
                                        {150, 5, {217, 153, 128}},
                                        {300, 8, {247, 235, 209}}}};
  Look look;
  std::vector<TransferFunction::Point> points;
  const auto tissues = skin ? std::span<const Tissue>(body) : std::span<const Tissue>(bone);
  for (const Tissue& tissue : tissues) {
    points.push_back({air + 1000 + tissue.hounsfield, two_digits(15 * tissue.depth / chord),
                      linear(tissue.color)});
  }
  look.transfer_function = TransferFunction(std::move(points));
  look.shading = soft_light;
  return look;
}

Look scan_look(const LookedAt& data, bool medical) {
  constexpr std::array<Bytes, 4> tissue{
      {{158, 138, 126}, {208, 188, 172}, {240, 225, 208}, {255, 249, 238}}};
  constexpr std::array<Bytes, 4> material{
      {{118, 126, 136}, {168, 173, 178}, {228, 214, 184}, {255, 247, 226}}};
  const auto& palette = medical ? tissue : material;
  const ClassedValues& of = data.values;
  if (!of.differ) return even_look(data, linear(palette[2]));
  const std::vector<double>& v = of.values;
  const std::size_t foreground = of.classes.foreground, bright = of.classes.bright;
  const Depths extinction = depths(data);
  const double threshold = of.threshold();
  PointList points(v.back() - v.front());
  points.add(0.35 * of.mean(0, foreground) + 0.65 * threshold, 0, linear(palette[0]));
  points.add(threshold, extinction(24, foreground), linear(palette[0]));
  if (bright < v.size()) {
    points.add(of.mean(foreground, bright), extinction(40, foreground), linear(palette[1]));
    points.add(v[bright], extinction(60, bright), linear(palette[2]));
    points.add(v.back(), extinction(120, bright), linear(palette[3]));
  } else {
    points.add(v[foreground], extinction(60, foreground), linear(palette[2]));
  }
  Look look;
  look.transfer_function = TransferFunction(points.take());
  look.shading = soft_light;
  return look;
}

Look microscopy_look(const LookedAt& data) {
  const ClassedValues& of = data.values;
  const Palette colors(inferno);
  if (!of.differ) return even_look(data, colors(0.8));
  const std::vector<double>& v = of.values;
  const std::size_t foreground = of.classes.foreground;
  const double lower = of.threshold(), upper = v.back();
  const Depths extinction = depths(data);
  PointList points(v.back() - v.front());
  points.add(0.5 * of.mean(0, foreground) + 0.5 * lower, 0, colors(0.25));
  constexpr int steps = 8;
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    points.add(lower + share * (upper - lower),
               extinction(0.3 + 8 * std::pow(share, 1.5), foreground), colors(0.35 + 0.6 * share));
  }
  Look look;
  look.transfer_function = TransferFunction(points.take());
  return look;
}

Look fog_look(const LookedAt& data) {
  const Rgb<double> white = linear({236, 240, 246});
  if (!data.values.differ) return even_look(data, white);
  const std::vector<double>& v = data.values.values;
  PointList points(v.back() - v.front());
  points.add(std::max(v.front(), 0.0), 0, linear({170, 178, 190}));
  points.add(v.back(), depths(data)(14, data.values.classes.foreground), white);
  Look look;
  look.transfer_function = TransferFunction(points.take());
  look.shading = soft_light;
  look.shading->ambient = 0.45;
  look.shading->diffuse = 0.6;
  look.shading->specular = 0;
  return look;
}

Look simulation_look(const LookedAt& data) {
  const ClassedValues& of = data.values;
  const Palette colors(viridis);
  if (!of.differ) return even_look(data, colors(0.6));
  Look look;
  look.shading = surface_light;
  if (is_around_zero(of)) {
    look.isosurfaces = surfaces_of_both_signs(data);
    if (!look.isosurfaces.empty()) return look;
  }
  const std::vector<double>& v = of.values;
  const double above =
      static_cast<double>(v.size() - of.classes.foreground) / static_cast<double>(v.size());
  Levels levels(data);
  constexpr std::array<double, 4> shares{1, 0.4, 0.15, 0.04};
  for (const double share : shares) levels.add_exceeded_by(share * above);
  std::vector<double> values = levels.take();
  const double lower = v.front(), range = v.back() - v.front();
  if (values.empty() || values.back() < lower + 0.4 * range) {  // something rare is far above
    for (const double value : values) levels.add(value);
    levels.add(lower + 0.7 * range);
    values = levels.take();
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double place =
        values.size() > 1 ? static_cast<double>(i) / static_cast<double>(values.size() - 1) : 0.5;
    Isosurface surface;
    surface.value = values[i];
    surface.color = colors(0.3 + 0.67 * place);
    surface.opacity = opacity_of(i, values.size());
    look.isosurfaces.push_back(std::move(surface));
  }
  return look.isosurfaces.empty() ? even_look(data, colors(0.6)) : look;
}

Look mask_look(double lower, double upper) {
  Look look;
  look.shading = surface_light;
  Isosurface surface;
  surface.value = lower / 2 + upper / 2;
  surface.color = linear({214, 122, 98});
  look.isosurfaces.push_back(std::move(surface));
  return look;
}

namespace {

/// Returns whether a mesh is a box of little but background, as a domain of simulation is.
bool is_mostly_background(const LookedAt& data) {
  const auto all = static_cast<double>(data.values.values.size());
  return data.filled > 0.9 && static_cast<double>(data.values.classes.foreground) > 0.8 * all;
}

}  // namespace

Look body_look(const LookedAt& data) {
  const ClassedValues& of = data.values;
  if (!of.differ) return even_look(data, Palette(viridis)(0.6));
  const std::vector<double>& v = of.values;
  const bool signs = is_around_zero(of), clear = !signs && is_mostly_background(data);
  const Palette colors(signs ? cool_to_warm : viridis);
  const double largest = std::max(std::abs(v.front()), std::abs(v.back()));
  const double lower = signs ? -largest : clear ? of.threshold() : v.front();
  const double upper = signs ? largest : v.back();
  const std::size_t foreground = clear ? of.classes.foreground : 0;
  const double extinction = depths(data)(9, foreground);
  PointList points(v.back() - v.front());
  if (clear) points.add(of.mean(0, foreground) / 2 + lower / 2, 0, colors(0.2));
  const int steps = signs ? 8 : 10;
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    // What is within is seen through what is around it.
    const double density = clear ? 0.1 + 0.9 * share * share : 1;
    points.add(lower + share * (upper - lower), two_digits(density * extinction),
               colors(clear ? 0.2 + 0.8 * share : share));
  }
  Look look;
  look.transfer_function = TransferFunction(points.take());
  return look;
}

}  // namespace pellucid
