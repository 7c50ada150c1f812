// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "tests/scenes/gallery.h"

namespace pellucid::scenes {
namespace {

double smooth(double x, double y, double z) {
  return 0.5 + 0.3 * std::sin(3 * x + y) * std::cos(2 * z - x) + 0.1 * z;
}

Exhibit exhibit(const FieldFunction& field, Points points) {
  const VolumePointer volume = sampled({17, 17, 17}, field, "smooth");
  return {volume, transfer(std::move(points)), three_cameras(*volume)};
}

/// Steps in the data: most cells are constant, the others steep.
double terraces(double x, double y, double z) {
  return std::floor(8 * smooth(x, y, z)) / 8;
}

/// Flat stretches between ramps, and a flat top.
Points plateaus() {
  return {{0.1, 0, {0.1, 0.1, 0.8}},  {0.25, 0.3, {0.1, 0.5, 0.8}}, {0.375, 0.3, {0.1, 0.5, 0.8}},
          {0.4, 3, {0.9, 0.5, 0.1}},  {0.6, 3, {0.9, 0.5, 0.1}},    {0.625, 0, {0.9, 0.5, 0.1}},
          {0.75, 0, {0.9, 0.9, 0.9}}, {0.8, 5, {1, 1, 0.9}}};
}

Points jumps() {
  return {{0.3, 0.2, {1, 0.5, 0}},     {0.4, 0.2, {1, 0.5, 0}}, {0.4, 1.5, {0, 1, 0.2}},
          {0.5, 0.4, {1, 0.9, 0}},     {0.5, 3, {0, 0.2, 1}},   {0.55, 5, {0.2, 0.2, 1}},
          {0.55, 0, {0.2, 0.2, 1}},    {0.65, 0, {1, 1, 1}},    {0.65, 60, {1, 0.3, 0.2}},
          {0.6501, 60, {1, 0.3, 0.2}}, {0.6501, 0, {1, 1, 1}}};
}

/// An optical depth of about `scale` through the middle.
Points depth(double scale) {
  return {{0.1, 0, {0.1, 0.3, 1}},
          {0.45, 0.3 * scale, {0.2, 1, 0.4}},
          {0.5, scale, {1, 0.9, 0.2}},
          {0.9, 0.2 * scale, {1, 0.2, 0.3}}};
}

/// An empty half and a solid one of extinction 1e4.
Points surface() {
  return {
      {0, 0, {0, 0, 0}}, {0.5, 0, {0, 0, 0}}, {0.5, 1e4, {0.2, 0.5, 1}}, {1, 1e4, {1, 0.5, 0.2}}};
}

/// A ball of light of 50 in a veil that lets about a tenth through: errors inside of it count for
/// much, and yet no pixel is brighter than 8.
double ball(double x, double y, double z) {
  return 1 - std::hypot(x + 0.3, y - 0.2, z + 0.2);
}
Points bright_behind_a_veil() {
  return {{-1, 0.05, {0, 0.1, 0.4}}, {0.3, 0.5, {0.1, 0.1, 0.3}}, {0.4, 9, {0.1, 0.3, 0.2}},
          {0.7, 9, {0.3, 0.1, 0.1}}, {0.72, 5, {50, 12, 0.5}},    {1, 20, {10, 50, 2}}};
}

/// Colors of 50 throughout.
Points bright() {
  return {{0.2, 0.02, {0, 1, 40}}, {0.5, 0.5, {50, 20, 10}}, {1, 1.5, {5, 50, 25}}};
}

/// As the first entry, but darkness absorbs as much as light does.
Points dark() {
  return {{0.2, 1.5, {0, 0, 0}}, {0.6, 2, {0, 0, 0}}, {0.61, 40, {0, 1, 0}}, {0.62, 2, {0, 0, 0}}};
}

}  // namespace

Gallery table_gallery() {
  const auto entry = [](const char* name, double (*field)(double, double, double),
                        Points (*points)()) {
    return GalleryEntry{name, [=](int) { return exhibit(field, points()); }};
  };
  Gallery entries{entry("plateaus in data and table", terraces, plateaus),
                  entry("plateaus in the table", smooth, plateaus),
                  entry("jumps in the table", smooth, jumps),
                  entry("jumps at plateaus of the data", terraces, jumps)};
  for (const auto& [name, scale] : {std::pair{"optical depth 1e-6", 1e-6},
                                    {"optical depth 1e-2", 1e-2},
                                    {"optical depth 1", 1.0},
                                    {"optical depth 1e2", 1e2},
                                    {"optical depth 1e4", 1e4}}) {
    entries.push_back({name, [s = scale](int) { return exhibit(smooth, depth(s)); }});
  }
  entries.push_back(entry("a solid surface", smooth, surface));
  entries.push_back(entry("colors of 50 behind a veil", ball, bright_behind_a_veil));
  entries.push_back(entry("colors of 50", smooth, bright));
  entries.back().min_tolerance = 1e-5;
  entries.push_back(entry("light in a dark medium", smooth, dark));
  return entries;
}

}  // namespace pellucid::scenes
