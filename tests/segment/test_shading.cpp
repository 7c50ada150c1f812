// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/shading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pellucid/segment/gauss_panel.h"

namespace pellucid::test_shading {
namespace {

TEST(Shading, ALightBehindHasNoSpecularPart) {
  const Reflection<double> reflection{0, 0, 1, 1, 0};
  const LightSource<double> behind{LightSource<double>::Kind::directional, {1, 0, 0}, {1, 1, 1}};
  const Lit<double> lit = light_up(reflection, &behind, 1, Vec3<double>{0, 1, 0}, Vec3<double>{},
                                   Vec3<double>{-1, 1e-9, 0});
  EXPECT_EQ(lit.added.r, 0);
}

TEST(Shading, WhereThereIsNoGradientOnlyTheAmbientPartIsLeft) {
  const Reflection<double> reflection{0.25, 1, 1, 10, 0};
  const LightSource<double> head;
  const Lit<double> lit =
      light_up(reflection, &head, 1, Vec3<double>{}, Vec3<double>{}, Vec3<double>{0, 0, 1});
  EXPECT_EQ(lit.factor.g, 0.25);
  EXPECT_EQ(lit.added.g, 0);
}

TEST(Shading, NormalsAreWithinTheirError) {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> both(-1, 1), exponent(-12, 12);
  const auto component = [&] {
    return static_cast<float>(both(random) * std::pow(10, exponent(random)));
  };
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3<float> g{component(), component(), component()};
    const float flat = i % 3 == 0 ? 0.0f : component() * component();
    const Reflection<float> reflection{0, 1, 0, 1, std::fabs(flat)};
    const Vec3<float> n = shading_normal(reflection, g);
    long double square = static_cast<long double>(reflection.flat_square);
    for (int c = 0; c < 3; ++c) square += static_cast<long double>(g[c]) * g[c];
    for (int c = 0; c < 3; ++c) {
      const long double exact = g[c] / std::sqrt(square);
      if (!(std::fabs(exact) > 1e-30L)) continue;
      worst = std::max(worst, static_cast<double>(std::fabs(n[c] / exact - 1)));
    }
  }
  EXPECT_LE(worst, 5 * rounding_unit<float>);
  EXPECT_GT(worst, 1 * rounding_unit<float>);
  const Vec3<float> flat = shading_normal(Reflection<float>{0, 1, 0, 1, 0}, Vec3<float>{0, 0, 0});
  EXPECT_EQ(length(flat), 0);
}

/// A cell as packets shade it, at random: gradients that turn a little or a lot.
struct ShadedCell {
  GradientStretch<double> along;
  Reflection<double> reflection;
  std::vector<LightSource<double>> lights;
  double length, first, change;
  CubicBernstein<double> data;
  double factor = 1, factor_change = 0;  ///< of the extinction, along `magnitude`
  CubicBernstein<double> magnitude{};

  Material<double> at(double u) const {
    const Lit<double> lit = light_up(reflection, lights.data(), static_cast<int>(lights.size()),
                                     along.at(u), along.position(u), along.to_eye);
    return {
        (first + change * evaluate(data, u)) * (factor + factor_change * evaluate(magnitude, u)),
        lit.apply({0.5, 1, 0})};
  }
  bool has_kink() const {
    for (const LightSource<double>& light : lights) {
      const auto to = [&](double u) { return directions(light, along.position(u), along.to_eye); };
      if (turns_away_from([&](double u) { return to(u).light; })) return true;
      if (has_kink_in_highlight(reflection) &&
          turns_away_from([&](double u) { return to(u).half; })) {
        return true;
      }
    }
    return false;
  }
  template <class DirectionAt>
  bool turns_away_from(const DirectionAt& direction) const {
    const auto facing = [&](double u) { return dot(along.at(u), direction(u)); };
    for (int i = 1; i <= 40; ++i) {
      if (facing(i / 40.0) * facing(0) < 0) return true;
    }
    return false;
  }
  /// The factor by which the distance of point lights makes the color turn faster (LightLanes).
  double turns_of_distance() const {
    double most = 1;
    for (const LightSource<double>& light : lights) {
      if (light.kind != LightSource<double>::Kind::point) continue;
      const double away = length_of(light.place - along.middle), half = along.half_length;
      most = std::max(most, (away + half) / (away - half));
    }
    return most * most;
  }
  static double length_of(const Vec3<double>& v) { return pellucid::length(v); }
  template <int Nodes>
  Rgb<double> color() const {
    return detail::panel_color(
        detail::PanelNodes<Nodes, double>(length, [&](double u) { return at(u); }));
  }
  /// Ten nodes on each of sixteen parts.
  Rgb<double> true_color() const {
    Rgb<double> sum{};
    double depth = 0, weight = 0;
    for (int i = 0; i < 16; ++i) {
      const detail::PanelNodes<10, double> part(length / 16,
                                                [&](double u) { return at((i + u) / 16); });
      const double opacity = std::exp(-depth) * -std::expm1(-part.total);
      sum += opacity * detail::panel_color(part);
      weight += opacity;
      depth += part.total;
    }
    return (1 / weight) * sum;
  }
};

/// What cells may have: point lights, from eight cells on; a factor of the extinction.
enum class With { distant_lights, points, factors };

ShadedCell random_cell(std::mt19937& random, With with) {
  std::uniform_real_distribution<double> unit(0, 1), both(-1, 1);
  const auto direction = [&] {
    for (;;) {
      const Vec3<double> d{both(random), both(random), both(random)};
      if (length(d) > 0.1) return normalized(d);
    }
  };
  ShadedCell cell;
  const double size = std::pow(10, -2 + 2.3 * unit(random));
  const Vec3<double> base = direction();
  const bool straight = unit(random) < 0.5;
  for (int a = 0; a < 3; ++a) {
    const double slope = size * both(random);
    for (int k = 0; k < 4; ++k) {
      cell.along.component[a].b[k] =
          base[a] + (straight ? slope * k / 3 + 0.3 * size * both(random) : size * both(random));
    }
  }
  cell.along.to_eye = direction();
  const double flat = unit(random) < 0.3 ? 0 : std::pow(10, -2 + 2 * unit(random));
  cell.reflection = {
      0.1 * unit(random), unit(random), unit(random) < 0.7 ? unit(random) : 0,
      unit(random) < 0.3 ? 1 + 3 * unit(random) : 1 + std::pow(10, 2.7 * unit(random)),
      flat * flat};
  for (int i = 0; i < (unit(random) < 0.3 ? 2 : 1); ++i) {
    LightSource<double> light;
    if (unit(random) < 0.5) {
      light.kind = LightSource<double>::Kind::directional;
      light.place = direction();
    }
    if (with == With::points && unit(random) < 0.7) {
      light.kind = LightSource<double>::Kind::point;
      light.place = (std::pow(10, 2 * unit(random)) * 17) * direction();
      cell.along.half_length = 1;
    }
    cell.lights.push_back(light);
  }
  cell.length = std::pow(10, -1 + 1.7 * unit(random));
  cell.first = unit(random);
  cell.change = unit(random) - cell.first;
  for (double& b : cell.data.b) b = unit(random);
  if (with == With::factors) {
    cell.factor = unit(random) < 0.3 ? 0 : unit(random);
    cell.factor_change = unit(random) - cell.factor;
    for (double& b : cell.magnitude.b) b = unit(random);
  }
  return cell;
}

/// Errors of a cell by three and by six nodes, relative to what is charged for it.
struct NodeErrors {
  bool known = false;  ///< whether it is one that they are for
  double three = 0, six = 0;
};

NodeErrors node_errors(const ShadedCell& cell) {
  NodeErrors result;
  const Bounds<double> squares = cell.along.square();
  const double flat = cell.reflection.flat_square;
  const double depth =
      detail::PanelNodes<4, double>(cell.length, [&](double u) { return cell.at(u); }).total;
  if (!(squares.upper + flat > 0) || depth > 8 || cell.has_kink()) return result;
  const double turns =
      std::min((squares.upper + flat) / (squares.lower + flat) * cell.turns_of_distance(), 1e30);
  const LitBounds<double> bounds =
      light_bounds(cell.reflection, cell.lights.data(), static_cast<int>(cell.lights.size()),
                   cell.along, squares);
  const double sharpness = cell.reflection.specular > 0 ? bounds.sharpness : 0;
  const double range = largest_component(bounds.upper.factor - bounds.lower.factor) +
                       largest_component(bounds.upper.added - bounds.lower.added);
  if (!(range > 1e-9)) return result;
  const double deep = depth > 1 ? 2 : 1;
  const auto share = [&](const Rgb<double>& difference, double of_nodes) {
    const double off =
        std::max({std::abs(difference.r), std::abs(difference.g), std::abs(difference.b)});
    return off / (range * std::min(deep * of_nodes, 1.0));
  };
  const Rgb<double> truth = cell.true_color();
  result.known = true;
  result.three = share(cell.color<3>() - truth, error_of_three_nodes(turns, sharpness));
  result.six = share(cell.color<6>() - truth, error_of_six_nodes(turns, sharpness));
  return result;
}

class ShadingOfNodes : public testing::TestWithParam<With> {};
INSTANTIATE_TEST_SUITE_P(Cells, ShadingOfNodes,
                         testing::Values(With::distant_lights, With::points, With::factors),
                         [](const auto& of) {
                           return of.param == With::points    ? "WithPointLights"
                                  : of.param == With::factors ? "WithFactors"
                                                              : "WithDistantLights";
                         });

TEST_P(ShadingOfNodes, ErrorsAreThoseOfRandomCells) {
  std::mt19937 random(11);
  double of_three = 0, of_six = 0;
  int seen = 0, large = 0;
  for (int n = 0; n < 60000; ++n) {
    const NodeErrors errors = node_errors(random_cell(random, GetParam()));
    if (!errors.known) continue;
    ++seen;
    ASSERT_LE(errors.three, worst_of_nodes) << n;
    ASSERT_LE(errors.six, worst_of_nodes) << n;
    if (errors.three > 1 || errors.six > 1) ++large;
    of_three = std::max(of_three, errors.three);
    of_six = std::max(of_six, errors.six);
  }
  EXPECT_GT(seen, 30000);
  EXPECT_LE(large, seen / 1000);
  EXPECT_GT(of_three, 0.3);
  EXPECT_GT(of_six, 0.2);
}

/// Climbs from random cells to the worst ones nearby.
TEST_P(ShadingOfNodes, ErrorsAreBelowTheWorstThatClimbingFinds) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(0, 1), both(-1, 1);
  double worst = 0;
  for (int start = 0; start < 60; ++start) {
    const auto score = [&](const ShadedCell& cell) {
      const NodeErrors errors = node_errors(cell);
      return !errors.known ? 0.0 : start % 2 == 0 ? errors.three : errors.six;
    };
    ShadedCell best = random_cell(random, GetParam());
    double highest = score(best), step = 0.3;
    for (int n = 0; n < 250; ++n) {
      ShadedCell other = best;
      for (CubicBernstein<double>& component : other.along.component) {
        for (double& b : component.b) b += unit(random) < 0.4 ? step * both(random) : 0;
      }
      other.reflection.power = std::max(1.0, other.reflection.power * (1 + step * both(random)));
      other.reflection.flat_square *= 1 + step * both(random);
      const double found = score(other);
      if (found > highest) {
        highest = found;
        best = other;
      } else if (n % 30 == 29) {
        step *= 0.7;
      }
    }
    ASSERT_LE(highest, worst_of_nodes) << start;
    worst = std::max(worst, highest);
  }
  EXPECT_GT(worst, 0.4);
}

TEST(Shading, PowersAreThoseOfTheLibrary) {
  EXPECT_EQ(raised(0.0, 20.0), 0);
  EXPECT_EQ(raised(0.0, 1.5), 0);
  for (const double power : {1.0, 2.0, 20.0, 33.0, 1000.0, 1.5, 77.25}) {
    for (const double x : {1e-3, 0.3, 0.9, 0.999, 1.0}) {
      const double truth = std::pow(x, power);
      EXPECT_NEAR(raised(x, power), truth,
                  2 * rounding_unit<double> * power * (1 + std::abs(std::log(x))) * truth + 1e-300);
    }
  }
}

}  // namespace
}  // namespace pellucid::test_shading
