// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/analytic.h"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/scenes/makers.h"
#include "tests/support/one_layer.h"

namespace pellucid::scenes {
namespace {

using Description = Volume::Description;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// What a slab of constant extinction and color does.
void expect_slab(AnalyticRay& ray, double extinction, double thickness, Rgb<double> color,
                 double t_front) {
  ray.opacity = -std::expm1(-extinction * thickness);
  ray.radiance = color * ray.opacity;
  ray.half_opacity_depth =
      ray.opacity > 0 ? t_front - std::log1p(-0.5 * ray.opacity) / extinction : infinity;
}

/// Extinction k s over s in [0, D] with color (1, s/D, 1 − s/D): Moreland's rising case.
/// ∫ k s (s/D) exp(−k s²/2) ds = −exp(−kD²/2) + √(π/2k) erf(D √(k/2)) / D.
void expect_rising(AnalyticRay& ray, double k, double length, double t_front) {
  const double m = k * length * length / 2;
  ray.opacity = -std::expm1(-m);
  const double green =
      std::sqrt(std::numbers::pi / (2 * k)) * std::erf(std::sqrt(m)) / length - std::exp(-m);
  ray.radiance = {ray.opacity, green, ray.opacity - green};
  ray.half_opacity_depth = t_front + std::sqrt(-2 * std::log1p(-0.5 * ray.opacity) / k);
}

/// The same extinction walked from its high end: k (D − s), with color (1, 1 − s/D, s/D).
/// With r = D − s: ∫ k r (r/D) exp(−k(D² − r²)/2) dr = 1 − F/(D √(k/2)), F Dawson's integral of
/// D √(k/2), here by the series of exp(−x²) Σ x^(2n+1)/(n! (2n+1)), all terms positive.
void expect_falling(AnalyticRay& ray, double k, double length) {
  const double m = k * length * length / 2, x = std::sqrt(m);
  ray.opacity = -std::expm1(-m);
  long double sum = 0, power = static_cast<long double>(x);
  for (int n = 0; n < 400; ++n) {
    sum += power / (2 * n + 1);
    power *= static_cast<long double>(m) / (n + 1);
  }
  const double dawson = static_cast<double>(std::exp(-static_cast<long double>(m)) * sum);
  const double green = 1 - dawson / x;
  ray.radiance = {ray.opacity, green, ray.opacity - green};
}

/// Extinction k u³ (and color (1, u³, 0)) over u in [0, 1], length D: with a = kD u⁴/4,
/// ∫ u³ da e^{−a} = m^{−3/4} γ(7/4, m), m = kD/4.
void expect_cube(AnalyticRay& ray, double k, double length) {
  const double m = k * length / 4;
  ray.opacity = -std::expm1(-m);
  ray.radiance = {ray.opacity, std::pow(m, -0.75) * boost::math::tgamma_lower(1.75, m), 0};
}

Points constant(double extinction, Rgb<double> color) {
  return {{0, extinction, color}};
}

/// Extinction scale · v and color (1, v, 1 − v) over v in [0, 1].
Points ramp(double scale) {
  return {{0, 0, {1, 0, 1}}, {1, scale, {1, 1, 0}}};
}

void add_constant_fields(std::vector<AnalyticRay>& rays) {
  const Rgb<double> color{0.25, 0.5, 1};
  const auto one = [](int, int, int) { return 0.5; };

  // A sampler that drops the stretch behind its last sample loses most on the coarsest grid.
  AnalyticRay ray{"constant field on 8 x 8 x 8, along an axis",
                  make_volume<float>(
                      grid_description({8, 8, 8}, {-1, -1, -1}, {2.0 / 7, 2.0 / 7, 2.0 / 7}), one),
                  transfer(constant(0.75, color)),
                  {0.1, 0.2, 5},
                  {0, 0, -1},
                  {},
                  0,
                  0};
  expect_slab(ray, 0.75, 2, color, 4);
  rays.push_back(ray);

  ray.name = "constant field, along the other way of z, with -0 components";
  ray.origin = {0.1, 0.2, -3};
  ray.direction = {-0.0, -0.0, 1};
  expect_slab(ray, 0.75, 2, color, 2);
  rays.push_back(ray);

  ray.name = "constant field, along its body diagonal, through the edges of cells";
  ray.origin = {-2, -2, -2};
  ray.direction = {1, 1, 1};
  expect_slab(ray, 0.75, 2 * std::sqrt(3.0), color, std::sqrt(3.0));
  rays.push_back(ray);

  ray.name = "constant field, camera inside";
  ray.origin = {0.3, -0.2, 0.1};
  ray.direction = {0, 0, 1};
  expect_slab(ray, 0.75, 0.9, color, 0);
  rays.push_back(ray);

  ray.name = "constant field, camera inside, looking along (-2, -1, 2)/3";
  ray.direction = {-2.0 / 3, -1.0 / 3, 2.0 / 3};
  expect_slab(ray, 0.75, 0.9 * 1.5, color, 0);  // z = 1 comes before x = -1 and y = -1.
  rays.push_back(ray);

  ray.name = "constant field, along a plane of the grid";
  ray.origin = {-1 + 2.0 / 7 * 3, -1 + 2.0 / 7 * 2, 3};
  ray.direction = {0, 0, -1};
  expect_slab(ray, 0.75, 2, color, 2);
  rays.push_back(ray);

  ray.name = "the volume behind the eye";
  ray.origin = {0, 0, 1.5};
  ray.direction = {0, 0, 1};
  expect_slab(ray, 0.75, 0, color, 0);
  rays.push_back(ray);

  ray.name = "past the volume";
  ray.origin = {3, 0, 5};
  ray.direction = {0.1, 0.2, -1};
  rays.push_back(ray);

  ray.name = "constant field, very deep";
  ray.transfer_function = transfer(constant(1e6, color));
  ray.origin = {0.1, 0.2, 5};
  ray.direction = {0, 0, -1};
  expect_slab(ray, 1e6, 2, color, 4);
  rays.push_back(ray);

  ray.name = "constant field, very thin";
  ray.transfer_function = transfer(constant(1e-9, color));
  expect_slab(ray, 1e-9, 2, color, 4);
  rays.push_back(ray);

  ray.name = "constant field exactly at a jump: the right side holds";
  ray.transfer_function =
      transfer({{0, 5, {1, 1, 1}}, {0.5, 5, {1, 1, 1}}, {0.5, 0.75, color}, {1, 0.75, color}});
  expect_slab(ray, 0.75, 2, color, 4);
  rays.push_back(ray);
}

void add_ramps(std::vector<AnalyticRay>& rays) {
  const double k = 3;
  // x from 0 to 4 shows f from 0 to 1: the extinction is 3 x/4.
  const auto rising = [](int i, int, int) { return 0.25 * i; };
  AnalyticRay ray{"linear ramp, rising",
                  make_volume<double>(grid_description({5, 3, 4}), rising),
                  transfer(ramp(k)),
                  {-2, 0.7, 1.3},
                  {1, 0, 0},
                  {},
                  0,
                  0};
  expect_rising(ray, k / 4, 4, 2);
  rays.push_back(ray);

  ray.name = "linear ramp, falling";
  ray.origin = {9, 0.7, 1.3};
  ray.direction = {-1, 0, 0};
  expect_falling(ray, k / 4, 4);
  ray.half_opacity_depth = not_a_number;
  rays.push_back(ray);

  ray.name = "linear ramp, rising, thick";
  ray.transfer_function = transfer(ramp(400));
  ray.origin = {-2, 0.7, 1.3};
  ray.direction = {1, 0, 0};
  expect_rising(ray, 100, 4, 2);
  rays.push_back(ray);

  ray.name = "linear ramp, camera in its middle";
  ray.transfer_function = transfer({{0.5, 0, {1, 0, 1}}, {1, k, {1, 1, 0}}});
  ray.origin = {2, 0.5, 0.5};
  expect_rising(ray, k / 2, 2, 0);
  rays.push_back(ray);

  ray.name = "linear ramp, anisotropic spacing, obliquely";
  ray.volume =
      make_volume<double>(grid_description({5, 9, 9}, {10, -20, 30}, {0.5, 2, 0.25}), rising);
  ray.transfer_function = transfer(ramp(k));
  // From x = 10 to 12 with y = -18 + dy, z = 31 + dz: inside throughout.
  ray.direction = {2.0 / 3, 2.0 / 3, -1.0 / 3};
  ray.origin = Vec3<double>{10, -18, 31.5} - 4.0 * ray.direction;
  expect_rising(ray, k / 3, 3, 4);
  rays.push_back(ray);

  // The same ray in data and world turned together by an oblique rotation.
  ray.name = "linear ramp, oblique direction cosines";
  Description turned = grid_description({5, 9, 9}, {0, 0, 0}, {0.5, 2, 0.25});
  turned.placement.direction = {
      {{2.0 / 3, 2.0 / 3, -1.0 / 3}, {-1.0 / 3, 2.0 / 3, 2.0 / 3}, {2.0 / 3, -1.0 / 3, 2.0 / 3}}};
  const Mat3<double> rotation = turned.placement.direction;
  turned.placement.origin = rotation * Vec3<double>{10, -20, 30};
  ray.volume = make_volume<double>(turned, rising);
  ray.origin = rotation * ray.origin;
  ray.direction = rotation * ray.direction;
  rays.push_back(ray);

  ray.name = "linear ramp in a left-handed, sheared grid";
  Description sheared = grid_description({5, 3, 3}, {1, 2, 3}, {0.5, 1, 1});
  sheared.placement.direction = {{{-1, 0, 0}, {1, 1, 0}, {0, 0.5, 1}}};
  ray.volume = make_volume<double>(sheared, rising);
  // At index (i, 1, 1): x from 2 to 0, y = 3.5, z = 4.
  ray.origin = {5, 3.5, 4};
  ray.direction = {-1, 0, 0};
  expect_rising(ray, k / 2, 2, 3);
  rays.push_back(ray);

  ray.name = "linear ramp on a rectilinear axis";
  Description rectilinear = grid_description({5, 3, 4});
  rectilinear.coordinates[0] = {0, 0.125, 1.5, 3.75, 4};
  ray.volume = make_volume<float>(rectilinear, [&](int i, int, int) {
    return rectilinear.coordinates[0][static_cast<std::size_t>(i)] / 4;
  });
  ray.origin = {-2, 0.7, 1.3};
  ray.direction = {1, 0, 0};
  expect_rising(ray, k / 4, 4, 2);
  rays.push_back(ray);

  ray.name = "linear ramp, f(x) seen obliquely in a rectilinear grid of three axes";
  rectilinear.coordinates[1] = {-3, -1, 4};
  rectilinear.coordinates[2] = {0, 1, 1.5, 7};
  ray.volume = make_volume<float>(rectilinear, [&](int i, int, int) {
    return rectilinear.coordinates[0][static_cast<std::size_t>(i)] / 4;
  });
  ray.direction = {2.0 / 3, 1.0 / 3, 2.0 / 3};
  ray.origin = Vec3<double>{0, 0.5, 0.25} - 3.0 * ray.direction;
  expect_rising(ray, k / 6, 6, 3);
  rays.push_back(ray);
}

/// Cell-centred data: the outer half cells repeat the border value. With two values, 0 and 1, on an
/// axis: half a cell clear, one cell rising, half a cell constant.
void add_cell_centred(std::vector<AnalyticRay>& rays) {
  const double k = 3;
  const auto half = [&](AnalyticRay& ray, double rise, double end) {
    expect_rising(ray, k / rise, rise, 0);
    const double transparency = 1 - ray.opacity;
    AnalyticRay slab = ray;
    expect_slab(slab, k, end, {1, 1, 0}, 0);
    ray.radiance += transparency * slab.radiance;
    ray.opacity += transparency * slab.opacity;
    ray.half_opacity_depth = not_a_number;
  };
  Description d = grid_description({2, 3, 1}, {5, 0, 0}, {2, 1, 1});
  d.centering = Centering::cell;
  AnalyticRay ray{"cell-centred ramp",
                  make_volume<std::uint8_t>(d, [](int i, int, int) { return i; }),
                  transfer(ramp(k)),
                  {0, 1.2, 0.3},
                  {1, 0, 0},
                  {},
                  0,
                  0};
  half(ray, 2, 1);
  rays.push_back(ray);

  ray.name = "cell-centred ramp, near the border of the other axes";
  ray.origin = {0, 2.4, -0.49};
  rays.push_back(ray);

  ray.name = "cell-centred ramp on a rectilinear axis (faces given)";
  d.coordinates[0] = {5, 6, 9};  // Values at 5.5 and 7.5.
  ray.volume = make_volume<std::uint8_t>(d, [](int i, int, int) { return i; });
  ray.origin = {0, 1.2, 0.3};
  half(ray, 2, 1.5);
  rays.push_back(ray);
}

void add_curved(std::vector<AnalyticRay>& rays) {
  const double diagonal = std::sqrt(3.0);
  AnalyticRay ray{"f = xyz along the diagonal of a cell",
                  make_volume<float>(grid_description({2, 2, 2}),
                                     [](int i, int j, int k) { return i * j * k; }),
                  transfer({{0, 0, {1, 0, 0}}, {1, 6, {1, 1, 0}}}),
                  {-1, -1, -1},
                  {1, 1, 1},
                  {},
                  0,
                  not_a_number};
  expect_cube(ray, 6, diagonal);
  rays.push_back(ray);

  // A jump at v = 0.125 is a slab behind u = 1/2.
  ray.name = "a solid behind a jump in f = xyz";
  const Rgb<double> color{0.5, 1, 0.25};
  ray.transfer_function = transfer({{0.125, 0, color}, {0.125, 2, color}});
  expect_slab(ray, 2, diagonal / 2, color, diagonal * 1.5);
  rays.push_back(ray);

  // f = x (1 − y) is a saddle; along x = y = u it is u − u², above 3/16 between u = 1/4 and 3/4.
  ray.name = "a bilinear saddle that rises over a jump and falls below it again";
  ray.volume = make_volume<float>(grid_description({2, 2, 2}),
                                  [](int i, int j, int) { return i * (1 - j); });
  ray.transfer_function = transfer({{0.1875, 0, color}, {0.1875, 2, color}});
  ray.origin = {-1, -1, 0.5};
  ray.direction = {1, 1, 0};
  expect_slab(ray, 2, std::sqrt(0.5), color, 1.25 * std::sqrt(2.0));
  rays.push_back(ray);

  // Color linear in f, extinction constant: ∫ (u − u²) x e^{−xu} du with x = extinction · length.
  ray.name = "a bilinear saddle as color in a constant extinction";
  const double x = 1.5 * std::sqrt(2.0);
  ray.transfer_function = transfer({{0, 1.5, {1, 0, 0}}, {1, 1.5, {1, 1, 0}}});
  ray.opacity = -std::expm1(-x);
  ray.radiance = {ray.opacity, ((x - 2) + (x + 2) * std::exp(-x)) / (x * x), 0};
  ray.half_opacity_depth = std::sqrt(2.0) - std::log1p(-0.5 * ray.opacity) / 1.5;
  rays.push_back(ray);

  // A triangle of height 4 over one cell: its depth is its area, whatever the ray.
  ray.name = "a peak between two planes, depth by area";
  ray.volume = make_volume<std::int16_t>(grid_description({9, 4, 4}),
                                         [](int i, int, int) { return 100 * i - 400; });
  ray.transfer_function = transfer({{-50, 0, color}, {0, 4, color}, {50, 0, color}});
  ray.origin = {-3, 1.5, 1.25};
  ray.direction = {1, 0, 0};
  ray.opacity = -std::expm1(-2.0);
  ray.radiance = color * ray.opacity;
  ray.half_opacity_depth = not_a_number;
  rays.push_back(ray);

  // No sampler at any usual step sees it, nor does the data value at any corner.
  ray.name = "a needle that is 1/800 of a cell wide";
  ray.transfer_function =
      transfer({{50 - 0x1p-4, 0, color}, {50, 1600, color}, {50 + 0x1p-4, 0, color}});
  ray.opacity = -std::expm1(-1.0);
  ray.radiance = color * ray.opacity;
  rays.push_back(ray);
}

/// A ball of constant extinction: x² + y² + z² < 9 behind a jump. Trilinear interpolation of a sum
/// of functions of one coordinate each is the sum of their interpolations, so that along an edge of
/// the grid the ray meets the true sphere where a grid point lies on it: 9 = 3² = 2² + 2² + 1².
void add_sphere(std::vector<AnalyticRay>& rays) {
  const Rgb<double> color{0.25, 1, 0.5};
  AnalyticRay ray{"",
                  make_volume<std::int32_t>(grid_description({11, 11, 11}, {-5, -5, -5}),
                                            [](int i, int j, int k) {
                                              const int x = i - 5, y = j - 5, z = k - 5;
                                              return x * x + y * y + z * z;
                                            }),
                  transfer({{9, 0.4, color}, {9, 0, color}}),
                  {},
                  {},
                  {},
                  0,
                  0};
  ray.name = "a sphere through its centre";
  ray.origin = {-7, 0, 0};
  ray.direction = {1, 0, 0};
  expect_slab(ray, 0.4, 6, color, 4);
  rays.push_back(ray);

  ray.name = "a sphere off its centre";
  ray.origin = {2, 8, -1};
  ray.direction = {0, -1, 0};
  expect_slab(ray, 0.4, 4, color, 6);
  rays.push_back(ray);

  ray.name = "a sphere near its rim";
  ray.origin = {-2, 2, -6};
  ray.direction = {0, 0, 1};
  expect_slab(ray, 0.4, 2, color, 5);
  rays.push_back(ray);

  ray.name = "a sphere from within";
  ray.origin = {0.5, 2, 1};
  ray.direction = {1, 0, 0};
  expect_slab(ray, 0.4, 1.5, color, 0);
  rays.push_back(ray);

  ray.name = "past a sphere";
  ray.origin = {-7, 3, 1};
  expect_slab(ray, 0.4, 0, color, 0);
  rays.push_back(ray);
}

void add_vacuum(std::vector<AnalyticRay>& rays) {
  const Rgb<double> color{0.25, 0.5, 1};
  AnalyticRay ray{"a NaN makes the cells around it vacuum",
                  make_volume<float>(grid_description({9, 5, 5}),
                                     [](int i, int j, int k) {
                                       return i == 3 && j == 2 && k == 2 ? not_a_number : 1.0;
                                     }),
                  transfer(constant(0.5, color)),
                  {-1, 1.5, 2.5},
                  {1, 0, 0},
                  {},
                  0,
                  0};
  expect_slab(ray, 0.5, 6, color, 1);
  // Half of the opacity is reached before the gap or behind it.
  const double before = -std::log1p(-0.5 * ray.opacity) / 0.5;
  ray.half_opacity_depth = 1 + before + (before > 2 ? 2 : 0);
  rays.push_back(ray);

  ray.name = "all NaN";
  ray.volume =
      make_volume<double>(grid_description({3, 3, 3}), [](int, int, int) { return not_a_number; });
  expect_slab(ray, 0.5, 0, color, 0);
  rays.push_back(ray);
}

template <class Value>
void add_type(std::vector<AnalyticRay>& rays, const char* name) {
  AnalyticRay ray{
      std::string("linear ramp in ") + name,
      make_volume<Value>(grid_description({5, 3, 4}), [](int i, int, int) { return 30 * i; }),
      transfer({{0, 0, {1, 0, 1}}, {120, 3, {1, 1, 0}}}),
      {-2, 0.7, 1.3},
      {1, 0, 0},
      {},
      0,
      0};
  expect_rising(ray, 0.75, 4, 2);
  rays.push_back(ray);
}

}  // namespace

std::vector<AnalyticRay> analytic_rays() {
  std::vector<AnalyticRay> rays;
  add_constant_fields(rays);
  add_ramps(rays);
  add_cell_centred(rays);
  add_curved(rays);
  add_sphere(rays);
  add_vacuum(rays);
  add_type<std::uint8_t>(rays, "u8");
  add_type<std::int8_t>(rays, "i8");
  add_type<std::uint16_t>(rays, "u16");
  add_type<std::int16_t>(rays, "i16");
  add_type<std::uint32_t>(rays, "u32");
  add_type<std::int32_t>(rays, "i32");
  add_type<float>(rays, "f32");
  add_type<double>(rays, "f64");
  return rays;
}

Scene one_pixel_scene(const AnalyticRay& ray) {
  Scene scene;
  test::volume_of(scene).volume = ray.volume;
  test::volume_of(scene).transfer_function = ray.transfer_function;
  scene.camera.projection = Projection::orthographic;
  scene.camera.position = ray.origin;
  scene.camera.focal_point = ray.origin + ray.direction;
  const bool along_y = std::fabs(ray.direction.y) > 0.9;
  scene.camera.up = along_y ? Vec3<double>{1, 0, 0} : Vec3<double>{0, 1, 0};
  scene.size = {1, 1};
  return scene;
}

}  // namespace pellucid::scenes
