// SPDX-License-Identifier: Apache-2.0
//
// The field of examples/own_field against the integral of its density at points, which knows
// nothing of stretches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "examples/own_field/particles.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/layer.h"
#include "tests/scenes/makers.h"

namespace pellucid::test_own_field {
namespace {

struct Truth {
  Rgb<double> radiance{};
  double opacity = 0;
};

/// Integrates rays by steps that are halved until nothing changes.
class PointByPoint {
 public:
  PointByPoint(const ParticleCloud& cloud, const std::vector<Particle>& particles,
               const Layer& layer)
      : cloud_(cloud),
        particles_(particles),
        layer_(layer),
        table_(univariate_in(std::get<SourceContent>(layer.content).transfer_function)
                   ->view<double>()) {
    if (layer.shading) flat_ = flat_gradient(layer);
  }

  Truth operator()(const Ray<double>& ray) const {
    std::vector<double> ends;
    for (const Particle& particle : particles_) {
      const Vec3<double> from = ray.origin - particle.center;
      const double b = dot(from, ray.direction);
      const double square = b * b - dot(from, from) + particle.radius * particle.radius;
      if (square <= 0) continue;
      ends.push_back(-b - std::sqrt(square));
      ends.push_back(-b + std::sqrt(square));
    }
    std::ranges::sort(ends);
    Truth last = stepped(ray, ends, 4);
    for (int steps = 8; steps < 5000; steps *= 2) {
      const Truth next = stepped(ray, ends, steps);
      const double change = std::max(std::abs(next.opacity - last.opacity),
                                     largest_component(next.radiance - last.radiance)) +
                            std::max(0.0, largest_component(last.radiance - next.radiance));
      last = next;
      if (change < 1e-7) break;
    }
    return last;
  }

 private:
  Truth stepped(const Ray<double>& ray, const std::vector<double>& ends, int steps) const {
    Truth sum;
    double transparency = 1;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const double length = (ends[i + 1] - ends[i]) / steps;
      for (int k = 0; k < steps; ++k) {
        const Vec3<double> place = ray.at(ends[i] + (k + 0.5) * length);
        Vec3<double> gradient;
        const double density = cloud_.density(place, gradient);
        if (!(density > 0)) continue;
        const Material<double> material = table_.evaluate(density);
        const double seen = transparency * -std::expm1(-material.extinction * length);
        sum.radiance += seen * lit(material.color, gradient, -ray.direction);
        transparency *= std::exp(-material.extinction * length);
      }
    }
    sum.opacity = 1 - transparency;
    return sum;
  }

  /// Blinn's light at the eye (Shading).
  Rgb<double> lit(const Rgb<double>& color, const Vec3<double>& gradient,
                  const Vec3<double>& to_eye) const {
    if (!layer_.shading) return color;
    const Shading& s = *layer_.shading;
    const double along =
        std::abs(dot(gradient, to_eye)) / std::sqrt(dot(gradient, gradient) + flat_ * flat_);
    const double highlight = s.specular * std::pow(along, s.power);
    return (s.ambient + s.diffuse * along) * color + Rgb<double>{highlight, highlight, highlight};
  }

  const ParticleCloud& cloud_;
  const std::vector<Particle>& particles_;
  const Layer& layer_;
  PiecewiseLinear<double> table_;
  double flat_ = 0;
};

TEST(OwnField, IsTheIntegralOfItsDensity) {
  const std::vector<Particle> particles = spiral_of_particles(90);
  const auto cloud = std::make_shared<const ParticleCloud>(particles);
  double brightest = 0;
  for (const bool has_light : {false, true}) {
    Layer layer{SourceContent{cloud, scenes::transfer({{0, 0, {0.1, 0.2, 0.9}},
                                                       {0.5, 8, {0.3, 0.5, 1}},
                                                       {1.5, 20, {1, 0.8, 0.5}},
                                                       {3, 60, {1, 0.95, 0.8}}})}};
    if (has_light) layer.shading = Shading{0.3, 0.7, 0.2, 12};
    Scene scene;
    scene.layers = {layer};
    scene.camera.position = {0.6, -2.6, 2.4};
    scene.camera.up = {0, 0, 1};
    scene.camera.vertical_angle = 32;
    scene.size = {13, 11};
    const CameraFrame<double> camera = make_camera_frame(scene.camera, scene.size);
    const PointByPoint integrate(*cloud, particles, layer);
    std::vector<Truth> truth;
    for (int row = 0; row < scene.size.height; ++row) {
      for (int column = 0; column < scene.size.width; ++column) {
        truth.push_back(integrate(camera.ray(column, row)));
        brightest = std::max(brightest, largest_component(truth.back().radiance));
      }
    }
    for (const double tolerance : {1e-5, 1.0 / 512}) {
      scene.integration.tolerance = tolerance;
      for (const bool one_by_one : {true, false}) {
        RenderOptions options;
        options.outputs.error = true;
        if (one_by_one) options.machine.instruction_set = InstructionSet::scalar;
        const Image image = render(scene, options).image;
        for (std::size_t i = 0; i < truth.size(); ++i) {
          EXPECT_LE(image.error[i], tolerance * 1.001);
          const double off = double{image.error[i]} + 1e-6;
          EXPECT_NEAR(image.pixels[i][0], truth[i].radiance.r, off) << has_light << ' ' << i;
          EXPECT_NEAR(image.pixels[i][1], truth[i].radiance.g, off) << has_light << ' ' << i;
          EXPECT_NEAR(image.pixels[i][2], truth[i].radiance.b, off) << has_light << ' ' << i;
          EXPECT_NEAR(image.pixels[i][3], truth[i].opacity, off) << has_light << ' ' << i;
        }
      }
    }
  }
  EXPECT_GT(brightest, 0.3);
}

}  // namespace
}  // namespace pellucid::test_own_field
