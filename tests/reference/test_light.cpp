// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "multivariate.h"
#include "pellucid/reference/render.h"
#include "pellucid/scene/error.h"
#include "tests/scenes/makers.h"
#include "tests/scenes/meshes.h"

namespace pellucid::test_light {
namespace {

using scenes::grid_description;
using scenes::make_volume;
using scenes::transfer;
using Place = Vec3<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr Rgb<double> tan_color{0.9, 0.6, 0.3};

Scene of(std::vector<Layer> layers, std::vector<Light> lights = {Light{}}) {
  Scene scene;
  scene.layers = std::move(layers);
  scene.lights = std::move(lights);
  return scene;
}

Layer layer_of(scenes::VolumePointer volume, scenes::Points points) {
  return {VolumeContent{std::move(volume), transfer(std::move(points))}};
}

Layer lit(Layer layer, const Shading& shading = {}) {
  layer.shading = shading;
  return layer;
}

Place unit(const Place& v) {
  return v * (1 / length(v));
}

/// What the lights make of colors, from the definition.
struct Shade {
  Rgb<double> factor, added;

  Shade(const Shading& shading, const Place& normal, const Place& to_eye,
        const std::vector<std::pair<Place, Rgb<double>>>& lights)
      : factor{shading.ambient, shading.ambient, shading.ambient} {
    for (const auto& [to_light, color] : lights) {
      const Place both = to_light + to_eye;
      factor += color * (shading.diffuse * std::abs(dot(normal, to_light)));
      if (length(both) == 0) continue;
      added +=
          color * (shading.specular * std::pow(std::abs(dot(normal, unit(both))), shading.power));
    }
  }
  Rgb<double> operator()(const Rgb<double>& c) const {
    return {factor.r * c.r + added.r, factor.g * c.g + added.g, factor.b * c.b + added.b};
  }
};

Place normal_of(const Place& gradient, double flat) {
  return gradient * (1 / std::sqrt(dot(gradient, gradient) + flat * flat));
}

void expect_color(const Rgb<double>& color, const Rgb<double>& truth, double tolerance) {
  EXPECT_NEAR(color.r, truth.r, tolerance);
  EXPECT_NEAR(color.g, truth.g, tolerance);
  EXPECT_NEAR(color.b, truth.b, tolerance);
}

/// Simpson's rule.
double integral(double a, double b, int steps, const std::function<double(double)>& f) {
  const double h = (b - a) / steps;
  double sum = f(a) + f(b);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4 : 2) * f(a + i * h);
  return sum * h / 3;
}

/// A ramp on a grid in any place, with one value of the world gradient everywhere.
struct Ramp {
  Volume::Description description;
  Place gradient;

  scenes::VolumePointer volume() const {
    const GridPlacement& at = description.placement;
    return make_volume<double>(description, [&](int i, int j, int k) {
      const std::array<int, 3> index{i, j, k};
      Place place = at.origin;
      for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const std::vector<double>& x = description.coordinates[axis];
        const auto n = static_cast<std::size_t>(index[axis]);
        double s = at.spacing[a] * index[axis];
        if (!x.empty()) {
          s = description.centering == Centering::cell ? (x[n] + x[n + 1]) / 2 : x[n];
        }
        place = place + at.direction.column[a] * s;
      }
      return dot(gradient, place);
    });
  }
};

/// Rolling data without symmetries.
double wave(int i, int j, int k) {
  return std::sin(0.9 * i + 0.4 * j) + std::cos(0.7 * k - 0.3 * i) + 0.1 * j;
}

/// A layer of them, and rays that see much of it.
Layer waves() {
  return layer_of(make_volume<float>(grid_description({7, 7, 7}), wave),
                  {{-1, 0, {1, 0, 0}}, {0.5, 0.3, {0.5, 0.5, 0}}, {2, 2, {0, 1, 1}}});
}
std::pair<Place, Place> ray_through_waves(int i) {
  const Place from{-3.0 + 0.2 * i, 2 + 0.3 * i, 9}, to{3.1 + 0.1 * i, 2.4, 3.3};
  return {from, to - from};
}

std::vector<Ramp> ramps() {
  Volume::Description uniform = grid_description({5, 4, 6}, {-1, 2, 0}, {0.5, 1, 0.75});
  Volume::Description sheared = uniform;
  sheared.placement.direction = {{{0.8, 0.6, 0.1}, {-0.5, 0.9, 0}, {0.3, 0.2, 1.4}}};
  Volume::Description rectilinear = sheared;
  rectilinear.coordinates[0] = {0, 0.3, 1, 1.2, 2.5};
  rectilinear.coordinates[2] = {0, 0.1, 0.2, 1.2, 1.3, 3};
  Volume::Description cells = rectilinear;
  cells.centering = Centering::cell;
  cells.coordinates[0] = {0, 0.3, 1, 1.2, 2, 2.5};
  cells.coordinates[2] = {};
  return {{uniform, {0.7, -0.4, 1.1}},
          {sheared, {0.7, -0.4, 1.1}},
          {rectilinear, {-0.3, 0.8, 0.2}},
          {cells, {0.5, 0.4, -0.9}}};
}

/// One normal on all of the ray: the opacity has the shaded color.
TEST(ReferenceLight, LinearDataHaveOneNormal) {
  const std::vector<Light> lights{{HeadLight{}, {0.5, 1, 0.25}},
                                  {DirectionalLight{{1, -2, 0.5}}, {1, 0.3, 0.8}}};
  const Place origin{0.3, 3.1, -6}, direction = unit({0.05, 0.1, 1});
  for (const Ramp& ramp : ramps()) {
    Layer layer = layer_of(ramp.volume(), {{0, 0.8, tan_color}});
    for (const GradientKind kind : {GradientKind::smooth, GradientKind::field}) {
      // Outer half cells repeat the border's gradient, or have none: see below.
      if (kind == GradientKind::field && ramp.description.centering == Centering::cell) continue;
      layer.shading = Shading{0.1, 0.8, 0.5, 7, kind, 0.3};
      const VolumeStatistics& data = std::get<VolumeContent>(layer.content).volume->statistics();
      const double flat = 0.3 * (data.maximum - data.minimum) / voxel_of(layer);
      const ReferencePixel pixel = reference_ray(of({layer}, lights), origin, direction);
      const Shade shade(
          *layer.shading, normal_of(ramp.gradient, flat), direction * -1,
          {{direction * -1, lights[0].color}, {unit({-1, 2, -0.5}), lights[1].color}});
      ASSERT_GT(pixel.opacity, 0.5);
      expect_color(pixel.radiance, shade(tan_color) * pixel.opacity, 1e-11);
    }
  }
}

TEST(ReferenceLight, SizeOfAVoxelSetsTheFlatGradient) {
  // Data 0 … 8 along z; edges 0.5, 1 and 2.
  const auto volume = make_volume<float>(grid_description({3, 3, 5}, {0, 0, 0}, {0.5, 1, 2}),
                                         [](int, int, int k) { return 2 * k; });
  const Layer layer = lit(layer_of(volume, {{0, 0.1, {1, 1, 1}}}), {0, 1, 0, 1, {}, 0.2});
  const double flat = 0.2 * 8 / (3.5 / 3);
  const ReferencePixel pixel = reference_ray(of({layer}), {0.4, 0.3, -1}, {0, 0, 1});
  EXPECT_NEAR(pixel.radiance.g, pixel.opacity / std::sqrt(1 + flat * flat), 1e-13);
}

TEST(ReferenceLight, AmbientLightScalesColors) {
  const Layer plain = waves(), dim = lit(plain, {0.4, 0, 0, 1});
  for (int i = 0; i < 10; ++i) {
    const auto [from, v] = ray_through_waves(i);
    const ReferencePixel truth = reference_ray(of({plain}), from, v);
    const ReferencePixel pixel = reference_ray(of({dim}), from, v);
    ASSERT_GT(truth.opacity, 0.1);
    expect_color(pixel.radiance, truth.radiance * 0.4, 1e-12);
    EXPECT_NEAR(pixel.opacity, truth.opacity, 1e-12);
    EXPECT_NEAR(pixel.half_opacity_depth, truth.half_opacity_depth, 1e-9);
    // Without a light there is no more than that, whatever the shading.
    expect_color(reference_ray(of({lit(plain, {0.4, 5, 6, 1})}, {}), from, v).radiance,
                 truth.radiance * 0.4, 1e-12);
  }
}

/// Gradient opacity 1 changes nothing but the way of integration.
TEST(ReferenceLight, LayersWithoutShadingKeepTheirColors) {
  const Layer plain = waves();
  Layer other = plain;
  other.gradient_opacity =
      std::make_shared<const GradientOpacity>(std::vector<GradientOpacity::Point>{{0, 1}});
  for (int i = 0; i < 10; ++i) {
    const auto [from, v] = ray_through_waves(i);
    const ReferencePixel truth = reference_ray(of({plain}), from, v);
    const ReferencePixel pixel = reference_ray(of({other}), from, v);
    expect_color(pixel.radiance, truth.radiance, 1e-12);
    EXPECT_NEAR(pixel.optical_depth, truth.optical_depth, 1e-12);
    EXPECT_NEAR(pixel.half_opacity_depth, truth.half_opacity_depth, 1e-10);
  }
}

TEST(ReferenceLight, HeadLightShinesAlongTheRay) {
  const Layer layer = lit(waves(), {0.1, 0.7, 0.4, 11});
  for (int i = 0; i < 10; ++i) {
    const auto [from, v] = ray_through_waves(i);
    const ReferencePixel head = reference_ray(of({layer}), from, v);
    for (const Light& same :
         {Light{DirectionalLight{v * 3}, {1, 1, 1}}, Light{PointLight{from}, {1, 1, 1}}}) {
      expect_color(reference_ray(of({layer}, {same}), from, v).radiance, head.radiance, 1e-11);
    }
  }
}

/// A grid's data and its smooth gradient at a place, from their definitions.
class Naive {
 public:
  explicit Naive(const Volume& volume) : volume_(volume) {}

  /// Also the interpolated magnitude.
  struct Sample {
    double value = 0, magnitude = 0;
    Place gradient{};
  };
  Sample operator()(const Place& world) const {
    const Place p = volume_.grid_from_world().point(world);
    Sample sample;
    std::array<int, 3> cell{};
    for (int a = 0; a < 3; ++a) {
      cell[static_cast<std::size_t>(a)] = std::clamp(static_cast<int>(p[a]), 0, n_ - 2);
    }
    for (int corner = 0; corner < 8; ++corner) {
      std::array<int, 3> at = cell;
      double weight = 1;
      for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const double share = p[a] - cell[axis];
        const int upper = corner >> a & 1;
        at[axis] += upper;
        weight *= upper == 1 ? share : 1 - share;
      }
      const Place g = gradient(at);
      sample.value += weight * value(at);
      sample.magnitude += weight * length(g);
      sample.gradient = sample.gradient + g * weight;
    }
    return sample;
  }

 private:
  double value(const std::array<int, 3>& at) const { return wave(at[0], at[1], at[2]); }
  /// By what the world's axes are in grid coordinates.
  Place gradient(const std::array<int, 3>& at) const {
    Place slope;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      std::array<int, 3> below = at, above = at;
      below[axis] = std::max(at[axis] - 1, 0);
      above[axis] = std::min(at[axis] + 1, n_ - 1);
      slope[a] = (value(above) - value(below)) / (above[axis] - below[axis]);
    }
    Place result;
    for (int a = 0; a < 3; ++a) {
      Place step;
      step[a] = 1;
      result[a] = dot(slope, volume_.grid_from_world().vector(step));
    }
    return result;
  }

  static constexpr int n_ = 7;
  const Volume& volume_;
};

/// Everything at once in curved data, against a sum of small steps.
TEST(ReferenceLight, IsTheLimitOfSmallSteps) {
  Volume::Description description = grid_description({7, 7, 7}, {-1, 0, 0.5}, {1, 0.7, 1.2});
  description.placement.direction = {{{0.9, 0.3, 0}, {-0.2, 1, 0.1}, {0.1, 0.2, 1}}};
  const auto volume = make_volume<double>(description, wave);
  const Naive data(*volume);
  Layer layer = layer_of(volume, {{-1, 0.1, {1, 0, 0}}, {0.5, 0.3, {1, 1, 0}}, {2, 1, {0, 1, 1}}});
  const Shading shading{0.1, 0.6, 0.5, 6, GradientKind::smooth, 0.1};
  layer.shading = shading;
  layer.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0.2, 0.1}, {0.9, 1}, {1.3, 0.4}});
  const std::vector<Light> lights{{HeadLight{}, {0.3, 0.5, 0.2}},
                                  {DirectionalLight{{1, 0, -1}}, {0.2, 0.1, 0.9}},
                                  {PointLight{{2, 3, 2}}, {0.7, 0.6, 0.5}}};
  const Scene scene = of({layer}, lights);
  const double flat = flat_gradient(layer);
  const Place centre = volume->world_from_grid().point({3.1, 2.9, 3.2});
  for (const Place& along : {Place{1, 0.2, 0.3}, {-0.3, 1, 0.2}, {0.5, -0.4, 1}, {-1, -1, 1}}) {
    const Place v = unit(along);
    const Place from = centre - v * 20;
    // In grid coordinates the box is [0, 6]³.
    const Place p = volume->grid_from_world().point(from), w = volume->grid_from_world().vector(v);
    double begin = 0, end = 100;
    for (int a = 0; a < 3; ++a) {
      begin = std::max(begin, std::min((0 - p[a]) / w[a], (6 - p[a]) / w[a]));
      end = std::min(end, std::max((0 - p[a]) / w[a], (6 - p[a]) / w[a]));
    }
    constexpr int steps = 100000;
    const double h = (end - begin) / steps;
    double depth = 0;
    Rgb<double> radiance;
    for (int i = 0; i < steps; ++i) {
      const Place x = from + v * (begin + (i + 0.5) * h);
      const Naive::Sample s = data(x);
      const double m = s.magnitude, f = s.value;
      const double factor = m < 0.2   ? 0.1
                            : m < 0.9 ? 0.1 + (m - 0.2) / 0.7 * 0.9
                            : m < 1.3 ? 1 - (m - 0.9) / 0.4 * 0.6
                                      : 0.4;
      const double low = std::clamp((f + 1) / 1.5, 0.0, 1.0);
      const double high = std::clamp((f - 0.5) / 1.5, 0.0, 1.0);
      const double rate = factor * (0.1 + 0.2 * low + 0.7 * high) * h;
      const Rgb<double> color{1 - high, low, high};
      const Shade shade(shading, normal_of(s.gradient, flat), v * -1,
                        {{v * -1, lights[0].color},
                         {unit({-1, 0, 1}), lights[1].color},
                         {unit(Place{2, 3, 2} - x), lights[2].color}});
      radiance += shade(color) * (std::exp(-depth) * -std::expm1(-rate));
      depth += rate;
    }
    const ReferencePixel pixel = reference_ray(scene, from, v);
    ASSERT_GT(pixel.opacity, 0.3);
    EXPECT_NEAR(pixel.optical_depth, depth, 1e-7);
    expect_color(pixel.radiance, radiance, 1e-7);
  }
}

/// v = |x - c|² sampled on a grid has the smooth gradient 2 (x - c) inside. Past c at the distance
/// r the normal turns round within √(r² + g0²/4).
TEST(ReferenceLight, NormalsTurnAroundACentre) {
  const Place centre{6.13, 5.9, 6.21};
  const auto volume = make_volume<double>(grid_description({13, 13, 13}), [&](int i, int j, int k) {
    const Place p = Place{1.0 * i, 1.0 * j, 1.0 * k} - centre;
    return dot(p, p);
  });
  const double range = volume->statistics().maximum - volume->statistics().minimum;
  constexpr double extinction = 0.3;
  Layer layer = layer_of(volume, {{0, extinction, {1, 0.5, 0}}});
  const auto expect_pixel = [&](const Place& v, double r, const Shading& shading) {
    layer.shading = shading;
    // 3 from the centre to either side.
    layer.clips = {{ClipPlane{centre - v * 3, v}}, {ClipPlane{centre + v * 3, v * -1}}};
    const Place aside = unit(cross(v, {0.3, 0.5, 0.7}));
    const ReferencePixel pixel = reference_ray(of({layer}), centre + aside * r - v * 20, v);
    const double flat = *shading.flatness * range;
    const double width = std::sqrt(r * r + flat * flat / 4);
    // The integral over s = width · sinh y, or s itself where the cosine is 1.
    const double far = width > 0 ? std::asinh(3 / width) : 3;
    const auto integral_of = [&](auto&& light) {
      double sum = 0;
      for (const double side : {-1.0, 1.0}) {
        sum += integral(0, far, 8000, [&](double y) {
          const double s = width > 0 ? width * std::sinh(y) : y;
          const double ds = width > 0 ? width * std::cosh(y) : 1;
          const double cosine = width > 0 ? s / std::hypot(s, width) : 1.0;
          return ds * extinction * std::exp(-extinction * (side * s + 3)) * light(cosine);
        });
      }
      return sum;
    };
    const double by =
        integral_of([&](double cosine) { return shading.ambient + shading.diffuse * cosine; });
    const double added = integral_of(
        [&](double cosine) { return shading.specular * std::pow(cosine, shading.power); });
    EXPECT_NEAR(pixel.optical_depth, 6 * extinction, 1e-12);
    expect_color(pixel.radiance, {by + added, 0.5 * by + added, added}, 1e-10);
  };
  for (const Place& along : {Place{0, 0, 1}, {0.6, 0.8, 0}, {2, -1, 1.3}}) {
    for (const double r : {1.0, 0.3, 1e-2, 1e-4, 1e-7, 0.0}) {
      for (const double flatness : {0.02, 1e-5, 0.0}) {
        for (const double power : {1.0, 40.0, 900.0}) {
          expect_pixel(unit(along), r, {0.1, 0.7, 0.4, power, GradientKind::smooth, flatness});
        }
        expect_pixel(unit(along), r, {0, 0, 1, 20, GradientKind::smooth, flatness});
      }
    }
  }
}

/// Noise in every kind of light: a layer is the sum of slabs of it, however the parts of the rays
/// come to lie.
TEST(ReferenceLight, ALayerIsTheSumOfItsSlabs) {
  std::mt19937 random(11);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  double largest = 0;
  int seen = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Volume::Description description = grid_description({6, 6, 6});
    description.centering = trial % 2 == 0 ? Centering::point : Centering::cell;
    const auto volume = make_volume<std::int8_t>(
        description, [&](int, int, int) { return std::floor(uniform(-4, 9)); });
    Layer layer = layer_of(volume, {{-3, 0, {1, 0, 0}}, {2, 1, {0, 1, 0}}, {7, 0.5, {0, 0, 1}}});
    const double powers[] = {1, 2, 7.5, 50, 1000};
    layer.shading = Shading{uniform(0, 1),
                            trial % 3 == 0 ? 0 : uniform(0, 1),
                            uniform(0, 1),
                            powers[trial % 5],
                            trial % 7 < 5 ? GradientKind::smooth : GradientKind::field,
                            trial % 4 == 0 ? 0 : uniform(0, 0.05)};
    if (trial % 3 == 1) {
      layer.gradient_opacity = std::make_shared<const GradientOpacity>(
          std::vector<GradientOpacity::Point>{{1, 0.1}, {4, 1}, {6, 0.3}});
    }
    layer.isosurfaces = {{1.5, 0.3, {1, 1, 1}}};
    const std::vector<Light> lights{
        {HeadLight{}, {1, 0.5, 0}},
        {DirectionalLight{{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}}, {0, 0.5, 0}},
        {PointLight{{uniform(0, 5), uniform(0, 5), uniform(0, 5)}}, {0, 0, 1}}};
    const Place normal = unit({uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)});
    std::vector<Layer> slabs;
    for (double height = -9.1; height < 9.1; height += 0.37) {
      Layer slab = layer;
      slab.clips = {{ClipPlane{normal * height, normal}},
                    {ClipPlane{normal * (height + 0.37), normal}, false}};
      slabs.push_back(slab);
    }
    const Place from{uniform(-9, 9), uniform(-9, 9), -7};
    const Place v = unit(Place{uniform(1, 4), uniform(1, 4), uniform(1, 4)} - from);
    const ReferencePixel whole = reference_ray(of({layer}, lights), from, v);
    const ReferencePixel parts = reference_ray(of(slabs, lights), from, v);
    seen += whole.opacity > 0.5 ? 1 : 0;
    EXPECT_NEAR(whole.optical_depth, parts.optical_depth, 1e-11) << trial;
    largest = std::max({largest, std::abs(whole.radiance.r - parts.radiance.r),
                        std::abs(whole.radiance.g - parts.radiance.g),
                        std::abs(whole.radiance.b - parts.radiance.b)});
  }
  std::printf("[ accuracy ] lit noise, whole and in slabs: %.1e apart\n", largest);
  EXPECT_GT(seen, 30);
  EXPECT_LT(largest, 1e-11);
}

/// Light along a normal to the ray: a narrow highlight where the normal passes half-way.
TEST(ReferenceLight, HighlightsAreNarrow) {
  const Place centre{6.13, 5.9, 6.21}, v{0, 0, 1}, aside{0.6, 0.8, 0};
  const auto volume = make_volume<double>(grid_description({13, 13, 13}), [&](int i, int j, int k) {
    const Place p = Place{1.0 * i, 1.0 * j, 1.0 * k} - centre;
    return dot(p, p);
  });
  constexpr double extinction = 0.3;
  Layer layer = layer_of(volume, {{0, extinction, {1, 1, 1}}});
  layer.clips = {{ClipPlane{centre - v * 3, v}}, {ClipPlane{centre + v * 3, v * -1}}};
  for (const double r : {1.7, 1.3, 1.0, 0.8, 0.6, 0.5, 0.1, 1e-3}) {
    for (const double power : {60.0, 1000.0}) {
      layer.shading = Shading{0, 0, 1, power, GradientKind::smooth, 0};
      const ReferencePixel pixel = reference_ray(
          of({layer}, {{DirectionalLight{aside * -1}, {1, 1, 1}}}), centre + aside * r - v * 20, v);
      // With s = r sinh y; n·h = (r - s) / √(2 (r² + s²)).
      const double far = std::asinh(3 / r);
      const double truth = integral(-far, far, 40000, [&](double y) {
        const double s = r * std::sinh(y),
                     cosine = std::abs(r - s) / std::hypot(r, s) / std::sqrt(2);
        return r * std::cosh(y) * extinction * std::exp(-extinction * (s + 3)) *
               std::pow(cosine, power);
      });
      EXPECT_NEAR(pixel.radiance.g, truth, 1e-11);
    }
  }
}

/// The normal is constant, the direction of the light turns; n·l changes its sign where the ray
/// passes the light's height.
TEST(ReferenceLight, PointsShineFromAPosition) {
  const auto volume = make_volume<double>(grid_description({9, 9, 9}),
                                          [](int i, int, int k) { return 0.6 * i + 0.8 * k; });
  constexpr double extinction = 0.25;
  for (const double power : {1.0, 3.5, 30.0}) {
    const Shading shading{0.05, 0.7, 0.6, power, GradientKind::smooth, 0};
    const Layer layer = lit(layer_of(volume, {{0, extinction, {1, 1, 1}}}), shading);
    const Place n{0.6, 0, 0.8}, v{0, 0, -1};
    for (const Place& lamp :
         {Place{2, 3, 5}, {4.5, 4, -7}, {4.25, 4.01, 3}, {4, 4.0, 30}, {9, 4, 6.3995}}) {
      const Place from{4.2, 4, -5};
      const ReferencePixel pixel =
          reference_ray(of({layer}, {{PointLight{lamp}, {0.5, 1, 2}}}), from, {0, 0, 1});
      const auto source = [&](double z) {
        const Place l = unit(lamp - Place{from.x, from.y, z}), both = l + v;
        const double diffuse = std::abs(dot(n, l)), half = std::abs(dot(n, unit(both)));
        return extinction * std::exp(-extinction * z) *
               (0.7 * diffuse + 0.6 * std::pow(half, power));
      };
      // Kinks: n·l = 0, and n·h = 0 by bisection; none of them, and it is only a cut.
      std::vector<double> cuts{0, 8, lamp.z};
      cuts.push_back(lamp.z + 0.75 * (lamp.x - from.x));
      const auto half = [&](double z) { return dot(n, unit(lamp - Place{from.x, from.y, z}) + v); };
      for (double a = 0; a < 8; a += 1.0 / 64) {
        double low = a, high = a + 1.0 / 64;
        if (half(low) * half(high) > 0) continue;
        for (int i = 0; i < 60; ++i) {
          const double middle = (low + high) / 2;
          (half(low) * half(middle) <= 0 ? high : low) = middle;
        }
        cuts.push_back(low);
      }
      std::erase_if(cuts, [](double z) { return !(z >= 0 && z <= 8); });
      std::sort(cuts.begin(), cuts.end());
      const double truth = 0.05 * pixel.opacity;
      double lamps = 0;
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double a = cuts[i], b = cuts[i + 1];
        if (!(b - a > 1e-14)) continue;
        lamps += integral(a, b, 40000, source);
      }
      EXPECT_NEAR(pixel.opacity, 1 - std::exp(-8 * extinction), 1e-13);
      expect_color(pixel.radiance, {truth + 0.5 * lamps, truth + lamps, truth + 2 * lamps}, 1e-10);
    }
  }
}

/// h is undefined where the light comes from behind the data straight to the eye.
TEST(ReferenceLight, LightFromStraightBehindHasNoHighlight) {
  const Ramp ramp{grid_description({4, 4, 4}), {0.1, 0.2, 0.9}};
  const Shading shading{0, 0.5, 9, 2, GradientKind::smooth, 0};
  const Layer layer = lit(layer_of(ramp.volume(), {{0, 0.5, {1, 1, 1}}}), shading);
  for (int i = 0; i < 30; ++i) {
    const Place v = unit({0.01 * i, 0.2, 0.97});
    const ReferencePixel pixel = reference_ray(of({layer}, {{DirectionalLight{v * -3}, {1, 1, 1}}}),
                                               Place{1.4, 1.3, 1.2} - v * 9, v);
    EXPECT_NEAR(pixel.radiance.r, pixel.opacity * 0.5 * dot(v, unit(ramp.gradient)), 1e-12);
  }
}

/// v = i² has the slopes 1, 2, 4, …, 2i, …, 10, 11 at i = 0 … 6.
TEST(ReferenceLight, GradientOpacityIsAProductOfTables) {
  for (const double spacing : {1.0, 0.5}) {
    const auto volume =
        make_volume<float>(grid_description({7, 3, 3}, {0, 0, 0}, {spacing, spacing, spacing}),
                           [](int i, int, int) { return i * i; });
    Layer layer = layer_of(volume, {{0, 0, {1, 0, 0}}, {36, 1.8, {0, 1, 0}}});
    layer.gradient_opacity = std::make_shared<const GradientOpacity>(
        std::vector<GradientOpacity::Point>{{1, 0.2}, {4, 1}, {9, 0.5}},
        GradientOpacity::Unit::voxel);
    const auto slope = [](int i) { return i == 0 ? 1.0 : i == 6 ? 11.0 : 2.0 * i; };
    const auto at = [&](double x, auto&& f) {
      const int i = std::min(static_cast<int>(x), 5);
      return f(i) + (x - i) * (f(i + 1) - f(i));
    };
    const auto value = [&](double x) { return at(x, [](int i) { return 1.0 * i * i; }); };
    const auto factor = [&](double x) {
      const double m = at(x, slope);
      return m < 4 ? 0.2 + (m - 1) * 0.8 / 3 : m < 9 ? 1 - (m - 4) * 0.1 : 0.5;
    };
    const auto rate = [&](double x) { return spacing * 1.8 * value(x) / 36 * factor(x); };
    double depth = 0, red = 0;
    const std::vector<double> cuts{0, 1, 2, 3, 4, 4.5, 5, 6};
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double a = cuts[i], b = cuts[i + 1], before = depth;
      // Cubic depth: Simpson's rule is exact.
      red += integral(a, b, 400, [&](double x) {
        // Rates at b belong to this part, as the functions are continuous.
        return rate(x) * (1 - value(x) / 36) *
               std::exp(-before - (x > a ? integral(a, x, 2, rate) : 0.0));
      });
      depth += integral(a, b, 2, rate);
    }
    const ReferencePixel pixel =
        reference_ray(of({layer}), {-1, 0.7 * spacing, 1.1 * spacing}, {1, 0, 0});
    EXPECT_NEAR(pixel.optical_depth, depth, 1e-13);
    EXPECT_NEAR(pixel.radiance.r, red, 1e-11);
    EXPECT_NEAR(pixel.radiance.g, pixel.opacity - red, 1e-11);
    const ReferencePixel back =
        reference_ray(of({layer}), {9, 0.7 * spacing, 1.1 * spacing}, {-1, 0, 0});
    EXPECT_NEAR(back.optical_depth, depth, 1e-13);
  }
}

/// Along x: the first variable is 2x - 5, the second rises and falls, the third is squared.
TEST(ReferenceLight, AFactorOfAChannelIsAProductOfTables) {
  const std::vector<double> second{-3, 1, 2, -1, 4, 4, -2};
  const auto grid = grid_description({7, 3, 3});
  const Channels channels = test::make_channels(
      grid, {[](int i, int, int) { return 2.0 * i - 5; },
             [&](int i, int, int) { return second[static_cast<std::size_t>(i)]; },
             [](int i, int, int) { return 1.0 * i * i; }});
  const auto shown = [&](std::vector<ChannelTransferFunction> tables) {
    Layer layer;
    layer.content = ChannelsContent{
        std::make_shared<const Channels>(channels),
        std::make_shared<const MultivariateTransferFunction>(
            3, std::vector<GaussianPrimitive>(), std::move(tables),
            ChannelTransferFunction{
                1, TransferFunction({{-2, 0.1, {}}, {0, 0.9, {}}, {0, 0.3, {}}, {3, 1.4, {}}})})};
    return layer;
  };
  const auto linear = [](double x, auto&& f) {
    const int i = std::clamp(static_cast<int>(x), 0, 5);
    return f(i) + (x - i) * (f(i + 1) - f(i));
  };
  const auto w = [&](double x) {
    return linear(x, [&](int i) { return second[static_cast<std::size_t>(i)]; });
  };
  const auto factor = [&](double x) {
    const double v = w(x);
    return v < -2 ? 0.1 : v < 0 ? 0.9 + v * 0.4 : v < 3 ? 0.3 + v * 1.1 / 3 : 1.4;
  };
  const auto first = [](double x) { return 2 * x - 5; };
  const auto third = [&](double x) { return linear(x, [](int i) { return 1.0 * i * i; }); };
  // Colors by the first variable: clear below -3.
  const auto share = [&](double x) { return std::clamp((first(x) + 3) / 8, 0.0, 1.0); };
  // Where a function has a corner or a jump.
  std::vector<double> cuts{0,   0.25, 0.75, 1, 2,           2 + 2.0 / 3, 3,
                           3.2, 3.8,  4,    5, 5 + 1.0 / 6, 5 + 4.0 / 6, 6};
  const auto truth_of = [&](auto&& rate, auto&& red) {
    double depth = 0, radiance = 0;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double a = cuts[i], b = cuts[i + 1], before = depth, inside = 1e-9 * (b - a);
      const auto at = [&](double x) { return rate(std::clamp(x, a + inside, b - inside)); };
      radiance += integral(a, b, 200, [&](double x) {
        return at(x) * red(x) * std::exp(-before - (x > a ? integral(a, x, 4, at) : 0.0));
      });
      depth += integral(a, b, 4, at);
    }
    return std::pair{depth, radiance};
  };
  const auto check = [](const Layer& layer, double depth, double red) {
    const ReferencePixel pixel = reference_ray(of({layer}), {-1, 0.7, 1.1}, {1, 0, 0});
    EXPECT_NEAR(pixel.optical_depth, depth, 1e-8);
    EXPECT_NEAR(pixel.radiance.r, red, 1e-8);
    EXPECT_NEAR(reference_ray(of({layer}), {9, 0.7, 1.1}, {-1, 0, 0}).optical_depth, depth, 1e-8);
  };
  {
    const auto rate = [&](double x) { return factor(x) * 0.4 * share(x); };
    const auto [depth, red] = truth_of(rate, [&](double x) { return 1 - 0.5 * share(x); });
    check(shown({{0, TransferFunction({{-3, 0, {1, 0, 0}}, {5, 0.4, {0.5, 1, 0}}})}}), depth, red);
  }
  {
    // Red by the first variable, green by the third: all terms together are one kind of particles.
    const auto rate = [&](double x) { return factor(x) * 0.6; };
    const auto [depth, red] = truth_of(rate, share);
    const Layer layer = shown({{0, TransferFunction({{-3, 0.3, {}}, {5, 0.3, {2, 0, 0}}})},
                               {2, TransferFunction({{0, 0.3, {}}, {36, 0.3, {0, 2, 0}}})}});
    check(layer, depth, red);
    const auto green = truth_of(rate, [&](double x) { return third(x) / 36; }).second;
    EXPECT_NEAR(reference_ray(of({layer}), {-1, 0.7, 1.1}, {1, 0, 0}).radiance.g, green, 1e-8);
  }
}

/// Extinction = magnitude: the optical depth is the integral of a piecewise linear magnitude.
double integral_of_magnitude(const scenes::VolumePointer& volume, Place from, Place direction) {
  Layer layer = layer_of(volume, {{0, 1, {1, 1, 1}}});
  layer.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0, 0}, {1000, 1}});
  return 1000 * reference_ray(of({layer}), from, direction).optical_depth;
}

TEST(ReferenceLight, SlopesAreThoseOfParabolas) {
  Volume::Description description = grid_description({5, 2, 2});
  const std::vector<double> x{0, 0.5, 2, 3, 7};
  description.coordinates[0] = x;
  const auto square = [](double s) { return s * s; };
  const auto points = make_volume<double>(
      description, [&](int i, int, int) { return square(x[static_cast<std::size_t>(i)]); });
  // One-sided at the ends: 0.5 and 10; 2x between.
  const double truth =
      0.5 * (0.5 + 1) / 2 + 1.5 * (1 + 4) / 2 + 1 * (4 + 6) / 2.0 + 4 * (6 + 10) / 2.0;
  EXPECT_NEAR(integral_of_magnitude(points, {-1, 0.3, 0.4}, {1, 0, 0}), truth, 1e-12);

  // Cells with the centres 0.25, 1.25, 2.5, 5: half cells repeat the slope of the border's value.
  description.dimensions = {4, 2, 2};
  description.centering = Centering::cell;
  const std::vector<double> centre{0.25, 1.25, 2.5, 5};
  const auto cells = make_volume<double>(
      description, [&](int i, int, int) { return square(centre[static_cast<std::size_t>(i)]); });
  const double cell_truth =
      0.25 * 1.5 + 1 * (1.5 + 2.5) / 2 + 1.25 * (2.5 + 5) / 2 + 2.5 * (5 + 7.5) / 2 + 2 * 7.5;
  EXPECT_NEAR(integral_of_magnitude(cells, {-1, 0.3, 0.4}, {1, 0, 0}), cell_truth, 1e-12);
}

TEST(ReferenceLight, SlopesNextToVacuumAreOneSided) {
  const auto volume = make_volume<float>(
      grid_description({7, 3, 3}), [](int i, int, int) { return i == 3 ? nan : 1.0 * i * i; });
  // 1, 2, 3 and 9, 10, 11.
  EXPECT_NEAR(integral_of_magnitude(volume, {-1, 0.4, 1.3}, {1, 0, 0}), 1.5 + 2.5 + 9.5 + 10.5,
              1e-12);
}

/// A value without neighbours along an axis: one cell-centred value.
TEST(ReferenceLight, OneValueHasNoSlope) {
  Volume::Description description = grid_description({3, 1, 1});
  description.centering = Centering::cell;
  const auto volume = make_volume<float>(description, [](int i, int, int) { return 3 * i; });
  EXPECT_NEAR(integral_of_magnitude(volume, {-2, 0.1, 0.2}, {1, 0, 0}), 3 * 3, 1e-12);
}

/// In the outer half cells of cell-centred data the field is constant across.
TEST(ReferenceLight, TheFieldIsFlatInOuterHalfCells) {
  Volume::Description description = grid_description({4, 3, 3});
  description.centering = Centering::cell;
  const auto volume = make_volume<float>(description, [](int i, int, int) { return 2 * i; });
  Layer layer =
      lit(layer_of(volume, {{0, 0.5, {1, 1, 1}}}), {0.25, 0.5, 0, 1, GradientKind::field, 0});
  const ReferencePixel field = reference_ray(of({layer}), {-2, 0.4, 1.2}, {1, 0, 0});
  const double a = std::exp(-0.25), b = std::exp(-1.75), c = std::exp(-2.0);
  EXPECT_NEAR(field.radiance.r, 0.25 * (1 - a) + 0.75 * (a - b) + 0.25 * (b - c), 1e-13);
  layer.shading->gradient = GradientKind::smooth;
  EXPECT_NEAR(reference_ray(of({layer}), {-2, 0.4, 1.2}, {1, 0, 0}).radiance.r, 0.75 * (1 - c),
              1e-13);
}

/// f = x y z in one cell, `field`: the gradient is (yz, xz, xy), along the diagonal s² (1, 1, 1).
/// `smooth` is one-sided, the same at corners, and linear between: the same.
TEST(ReferenceLight, TheFieldsGradientInACell) {
  const auto volume = make_volume<float>(grid_description({2, 2, 2}),
                                         [](int i, int j, int k) { return i * j * k; });
  // Diffuse light from straight above: n·l = s² / √(3 s⁴ + g0²), with g0 = 1/2.
  const std::vector<Light> lights{{DirectionalLight{{0, 0, -1}}, {1, 1, 1}}};
  for (const GradientKind kind : {GradientKind::smooth, GradientKind::field}) {
    const Layer layer = lit(layer_of(volume, {{0, 0.4, {1, 1, 1}}}), {0, 1, 0, 1, kind, 0.5});
    const double root = std::sqrt(3.0);
    const double truth = integral(0, 1, 4000, [&](double s) {
      return 0.4 * root * std::exp(-0.4 * root * s) * s * s / std::sqrt(3 * s * s * s * s + 0.25);
    });
    const ReferencePixel pixel = reference_ray(of({layer}, lights), {-1, -1, -1}, {1, 1, 1});
    EXPECT_NEAR(pixel.radiance.g, truth, 1e-12);
  }
  // Beside each other the two differ: of 0, 1, 4 the field has slopes 1 and 3.
  const auto steps =
      make_volume<float>(grid_description({3, 2, 2}), [](int i, int, int) { return i * i; });
  const Layer layer =
      lit(layer_of(steps, {{0, 0.7, {1, 1, 1}}}), {0, 1, 0, 1, GradientKind::field, 0.5});
  const double flat = 0.5 * 4;
  const double first = 1 / std::hypot(1, flat), second = 3 / std::hypot(3, flat);
  const ReferencePixel pixel = reference_ray(of({layer}), {-1, 0.5, 0.5}, {1, 0, 0});
  const double one = std::exp(-0.7);
  EXPECT_NEAR(pixel.radiance.r, first * (1 - one) + second * (one - one * one), 1e-12);
}

TEST(ReferenceLight, TransformsChangeTheGradient) {
  const Ramp ramp{grid_description({4, 4, 4}), {0, 0, 2}};
  Layer layer = lit(layer_of(ramp.volume(), {{0, 0.2, {1, 1, 1}}}), {0, 1, 0, 1, {}, 0.5});
  layer.transform.matrix = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 4}}};
  // Along z half a unit per length; edges 1, 1 and 4; data 0 … 6.
  const double flat = 0.5 * 6 / 2;
  const ReferencePixel pixel = reference_ray(of({layer}), {1.2, 1.3, -2}, {0, 0, 1});
  EXPECT_NEAR(pixel.optical_depth, 0.2 * 12, 1e-13);
  EXPECT_NEAR(pixel.radiance.r, pixel.opacity * 0.5 / std::hypot(0.5, flat), 1e-12);
  // Sheared by x += z, planes of equal values stay; the normal leaves the ray's side less.
  layer.transform.matrix = {{{1, 0, 0}, {0, 1, 0}, {1, 0, 1}}};
  layer.shading->flatness = 0;
  EXPECT_NEAR(reference_ray(of({layer}), {0, 1.3, -2}, {1, 0, 1}).radiance.r,
              (1 - std::exp(-0.2 * 3 * std::sqrt(2.0))) * std::sqrt(0.5), 1e-12);
}

TEST(ReferenceLight, OverlapIsASumOfSources) {
  const Ramp ramp{grid_description({5, 5, 5}), {0.3, 0, 0.4}};
  const Shading shading{0.1, 0.6, 0.3, 3, GradientKind::smooth, 0};
  const Layer first = lit(layer_of(ramp.volume(), {{0, 0.3, {1, 0, 0.5}}}), shading);
  const Layer second = layer_of(ramp.volume(), {{0, 0.5, {0, 1, 0.5}}});
  const double cosine = 0.8, factor = 0.1 + 0.6 * cosine, added = 0.3 * cosine * cosine * cosine;
  for (const Scene& scene : {of({first, second}), of({second, first})}) {
    const ReferencePixel pixel = reference_ray(scene, {1.1, 2.3, -4}, {0, 0, 1});
    EXPECT_NEAR(pixel.optical_depth, 3.2, 1e-13);
    const double a = pixel.opacity / 0.8;
    expect_color(pixel.radiance,
                 {a * 0.3 * (factor + added), a * (0.5 + 0.3 * added),
                  a * (0.5 * 0.5 + 0.3 * (0.5 * factor + added))},
                 1e-12);
  }
}

/// Gaussians and tables in the light of a channel that rises evenly, thinned by its slope.
TEST(ReferenceLight, SeveralVariables) {
  const auto wave = [](int i, int j, int k) { return std::sin(0.8 * i + 0.5 * j) + 0.2 * k; };
  const auto ramp = [](int i, int j, int k) { return 0.5 * i - 0.25 * j + k; };
  const auto channels = std::make_shared<const Channels>(
      test::make_channels(grid_description({6, 6, 6}), {wave, ramp}));
  const auto function = [](double scale) {
    GaussianPrimitive narrow = test::make_gaussian({0.5, 2.5}, {5e-4, 4}, 240 * scale, {1, 0.4, 0});
    return std::make_shared<const MultivariateTransferFunction>(
        2, std::vector<GaussianPrimitive>{narrow},
        std::vector<ChannelTransferFunction>{
            {0, TransferFunction({{0.2, 0, {0, 1, 0}}, {1.5, 0.6 * scale, {0, 0, 1}}})}});
  };
  Layer plain{ChannelsContent{channels, function(0.3)}};
  Layer layer{ChannelsContent{channels, function(1)}};
  layer.shading = Shading{0.2, 0.7, 0.4, 9, GradientKind::smooth, 0.05, 1};
  const double slope = std::sqrt(0.25 + 0.0625 + 1);
  layer.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0, 0}, {slope / 0.3, 1}}, GradientOpacity::Unit::world,
      1);
  const double flat = 0.05 * (7.5 + 1.25);
  for (int i = 0; i < 80; ++i) {
    const Place from{-2, 1.0 + 0.04 * i, 9}, v = unit({0.6, 0.01 * i - 0.3, -1});
    const ReferencePixel truth = reference_ray(of({plain}), from, v);
    const ReferencePixel pixel = reference_ray(of({layer}), from, v);
    const Shade shade(*layer.shading, normal_of({0.5, -0.25, 1}, flat), v * -1,
                      {{v * -1, {1, 1, 1}}});
    EXPECT_NEAR(pixel.optical_depth, truth.optical_depth, 1e-12);
    EXPECT_NEAR(pixel.radiance.r, shade.factor.r * truth.radiance.r + shade.added.r * truth.opacity,
                1e-11);
    EXPECT_NEAR(pixel.radiance.b, shade.factor.b * truth.radiance.b + shade.added.b * truth.opacity,
                1e-11);
  }
}

TEST(ReferenceLight, LinearDataOnAMeshHaveOneNormal) {
  const auto mesh = scenes::make_mesh(scenes::random_delaunay(60, 5));
  const Place g{0.5, -1, 0.75};
  const auto field = scenes::on_mesh(
      mesh, {scenes::at_points(*mesh, "ramp", [&](const Place& p) { return dot(g, p); })});
  const scenes::Points points{{-1, 0, {1, 0, 0}}, {1, 2, {0, 1, 1}}};
  const Layer plain{MeshContent{field, transfer(points)}};
  for (const GradientKind kind : {GradientKind::smooth, GradientKind::field}) {
    const Shading shading{0.1, 0.6, 0.5, 5, kind, 0.1};
    const Layer layer = lit(plain, shading);
    for (int i = 0; i < 8; ++i) {
      const Place from{3, 0.2 * i - 0.8, -2}, v = unit(Place{0.05 * i, 0.1, -0.1} - from);
      const ReferencePixel truth = reference_ray(of({plain}), from, v);
      const ReferencePixel pixel = reference_ray(of({layer}), from, v);
      const Shade shade(shading, normal_of(g, flat_gradient(layer)), v * -1, {{v * -1, {1, 1, 1}}});
      EXPECT_NEAR(pixel.opacity, truth.opacity, 1e-12);
      EXPECT_NEAR(pixel.radiance.r,
                  shade.factor.r * truth.radiance.r + shade.added.r * truth.opacity, 1e-11);
    }
  }
}

/// Two tetrahedra on a face, one twice as large: (0, 0, 1) and (0, 0, -3/2) in them.
TEST(ReferenceLight, PointsOfAMeshHaveTheMeanByVolume) {
  const auto mesh = scenes::make_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -2}},
                                       {{0, 1, 2, 3}, {0, 1, 2, 4}},
                                       "two"});
  const auto value = [](const Place& p) { return p.z > 0 ? p.z : -1.5 * p.z; };
  Layer layer{MeshContent{scenes::on_mesh(mesh, {scenes::at_points(*mesh, "v", value)}),
                          transfer({{0, 1, {1, 1, 1}}})}};
  layer.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0, 0}, {1000, 1}});
  // On the face |1/3 - 1| = 2/3; from there to 1 in front, to 3/2 behind, of which 3/5 are crossed.
  const double face = 2.0 / 3, top = face + 0.6 * (1 - face), bottom = face + 0.6 * (1.5 - face);
  const ReferencePixel pixel = reference_ray(of({layer}), {0.2, 0.2, -5}, {0, 0, 1});
  EXPECT_NEAR(1000 * pixel.optical_depth, 0.6 * (face + top) / 2 + 1.2 * (face + bottom) / 2,
              1e-12);

  // `field`: one normal in each, with opposite sides to a light from above.
  layer.gradient_opacity = nullptr;
  layer.shading = Shading{0, 1, 0, 1, GradientKind::field, 1};
  const double flat = flat_gradient(layer);
  const double front = 1.5 / std::hypot(1.5, flat), back = 1 / std::hypot(1, flat);
  const double a = std::exp(-1.2), b = std::exp(-1.8);
  EXPECT_NEAR(reference_ray(of({layer}), {0.2, 0.2, -5}, {0, 0, 1}).radiance.r,
              front * (1 - a) + back * (a - b), 1e-12);

  // Vacuum is left out: the face has the gradient of the upper one alone.
  Layer cut = layer;
  std::get<MeshContent>(cut.content).mesh = scenes::on_mesh(
      mesh, {scenes::at_points(*mesh, "v", [](const Place& p) { return p.z < 0 ? nan : p.z; })});
  cut.shading.reset();
  cut.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0, 0}, {1000, 1}});
  EXPECT_NEAR(1000 * reference_ray(of({cut}), {0.2, 0.2, -5}, {0, 0, 1}).optical_depth, 0.6, 1e-12);

  // Values per tetrahedron are flat.
  Layer flat_layer = layer;
  std::get<MeshContent>(flat_layer.content).mesh =
      scenes::on_mesh(mesh, {scenes::at_cells(*mesh, "v", [](const Place& p) { return p.z; })});
  flat_layer.shading = Shading{0.3, 1, 1, 1, GradientKind::smooth, 0.1};
  const ReferencePixel dark = reference_ray(of({flat_layer}), {0.2, 0.2, -5}, {0, 0, 1});
  EXPECT_NEAR(dark.radiance.r, 0.3 * dark.opacity, 1e-13);
}

TEST(ReferenceLight, LabelsAreNotLit) {
  const auto labels = std::make_shared<const LabelVolume>(
      make_volume<std::uint8_t>(grid_description({3, 3, 3}), [](int, int, int) { return 1; }));
  const auto table =
      std::make_shared<const LabelTable>(std::vector<LabelStyle>{{1, "one", {1, 0, 0}, 0.2}});
  const Layer layer = lit({LabelContent{labels, table}});
  EXPECT_THROW(reference_ray(of({layer}), {1, 1, -1}, {0, 0, 1}), Error);
}

}  // namespace
}  // namespace pellucid::test_light
