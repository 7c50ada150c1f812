// SPDX-License-Identifier: Apache-2.0
#include "preset_points.h"

#include <array>
#include <cmath>

namespace pellucid {
namespace {

// Air -1000, fat -100, water 0, muscle 50, contrast agent 150 to 500, cancellous bone 300, compact
// bone 700 to 2000.

std::vector<PresetPoint> ct_bone() {
  return {{110, 0, {0.3, 0.12, 0.08}},     {200, 0.018, {0.42, 0.18, 0.1}},
          {350, 0.035, {0.7, 0.42, 0.22}}, {700, 0.06, {0.95, 0.8, 0.58}},
          {1200, 0.16, {1, 0.97, 0.88}},   {2500, 0.4, {1, 1, 1}}};
}

std::vector<PresetPoint> ct_soft_tissue() {
  return {{-400, 0, {0.28, 0.14, 0.1}},     {-260, 0.03, {0.45, 0.26, 0.19}},
          {-130, 0.012, {0.8, 0.58, 0.36}}, {-50, 0.008, {0.78, 0.46, 0.3}},
          {20, 0.028, {0.58, 0.17, 0.12}},  {80, 0.04, {0.52, 0.1, 0.08}},
          {160, 0.035, {0.6, 0.24, 0.16}},  {350, 0.05, {0.92, 0.76, 0.55}},
          {1200, 0.16, {1, 0.96, 0.88}}};
}

std::vector<PresetPoint> ct_angiography() {
  return {{110, 0, {0.28, 0.02, 0.02}},   {170, 0.012, {0.4, 0.03, 0.03}},
          {260, 0.06, {0.8, 0.07, 0.05}}, {420, 0.08, {1, 0.34, 0.16}},
          {650, 0.05, {1, 0.82, 0.62}},   {1400, 0.2, {1, 0.98, 0.92}}};
}

std::vector<PresetPoint> mr_t1_brain() {
  return {{0, 0, {0.2, 0.1, 0.09}},      {0.2, 0, {0.25, 0.12, 0.1}},
          {0.3, 1.2, {0.42, 0.24, 0.2}}, {0.45, 2, {0.66, 0.42, 0.34}},
          {0.58, 4, {0.84, 0.64, 0.52}}, {0.72, 9, {0.98, 0.92, 0.82}},
          {1, 14, {1, 1, 0.97}}};
}

// Moreland 2009, table "cool to warm", every fourth of its 33 colors.
constexpr std::array<Rgb<double>, 9> diverging_colors{{{59, 76, 192},
                                                       {98, 130, 234},
                                                       {141, 176, 254},
                                                       {184, 208, 249},
                                                       {221, 221, 221},
                                                       {245, 196, 173},
                                                       {244, 154, 123},
                                                       {222, 96, 77},
                                                       {180, 4, 38}}};

std::vector<PresetPoint> simulation_diverging() {
  std::vector<PresetPoint> points;
  for (std::size_t i = 0; i < diverging_colors.size(); ++i) {
    const double at = static_cast<double>(i) / (diverging_colors.size() - 1);
    const double away = std::abs(2 * at - 1);
    points.push_back({at, 0.05 + 4 * std::pow(away, 2.5), diverging_colors[i] * (1 / 255.0)});
  }
  return points;
}

// matplotlib's viridis, six colors from its dark to its bright end.
constexpr std::array<Rgb<double>, 6> isosurface_colors{{{65, 68, 135},
                                                        {42, 120, 142},
                                                        {34, 168, 132},
                                                        {122, 209, 81},
                                                        {210, 226, 27},
                                                        {253, 231, 37}}};

std::vector<PresetPoint> simulation_isosurfaces() {
  std::vector<PresetPoint> points{{0, 0, isosurface_colors.front() * (1 / 255.0)}};
  constexpr double half_width = 0.012;
  for (std::size_t i = 0; i < isosurface_colors.size(); ++i) {
    const double middle = (static_cast<double>(i) + 0.8) / 6.4;
    const Rgb<double> color = isosurface_colors[i] * (1 / 255.0);
    points.push_back({middle - half_width, 0, color});
    points.push_back({middle, 20 + 20 * static_cast<double>(i), color});
    points.push_back({middle + half_width, 0, color});
  }
  points.push_back({1, 0, isosurface_colors.back() * (1 / 255.0)});
  return points;
}

std::vector<PresetPoint> x_ray_points() {
  return {{0, 0, {0.90, 0.95, 1}}, {1, 1.5, {0.90, 0.95, 1}}};
}

constexpr std::array<NamedPreset, 7> every_preset{
    {{"ct-bone", "CT in Hounsfield units and millimetres: bone, ivory, skin and organs gone",
      PresetScale::hounsfield, ct_bone},
     {"ct-soft-tissue", "CT in Hounsfield units: skin and fat as haze, muscle red, bone inside",
      PresetScale::hounsfield, ct_soft_tissue},
     {"ct-angiography", "CT in Hounsfield units: vessels with contrast agent red, bone white",
      PresetScale::hounsfield, ct_angiography},
     {"mr-t1-brain",
      "T1-weighted MR of a head or brain, relative to its range: white matter "
      "densest",
      PresetScale::tissue, mr_t1_brain},
     {"simulation-diverging",
      "any scalar, relative to its range: low blue, high red, the middle "
      "clear",
      PresetScale::range, simulation_diverging, false},
     {"simulation-isosurfaces", "any scalar, relative to its range: six thin shells",
      PresetScale::range, simulation_isosurfaces, false},
     {"x-ray", "any scalar, relative to its range: density along the ray, as on a film",
      PresetScale::range, x_ray_points, false}}};

}  // namespace

std::span<const NamedPreset> named_presets() noexcept {
  return every_preset;
}

}  // namespace pellucid
