// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/lit_panel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "pellucid/segment/lit_cuts.h"

namespace pellucid::test_lit_panel {
namespace {

using Real = long double;
using Real3 = std::array<Real, 3>;

Real dot3(const Real3& a, const Real3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Real3 scaled(const Real3& a, Real s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
Real3 added(const Real3& a, const Real3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Real3 real(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}

/// A cubic by the powers of its parameter.
Real cubic(const CubicBernstein<double>& f, Real t) {
  const Real s = 1 - t;
  return f.b[0] * s * s * s + 3 * f.b[1] * t * s * s + 3 * f.b[2] * t * t * s + f.b[3] * t * t * t;
}

/// A lit stretch in which one layer has one table, linear along all of the data.
struct Case {
  std::array<double, 2> value{};
  std::array<Material<double>, 2> material{};
  std::array<double, 2> gradient_value{};
  std::array<Material<double>, 2> factor{};
  PiecewiseLinear<double> factors;
  ChannelTable<double> table;
  MultivariateTransfer<double> transfer;
  Reflection<double> reflection;
  std::vector<LightSource<double>> lights;
  LitLayer<double> layer;
  LitStretch<double> stretch;
  bool weakened = false;
  double largest_color = 1;

  Case() = default;
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;

  void link() {
    table = {0, {value.data(), material.data(), 2}};
    transfer.table = &table;
    transfer.tables = 1;
    factors = {gradient_value.data(), factor.data(), 2};
    layer.transfer = &transfer;
    layer.reflection = &reflection;
    layer.gradient_opacity = weakened ? &factors : nullptr;
    stretch.layer = &layer;
    stretch.layers = 1;
    stretch.light = lights.data();
    stretch.lights = static_cast<int>(lights.size());
  }

  struct Seen {
    Real extinction;
    std::array<Real, 3> color;
  };
  Seen at(Real u) const {
    const Real v = cubic(layer.span.data[0], u);
    const Real share = (v - value[0]) / (Real{value[1]} - value[0]);
    const auto mix = [&](double a, double b) { return a + share * (Real{b} - a); };
    Seen seen{mix(material[0].extinction, material[1].extinction),
              {mix(material[0].color.r, material[1].color.r),
               mix(material[0].color.g, material[1].color.g),
               mix(material[0].color.b, material[1].color.b)}};
    if (weakened) {
      const Real m = cubic(layer.magnitude, u);
      seen.extinction *= factor[0].extinction +
                         (m - gradient_value[0]) / (Real{gradient_value[1]} - gradient_value[0]) *
                             (Real{factor[1].extinction} - factor[0].extinction);
    }
    const Real3 g{cubic(layer.gradient[0], u), cubic(layer.gradient[1], u),
                  cubic(layer.gradient[2], u)};
    const Real square = dot3(g, g) + reflection.flat_square;
    const Real3 n = square > 0 ? scaled(g, 1 / std::sqrt(square)) : Real3{};
    const Real3 x = added(real(stretch.begin), scaled(real(stretch.direction), u * stretch.length));
    const Real3 eye = scaled(real(stretch.direction), -1);
    std::array<Real, 3> factor_of{reflection.ambient, reflection.ambient, reflection.ambient};
    std::array<Real, 3> more{};
    for (const LightSource<double>& light : lights) {
      Real3 l = eye;
      if (light.kind == LightSource<double>::Kind::directional) l = real(light.place);
      if (light.kind == LightSource<double>::Kind::point) {
        l = added(real(light.place), scaled(x, -1));
        l = scaled(l, 1 / std::sqrt(dot3(l, l)));
      }
      const Real3 sum = added(l, eye);
      const Real size = std::sqrt(dot3(sum, sum));
      const Real toward = size > 1e-6L ? std::abs(dot3(n, sum)) / size : 0;
      const Real diffuse = reflection.diffuse * std::abs(dot3(n, l));
      const Real specular = reflection.specular * std::pow(toward, Real{reflection.power});
      const std::array<Real, 3> color{light.color.r, light.color.g, light.color.b};
      for (std::size_t c = 0; c < 3; ++c) {
        factor_of[c] += diffuse * color[c];
        more[c] += specular * color[c];
      }
    }
    for (std::size_t c = 0; c < 3; ++c) seen.color[c] = seen.color[c] * factor_of[c] + more[c];
    return seen;
  }

  struct Truth {
    Real opacity = 0;
    std::array<Real, 3> radiance{};
  };
  /// By the trapezoidal rule for the depth and the midpoint rule for the light, on steps so fine
  /// that halving them changes nothing that is asked for.
  Truth integral(double begin, double end, int steps) const {
    Truth truth;
    Real depth = 0;
    const Real step = (Real{end} - begin) / steps, length = step * stretch.length;
    for (int i = 0; i < steps; ++i) {
      const Real u = begin + i * step;
      // Simpson's rule: exact for the cubic of a table alone.
      const Real first = at(u).extinction, last = at(u + step).extinction;
      const Seen middle = at(u + step / 2);
      const Real own = length * (first + 4 * middle.extinction + last) / 6;
      const Real opacity = std::exp(-depth) * -std::expm1(-own);
      for (std::size_t c = 0; c < 3; ++c) truth.radiance[c] += opacity * middle.color[c];
      truth.opacity += opacity;
      depth += own;
    }
    return truth;
  }
};

/// A case of any kind. Gradients come as close to 0 as they like.
void make_case(std::mt19937& random, Case& c) {
  std::uniform_real_distribution<double> unit(0, 1), both(-1, 1);
  const auto power_of_10 = [&](double from, double to) {
    return std::pow(10.0, from + (to - from) * unit(random));
  };
  const auto color = [&] { return Rgb<double>{unit(random), unit(random), unit(random)}; };
  c.value = {-1, 2};
  for (auto& material : c.material) material = {power_of_10(-2, 1), color()};
  c.gradient_value = {-10, 20};
  c.factor = {{{0.3 * unit(random), {}}, {unit(random), {}}}};
  c.weakened = unit(random) < 0.4;
  for (double& b : c.layer.span.data[0].b) b = unit(random);
  for (double& b : c.layer.magnitude.b) b = 10 * unit(random);
  const double size = power_of_10(-1, 2);
  const bool through_zero = unit(random) < 0.3;
  for (auto& component : c.layer.gradient) {
    if (through_zero) {
      // Near a place where all components vanish.
      const double zero = 0.2 + 0.6 * unit(random), slope = size * both(random);
      const double past = 1e-3 * size * both(random);
      for (int k = 0; k < 4; ++k) component.b[k] = slope * (k / 3.0 - zero) + past;
    } else {
      for (double& b : component.b) b = size * both(random);
    }
  }
  const double power = unit(random) < 0.3 ? 1 + 3 * unit(random) : 1 + power_of_10(-1, 2);
  c.reflection = {unit(random), unit(random), unit(random),
                  unit(random) < 0.1 ? 1 + std::floor(3 * unit(random)) : power, 0};
  if (unit(random) < 0.8) c.reflection.flat_square = std::pow(size * power_of_10(-3, 0), 2);
  c.stretch.begin = {both(random), both(random), both(random)};
  const auto direction = [&] {
    for (;;) {
      const Vec3<double> d{both(random), both(random), both(random)};
      if (length(d) > 0.1) return normalized(d);
    }
  };
  c.stretch.direction = direction();
  c.stretch.length = power_of_10(-1, 0.5);
  c.lights.clear();
  double brightest = 0;
  for (int i = 0; i < 1 + 2 * unit(random); ++i) {
    LightSource<double> light;
    const double kind = unit(random);
    light.color = color();
    if (kind > 0.4) {
      light.kind = LightSource<double>::Kind::directional;
      light.place = direction();
    }
    if (kind > 0.7) {
      light.kind = LightSource<double>::Kind::point;
      light.place = 3.0 * direction();
    }
    brightest += largest_component(light.color);
    c.lights.push_back(light);
  }
  c.layer.span.length = c.stretch.length;
  c.largest_color = std::max(
      1.0, c.reflection.ambient + (c.reflection.diffuse + c.reflection.specular) * brightest);
  c.link();
}

/// Where g·l and g·h change their sign, of any light, by bisection.
std::vector<double> kinks(const Case& c) {
  std::vector<double> positions;
  const auto find = [&](const LightSource<double>& light, bool of_half) {
    const auto along = [&](Real u) {
      const Real3 eye = scaled(real(c.stretch.direction), -1);
      Real3 l = eye;
      if (light.kind != LightSource<double>::Kind::head) l = real(light.place);
      if (light.kind == LightSource<double>::Kind::point) {
        const Real3 x =
            added(real(c.stretch.begin), scaled(real(c.stretch.direction), u * c.stretch.length));
        l = added(l, scaled(x, -1));
      }
      if (of_half) l = added(scaled(l, 1 / std::sqrt(dot3(l, l))), eye);
      return dot3({cubic(c.layer.gradient[0], u), cubic(c.layer.gradient[1], u),
                   cubic(c.layer.gradient[2], u)},
                  l);
    };
    constexpr int parts = 1000;
    for (int i = 0; i < parts; ++i) {
      Real lower = static_cast<Real>(i) / parts, upper = static_cast<Real>(i + 1) / parts;
      if ((along(lower) > 0) == (along(upper) > 0)) continue;
      for (int k = 0; k < 60; ++k) {
        const Real middle = (lower + upper) / 2;
        ((along(middle) > 0) == (along(lower) > 0) ? lower : upper) = middle;
      }
      positions.push_back(static_cast<double>(lower));
    }
  };
  for (const LightSource<double>& light : c.lights) {
    find(light, false);
    const bool is_head = light.kind == LightSource<double>::Kind::head;
    if (!is_head && has_kink_in_highlight(c.reflection)) find(light, true);
  }
  std::ranges::sort(positions);
  return positions;
}

/// Integrates all of a case in panels, cut at kinks, and calls visit(begin, end, panel) for each.
template <class Visit>
void in_panels(const Case& c, Grade grade, double allowed, const Visit& visit) {
  std::vector<double> ends{1};
  for (const double kink : kinks(c)) ends.insert(ends.begin() + 1, kink);
  double begin = 0;
  PanelDemand<double> demand;
  demand.grade = grade;
  demand.largest_color = c.largest_color;
  while (!ends.empty()) {
    const double end = ends.back();
    const LitLayer<double> part = c.layer.part(begin, end);
    const auto allowance = [&](double) { return allowed * (end - begin); };
    const PanelSegment<double> panel =
        integrate_lit_panel(c.stretch, &part, begin, end, demand, allowance);
    if (!panel.done) {
      ASSERT_LT(ends.size(), 70U);
      ends.push_back(begin + panel.cut * (end - begin));
      continue;
    }
    visit(begin, end, panel);
    begin = end;
    ends.pop_back();
  }
}

TEST(LitCuts, AreWhereNormalsTurnTheirEdgeToALightOrToAHighlight) {
  std::mt19937 random(9);
  Case c;
  std::size_t cuts = 0;
  for (int n = 0; n < 400; ++n) {
    make_case(random, c);
    c.weakened = false;
    c.link();
    std::vector<double> found;
    const Vec3<double> end = c.stretch.begin + c.stretch.direction * c.stretch.length;
    for_each_lit_cut(c.layer, c.lights.data(), static_cast<int>(c.lights.size()), c.stretch.begin,
                     end, c.stretch.direction, [&](double u) { found.push_back(u); });
    std::ranges::sort(found);
    const std::vector<double> wanted = kinks(c);
    cuts += wanted.size();
    for (const double u : wanted) {
      const auto nearest =
          std::ranges::min_element(found, {}, [&](double other) { return std::abs(other - u); });
      ASSERT_TRUE(nearest != found.end()) << "case " << n << " at " << u;
      ASSERT_NEAR(*nearest, u, 1e-9) << "case " << n;
    }
    // Others are so close together that the search here does not see them, and few.
    ASSERT_LE(found.size(), wanted.size() + 2) << "case " << n;
  }
  EXPECT_GT(cuts, 200U);
}

void expect_errors_are_kept(Grade grade, int cases, double allowed, int steps) {
  std::mt19937 random(grade == Grade::proved ? 5 : 7);
  Case c;
  double largest_share = 0;
  for (int n = 0; n < cases; ++n) {
    make_case(random, c);
    in_panels(c, grade, allowed, [&](double begin, double end, const PanelSegment<double>& panel) {
      const int own = std::max(200, static_cast<int>(steps * (end - begin)));
      const Case::Truth truth = c.integral(begin, end, own);
      // What the truth may be off by: of second order in its steps.
      const Case::Truth coarse = c.integral(begin, end, own / 2);
      const SegmentResult<double>& s = panel.found.segment;
      const double radiance[3] = {s.radiance.r, s.radiance.g, s.radiance.b};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto doubt = static_cast<double>(std::abs(truth.radiance[k] - coarse.radiance[k]));
        const auto off = static_cast<double>(std::abs(truth.radiance[k] - radiance[k]));
        const double said = panel.found.color_error + c.largest_color * panel.found.opacity_error;
        ASSERT_LE(off, said + doubt + 1e-15) << "case " << n << " at " << begin << ", " << end;
        if (said > 1e-9) largest_share = std::max(largest_share, (off - doubt) / said);
      }
      ASSERT_NEAR(s.opacity, static_cast<double>(truth.opacity), panel.found.opacity_error + 1e-9);
      ASSERT_LE(panel.error(c.largest_color), 1.0000001 * allowed * (end - begin) + 1e-12);
      ASSERT_TRUE(panel.found.proved || grade == Grade::estimated);
    });
  }
  testing::Test::RecordProperty("largest_share", std::to_string(largest_share));
  EXPECT_GT(largest_share, 0.001);  // else nothing was seen
}

TEST(LitPanel, BoundsAreKept) {
  expect_errors_are_kept(Grade::proved, 20, 0.05, 2000);
}
TEST(LitPanel, EstimatesAreKept) {
  expect_errors_are_kept(Grade::estimated, 200, 1e-2, 2000);
}
TEST(LitPanel, FineEstimatesAreKept) {
  expect_errors_are_kept(Grade::estimated, 25, 1e-5, 8000);
}

TEST(LitPanel, AConstantGradientIsExact) {
  Case c;
  c.value = {-1, 2};
  c.material = {{{1, {0.5, 0.25, 1}}, {1, {0.5, 0.25, 1}}}};
  for (double& b : c.layer.span.data[0].b) b = 0.5;
  for (double& b : c.layer.gradient[0].b) b = 3;
  c.reflection = {0.1, 0.6, 0.3, 8, 16};  // |n| = 3/5
  c.lights = {LightSource<double>{}};
  c.stretch.direction = {-1, 0, 0};
  c.stretch.length = 2;
  c.layer.span.length = 2;
  c.link();
  int panels = 0;
  in_panels(c, Grade::proved, 1e-9, [&](double, double, const PanelSegment<double>& panel) {
    ++panels;
    const double shade = 0.1 + 0.6 * 0.6, shine = 0.3 * std::pow(0.6, 8);
    const double opacity = -std::expm1(-2.0);
    EXPECT_NEAR(panel.found.segment.radiance.r, opacity * (0.5 * shade + shine), 1e-15);
    EXPECT_NEAR(panel.found.segment.radiance.b, opacity * (shade + shine), 1e-15);
  });
  EXPECT_EQ(panels, 1);
}

TEST(Shading, BoundsContainWhatIsAnywhereOnTheStretch) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  Case c;
  for (int n = 0; n < 3000; ++n) {
    make_case(random, c);
    const double half = 0.5 * c.stretch.length;
    const GradientStretch<double> along{
        {c.layer.gradient[0], c.layer.gradient[1], c.layer.gradient[2]},
        c.stretch.begin + c.stretch.direction * half,
        half,
        -c.stretch.direction};
    const LitBounds<double> bounds = light_bounds(
        c.reflection, c.lights.data(), static_cast<int>(c.lights.size()), along, along.square());
    for (int i = 0; i < 20; ++i) {
      const double u = unit(random);
      const Lit<double> lit = light_up(
          c.reflection, c.lights.data(), static_cast<int>(c.lights.size()), along.at(u),
          c.stretch.begin + c.stretch.direction * (u * c.stretch.length), -c.stretch.direction);
      ASSERT_GE(lit.factor.r, bounds.lower.factor.r) << n;
      ASSERT_LE(lit.factor.r, bounds.upper.factor.r) << n;
      ASSERT_GE(lit.added.g, bounds.lower.added.g) << n;
      ASSERT_LE(lit.added.g, bounds.upper.added.g) << n;
    }
  }
}

}  // namespace
}  // namespace pellucid::test_lit_panel
