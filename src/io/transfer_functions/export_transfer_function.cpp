// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/export_transfer_function.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "chord_fit.h"
#include "import_curves.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

using imported::Jet;
using imported::Triple;

/// The largest slope of the sRGB curve, at 1: light is off by so much more than signals.
constexpr double steepest_light = 2.4 / 1.055;
/// By which the two branches of the curve do not meet.
constexpr double branch_step = 5e-8;

/// A function of our own, as signals and opacities.
class OwnCurves {
 public:
  struct Node {
    double value = 0;
    double strength = 0;  ///< an opacity or a depth
    Triple<double> light{};
  };
  /// The node before the stretch; their number where there is none.
  struct Place {
    std::size_t node = 0;
  };

  OwnCurves(std::vector<Node> nodes, bool depths) : nodes_(std::move(nodes)), depths_(depths) {
    for (const Node& node : nodes_) breaks_.push_back(node.value);
    breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());
  }

  const std::vector<double>& breaks() const noexcept { return breaks_; }
  Place place(double inside) const {
    const auto after = std::upper_bound(nodes_.begin(), nodes_.end(), inside,
                                        [](double v, const Node& node) { return v < node.value; });
    if (after == nodes_.begin()) return {nodes_.size()};
    return {static_cast<std::size_t>(after - nodes_.begin()) - 1};
  }
  template <class T>
  Triple<T> color(const T& value, const Place& place) const {
    Triple<T> signals;
    for (std::size_t i = 0; i < 3; ++i) {
      signals[i] = imported::signal_of(
          between(value, place, [&](const Node& node) { return node.light[i]; }));
    }
    return signals;
  }
  template <class T>
  T opacity(const T& value, const Place& place) const {
    const T strength = between(value, place, [](const Node& node) { return node.strength; });
    return depths_ ? T(1) - imported::exponential(T(0) - strength) : strength;
  }

 private:
  template <class T, class Part>
  T between(const T& value, const Place& place, Part&& part) const {
    if (place.node == nodes_.size()) return T(part(nodes_.front()));
    const Node& a = nodes_[place.node];
    if (place.node + 1 == nodes_.size()) return T(part(a));
    const Node& b = nodes_[place.node + 1];
    return imported::mix(part(a), part(b), imported::ratio(value - T(a.value), b.value - a.value));
  }

  std::vector<Node> nodes_;
  std::vector<double> breaks_;
  bool depths_;
};

void check_color(const Rgb<double>& color, std::size_t index) {
  if (std::max({color.r, color.g, color.b}) <= 1) return;
  throw Error("export: the color of point " + std::to_string(index) +
              " is above 1, which signals cannot be; make it darker");
}

template <class Point>
std::vector<OwnCurves::Node> nodes(const std::vector<Point>& points, double Point::*strength,
                                   double scale) {
  std::vector<OwnCurves::Node> list;
  for (const Point& p : points) {
    check_color(p.color, list.size());
    list.push_back({p.value, p.*strength * scale, imported::triple(p.color)});
  }
  return list;
}

/// Settings beside the function in a volume property; null: none.
struct HeldLight {
  const Shading* shading = nullptr;
  const std::vector<GradientOpacity::Point>* gradient_opacity = nullptr;
};

nlohmann::ordered_json lighting(const Shading* shading) {
  Shading glow;
  glow.ambient = glow.specular = 0;
  glow.diffuse = glow.power = 1;
  const Shading& s = shading != nullptr ? *shading : glow;
  return {{"diffuse", s.diffuse},
          {"ambient", s.ambient},
          {"specular", s.specular},
          {"specularPower", s.power}};
}

nlohmann::ordered_json slicer(const std::vector<OpacityPoint>& points, double unit_distance,
                              const HeldLight& light) {
  using Json = nlohmann::ordered_json;
  Json colors = Json::array(), opacities = Json::array();
  for (const OpacityPoint& p : points) {
    colors.push_back({{"x", p.value},
                      {"color", {p.color.r, p.color.g, p.color.b}},
                      {"midpoint", 0.5},
                      {"sharpness", 0.0}});
    opacities.push_back({{"x", p.value}, {"y", p.opacity}, {"midpoint", 0.5}, {"sharpness", 0.0}});
  }
  Json component{{"componentWeight", 1.0},
                 {"shade", light.shading != nullptr},
                 {"lighting", lighting(light.shading)},
                 {"disableGradientOpacity", light.gradient_opacity == nullptr},
                 {"scalarOpacityUnitDistance", unit_distance},
                 {"rgbTransferFunction", {{"type", "colorTransferFunction"}, {"points", colors}}},
                 {"scalarOpacity", {{"type", "piecewiseFunction"}, {"points", opacities}}}};
  if (light.gradient_opacity != nullptr) {
    Json factors = Json::array();
    for (const GradientOpacity::Point& p : *light.gradient_opacity) {
      factors.push_back(
          {{"x", p.gradient}, {"y", p.factor}, {"midpoint", 0.5}, {"sharpness", 0.0}});
    }
    component["gradientOpacity"] = {{"type", "piecewiseFunction"}, {"points", factors}};
  }
  return {{"@schema",
           "https://raw.githubusercontent.com/slicer/slicer/main/Modules/Loadable/VolumeRendering/"
           "Resources/Schema/volume-property-schema-v1.0.0.json#"},
          {"volumeProperties",
           {{{"effectiveRange", {points.front().value, points.back().value}},
             {"independentComponents", true},
             {"interpolationType", "linear"},
             {"components", {component}}}}}};
}

nlohmann::ordered_json paraview(const std::vector<OpacityPoint>& points) {
  using Json = nlohmann::ordered_json;
  Json colors = Json::array(), opacities = Json::array();
  for (const OpacityPoint& p : points) {
    for (const double x : {p.value, p.color.r, p.color.g, p.color.b}) colors.push_back(x);
    for (const double x : {p.value, p.opacity, 0.5, 0.0}) opacities.push_back(x);
  }
  return Json::array({{{"Name", "pellucid"},
                       {"ColorSpace", "RGB"},
                       {"RGBPoints", colors},
                       {"Points", opacities}}});
}

std::string number(double x) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

std::string table(const std::vector<OpacityPoint>& points) {
  std::string text = "value,r,g,b,a\n";
  for (const OpacityPoint& p : points) {
    for (const double x : {p.value, p.color.r, p.color.g, p.color.b}) text += number(x) + ",";
    text += number(p.opacity) + "\n";
  }
  return text;
}

void add_notes(const ExportOptions& options, double unit_distance, std::size_t points,
               ExportedTransferFunction& exported) {
  const std::string unit = "the opacities are those of a unit distance of " + number(unit_distance);
  exported.notes.push_back(std::to_string(points) + " nodes");
  exported.notes.push_back(exported.color_deviation > 0
                               ? "colors: fitted by lines in sRGB, within " +
                                     imported::text_of(exported.color_deviation) +
                                     " of each channel in linear light"
                               : "colors: exact");
  exported.notes.push_back(exported.extinction_deviation > 0
                               ? "opacities: fitted, extinctions within a factor of 1 + " +
                                     imported::text_of(exported.extinction_deviation)
                               : "opacities: exact");
  exported.notes.push_back(options.format == ExportFormat::slicer
                               ? unit
                               : unit + ", which the file cannot say: set it where it is read");
}

/// Returns the part of the look that the format can hold; notes say what is left out.
HeldLight held_light(const LookDescription& look, const ExportOptions& options,
                     std::vector<std::string>& notes) {
  HeldLight light;
  const bool slicer = options.format == ExportFormat::slicer;
  if (look.shading) {
    if (slicer) light.shading = &*look.shading;
    notes.emplace_back(slicer ? "shading: exact, but for flatness and the kind of gradient, which "
                                "are left out"
                              : "the shading is left out: the file cannot say it");
  }
  if (!look.gradient_opacity) return light;
  const GradientOpacity& opacity = *look.gradient_opacity;
  const auto is_above = [](const GradientOpacity::Point& p) { return p.factor > 1; };
  const bool above = std::ranges::any_of(opacity.points(), is_above);
  const bool world = opacity.unit() == GradientOpacity::Unit::world;
  if (slicer && !above && !world) light.gradient_opacity = &opacity.points();
  notes.emplace_back(
      !slicer ? "the gradient opacity is left out: the file cannot say it"
      : world ? "the gradient opacity is left out: it is per world length, the file's per voxel"
      : above ? "the gradient opacity is left out: it has factors above 1"
              : "gradient opacity: exact");
  return light;
}

}  // namespace

std::optional<ExportFormat> export_format_from_name(std::string_view name) noexcept {
  if (name == "slicer") return ExportFormat::slicer;
  if (name == "paraview") return ExportFormat::paraview;
  if (name == "table") return ExportFormat::table;
  return std::nullopt;
}

ExportedTransferFunction export_transfer_function(const TransferFunctionDescription& function,
                                                  const ExportOptions& options) {
  return export_transfer_function(LookDescription{function, {}, {}}, options);
}

ExportedTransferFunction export_transfer_function(const LookDescription& look,
                                                  const ExportOptions& options) {
  const TransferFunctionDescription& function = look.transfer_function;
  if (std::holds_alternative<MultivariateDescription>(function)) {
    throw Error("export: functions of several channels have no counterpart in other programs");
  }
  if (std::holds_alternative<PresetDescription>(function)) {
    throw Error(
        "export: a preset is made of its data; 'pellucid render DATA --preset NAME "
        "--save-tf FILE.json' writes its points");
  }
  const OpacityTable* const own_table = std::get_if<OpacityTable>(&function);
  const double unit_distance = own_table != nullptr ? own_table->unit_distance : 1;
  std::vector<OwnCurves::Node> list =
      own_table != nullptr ? nodes(own_table->points, &OpacityPoint::opacity, 1)
                           : nodes(std::get<std::vector<TransferFunction::Point>>(function),
                                   &TransferFunction::Point::extinction, unit_distance);
  if (list.empty()) throw Error("export: the transfer function has no points");
  const OwnCurves curves(std::move(list), own_table == nullptr);
  imported::ChordFit<OwnCurves> chords(curves, options.deviation / steepest_light,
                                       options.deviation, "export");
  const std::vector<OpacityPoint> points = chords.points();
  ExportedTransferFunction exported;
  if (chords.color_deviation() > 0) {
    exported.color_deviation = chords.color_deviation() * steepest_light + branch_step;
  }
  exported.extinction_deviation = chords.depth_deviation();
  std::vector<std::string> light_notes;
  const HeldLight light = held_light(look, options, light_notes);
  exported.text = options.format == ExportFormat::slicer
                      ? slicer(points, unit_distance, light).dump(4) + "\n"
                  : options.format == ExportFormat::paraview ? paraview(points).dump(1) + "\n"
                                                             : table(points);
  add_notes(options, unit_distance, points.size(), exported);
  exported.notes.insert(exported.notes.end(), light_notes.begin(), light_notes.end());
  return exported;
}

}  // namespace pellucid
