// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pellucid/scene/stretch_source.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <utility>
#include <vector>

/// A ball of matter, densest at its center: weight · (1 - |p - center|² / radius²), 0 outside. The
/// kernel of Epanechnikov, which smoothed particles and density estimates use.
struct Particle {
  pellucid::Vec3<double> center;
  double radius, weight;

  double density(const pellucid::Vec3<double>& p) const { return std::max(polar(p, p), 0.0); }
  pellucid::Vec3<double> gradient(const pellucid::Vec3<double>& p) const {
    return (p - center) * (-2 * weight / (radius * radius));
  }
  /// Returns the polar form of the density inside, which is a quadratic along any line: for p = q
  /// its value there, else the middle Bernstein coefficient between p and q.
  double polar(const pellucid::Vec3<double>& p, const pellucid::Vec3<double>& q) const {
    return weight * (1 - dot(p - center, q - center) / (radius * radius));
  }
};

/// The sum of particles' densities, without a grid: along a ray it is a quadratic between any two
/// places at which the ray enters or leaves a particle.
///
/// Each ray is tried against all particles. More than some thousand of them want a tree.
class ParticleCloud : public pellucid::StretchSource {
 public:
  explicit ParticleCloud(std::vector<Particle> particles)
      : StretchSource(described(particles)), particles_(std::move(particles)) {}

  std::unique_ptr<pellucid::StretchStream> stream(
      const pellucid::StretchDemand& demand) const override {
    return std::make_unique<Stream>(particles_, demand.gradient >= 0);
  }

  /// Returns the density at a point; `gradient` becomes its gradient.
  double density(const pellucid::Vec3<double>& p, pellucid::Vec3<double>& gradient) const {
    double sum = 0;
    gradient = {};
    for (const Particle& particle : particles_) {
      const double own = particle.density(p);
      if (own > 0) gradient = gradient + particle.gradient(p);
      sum += own;
    }
    return sum;
  }

 private:
  static Description described(const std::vector<Particle>& particles) {
    Description description;
    description.name = "particles";
    description.has_gradient = true;
    pellucid::Box<double>& box = description.bounds;
    double finest = 0, largest = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Particle& particle = particles[i];
      double sum = 0;  // no point of this particle sees more than those that touch it
      for (const Particle& other : particles) {
        const double apart = length(other.center - particle.center);
        if (apart < particle.radius + other.radius) sum += other.weight;
      }
      largest = std::max(largest, sum);
      finest = i == 0 ? particle.radius : std::min(finest, particle.radius);
      for (int a = 0; a < 3; ++a) {
        const double lower = particle.center[a] - particle.radius;
        const double upper = particle.center[a] + particle.radius;
        box.lower[a] = i == 0 ? lower : std::min(box.lower[a], lower);
        box.upper[a] = i == 0 ? upper : std::max(box.upper[a], upper);
      }
    }
    description.variables = {{"density", 0, largest}};
    description.voxel_size = finest;
    return description;
  }

  class Stream : public pellucid::StretchStream {
   public:
    Stream(const std::vector<Particle>& particles, bool has_gradient)
        : particles_(particles), has_gradient_(has_gradient) {}

    pellucid::Interval<double> start(const pellucid::Ray<double>& ray) override {
      ray_ = ray;
      crossings_.clear();
      for (const Particle& particle : particles_) {
        const pellucid::Vec3<double> from = ray.origin - particle.center;
        const double middle = -dot(from, ray.direction);
        const pellucid::Vec3<double> nearest = from + ray.direction * middle;
        const double square = particle.radius * particle.radius - dot(nearest, nearest);
        if (!(square > 0)) continue;
        const double half = std::sqrt(square);
        // Of points on the way; where the ray grazes the ball, its ends have larger errors.
        const double off = point_error(middle + half);
        const double error = std::min(4 * off * (particle.radius + off) / half,
                                      std::sqrt(4 * off * particle.radius));
        crossings_.push_back({middle - half, error + off, &particle, true});
        crossings_.push_back({middle + half, error + off, &particle, false});
      }
      if (crossings_.empty()) return {1, 0};
      std::ranges::sort(crossings_, {}, &Crossing::t);
      return {crossings_.front().t, crossings_.back().t};
    }

    void restrict_to_range(pellucid::Interval<double> range) override {
      range_ = range;
      next_ = 0;
      inside_.clear();
    }

    bool next(pellucid::FieldStretch& stretch) override {
      while (next_ + 1 < crossings_.size()) {
        const Crossing& first = crossings_[next_++];
        if (first.enters) {
          inside_.push_back(first.particle);
        } else {
          std::erase(inside_, first.particle);
        }
        const Crossing& last = crossings_[next_];
        if (first.t >= range_.end) return false;
        if (inside_.empty() || last.t <= range_.begin) continue;
        stretch.begin = first.t;
        stretch.end = last.t;
        stretch.position_error = first.error + last.error;
        fill(stretch);
        return true;
      }
      return false;
    }

   private:
    struct Crossing {
      double t, error;
      const Particle* particle;
      bool enters;
    };

    double point_error(double t) const { return 0x1p-50 * (length(ray_.origin) + std::abs(t)); }

    /// Adds up the particles that the stretch is inside of.
    void fill(pellucid::FieldStretch& stretch) const {
      const pellucid::Vec3<double> begin = ray_.at(stretch.begin), end = ray_.at(stretch.end);
      const double off = point_error(stretch.end);
      double at_begin = 0, between = 0, at_end = 0, error = 0;
      pellucid::Vec3<double> first{}, last{};
      for (const Particle* const particle : inside_) {
        at_begin += particle->polar(begin, begin);
        between += particle->polar(begin, end);
        at_end += particle->polar(end, end);
        first = first + particle->gradient(begin);
        last = last + particle->gradient(end);
        error += particle->weight * (4 * off / particle->radius + 0x1p-50);
      }
      // A quadratic as a cubic.
      stretch.data[0] = {
          {at_begin, (at_begin + 2 * between) / 3, (2 * between + at_end) / 3, at_end}};
      stretch.value_error[0] = error;
      if (!has_gradient_) return;
      for (int a = 0; a < 3; ++a) {
        stretch.gradient[a] = as_cubic(pellucid::LinearBernstein<double>{{first[a], last[a]}});
      }
    }

    const std::vector<Particle>& particles_;
    const bool has_gradient_;
    pellucid::Ray<double> ray_{};
    pellucid::Interval<double> range_{0, 0};
    std::vector<Crossing> crossings_;  ///< front to back
    std::size_t next_ = 0;
    std::vector<const Particle*> inside_;
  };

  const std::vector<Particle> particles_;
};

/// Returns a spiral of two arms around a bulge, in a disk of radius 1 along z = 0.
inline std::vector<Particle> spiral_of_particles(int count) {
  std::mt19937 random(1);
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-32; };
  std::vector<Particle> particles;
  for (int i = 0; i < count; ++i) {
    const bool in_bulge = i % 4 == 0;
    const double far = in_bulge ? 0.22 * unit() : 0.12 + 0.88 * unit();
    const double arm = (i % 2 == 0 ? 0 : 3.14159265) + 5 * far + 0.7 * (unit() - 0.5);
    const double turn = in_bulge ? 6.2831853 * unit() : arm;
    const double high = (in_bulge ? 0.2 : 0.06) * (unit() - 0.5);
    particles.push_back({{far * std::cos(turn), far * std::sin(turn), high},
                         0.04 + 0.05 * unit(),
                         in_bulge ? 1.0 : 0.4 + 0.6 * unit()});
  }
  return particles;
}
