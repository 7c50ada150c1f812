// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/builtin_fields.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>
#include <string>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

constexpr double pi = std::numbers::pi;

double marschner_lobb(double x, double y, double z) {
  const double rho = std::cos(12 * pi * std::cos(pi * std::hypot(x, y) / 2));
  return ((1 - std::sin(pi * z / 2)) + (1 + rho) / 4) / 2.5;
}

/// Returns ψ₄₂₀ without its constant: the radial part σ²(12 − σ)e^(−σ/4) times 3cos²θ − 1.
double orbital_4d_z2(double sigma_squared, double zeta) {
  const double sigma = std::sqrt(sigma_squared);
  return (12 - sigma) * (3 * zeta * zeta - sigma_squared) * std::exp(-sigma / 4);
}

double hydrogen(double x, double y, double z) {
  constexpr double bohr_radii = 40;
  // The radial part has its extrema where σ² − 24σ + 96 = 0; the inner one is the higher, and the
  // angular part is largest on the axis.
  static const double peak_sigma = 12 - std::sqrt(48.0);
  static const double peak = orbital_4d_z2(peak_sigma * peak_sigma, peak_sigma);
  const double sigma_squared = bohr_radii * bohr_radii * (x * x + y * y + z * z);
  const double amplitude = orbital_4d_z2(sigma_squared, bohr_radii * z) / peak;
  return amplitude * amplitude;
}

double smoothstep(double lower, double upper, double s) {
  const double u = std::clamp((s - lower) / (upper - lower), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

double shells(double x, double y, double z) {
  struct Shell {
    double radius, value;
    Vec3<double> opening;  ///< towards the middle of the opening, length 1
  };
  // All are open in front, turned against each other, so that the default camera looks into the
  // nest past their rims.
  static constexpr Shell shell[] = {{0.9, 0.25, {0.48, -0.80, 0.36}},
                                    {0.7, 0.50, {0.80, -0.36, 0.48}},
                                    {0.5, 0.75, {0.36, -0.80, 0.48}},
                                    {0.3, 1.00, {-0.48, -0.80, 0.36}}};
  constexpr double half_thickness = 0.05;
  const double r = std::sqrt(x * x + y * y + z * z);
  double f = 0;
  for (const Shell& s : shell) {
    // A flat top keeps each shell at its own value over most of its thickness.
    const double d = (r - s.radius) / half_thickness;
    const double wall = std::exp(-(d * d) * (d * d));
    // cos of the angle to the opening's middle: open within 35°, closed beyond 43°.
    const double towards = r > 0 ? (x * s.opening.x + y * s.opening.y + z * s.opening.z) / r : -1;
    f += s.value * wall * (1 - smoothstep(0.73, 0.82, towards));
  }
  return f;
}

struct BuiltinField {
  std::string_view name;
  double (*value)(double x, double y, double z);
};

constexpr BuiltinField fields[] = {
    {"marschner_lobb", marschner_lobb},
    {"hydrogen", hydrogen},
    {"shells", shells},
    {"sphere", [](double x, double y, double z) { return 1 - std::sqrt(x * x + y * y + z * z); }},
    {"ramp", [](double x, double, double) { return x; }},
    {"constant", [](double, double, double) { return 1.0; }},
};

}  // namespace

const std::vector<std::string_view>& builtin_field_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> list;
    for (const BuiltinField& field : fields) list.push_back(field.name);
    return list;
  }();
  return names;
}

Volume make_builtin_field(std::string_view name, int points) {
  const auto* field = std::find_if(std::begin(fields), std::end(fields),
                                   [&](const BuiltinField& f) { return f.name == name; });
  if (field == std::end(fields)) {
    std::string known;
    for (const std::string_view n : builtin_field_names()) {
      known += (known.empty() ? "" : ", ") + std::string(n);
    }
    throw Error("built-in field \"" + std::string(name) + "\" is not known; take one of " + known);
  }
  if (points < 2 || points > 2048) {
    throw Error("built-in field " + std::string(name) + ": " + std::to_string(points) +
                " points per axis, but must be 2 to 2048");
  }

  Volume::Description description;
  description.dimensions = {points, points, points};
  const double spacing = 2.0 / (points - 1);
  description.placement.origin = {-1, -1, -1};
  description.placement.spacing = {spacing, spacing, spacing};
  description.name = name;

  try {
    std::vector<float> values;
    const auto n = static_cast<std::size_t>(points);
    values.reserve(n * n * n);
    // Positions as one division of exact integers: symmetric about 0, and ±1 at the ends.
    const auto position = [&](int i) {
      return static_cast<double>(2 * i - (points - 1)) / (points - 1);
    };
    for (int k = 0; k < points; ++k) {
      for (int j = 0; j < points; ++j) {
        for (int i = 0; i < points; ++i) {
          values.push_back(static_cast<float>(field->value(position(i), position(j), position(k))));
        }
      }
    }
    return Volume(std::move(description), VolumeData(std::move(values)));
  } catch (const std::bad_alloc&) {
    throw Error("built-in field " + std::string(name) + ": not enough memory for " +
                std::to_string(points) + " points per axis; take fewer");
  }
}

}  // namespace pellucid
