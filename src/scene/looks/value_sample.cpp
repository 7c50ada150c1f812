// SPDX-License-Identifier: Apache-2.0
#include "value_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <variant>

#include "readable_numbers.h"

namespace pellucid {
namespace {

/// Sorts a sample, ascending, and draws the outermost values in.
std::vector<double> sorted(std::vector<double> sample) {
  std::sort(sample.begin(), sample.end());
  if (sample.empty()) return sample;
  // A few wild values (spikes, fill values) would take all of the range for themselves. What is
  // left of rarer data than that is kept: a thin vessel in a large box.
  const std::size_t tail = sample.size() / 1000;
  const double lower = sample[tail], upper = sample[sample.size() - 1 - tail];
  if (lower < upper) {
    for (double& value : sample) value = std::clamp(value, lower, upper);
  }
  return sample;
}

}  // namespace

std::vector<double> value_sample(const Volume& volume) {
  std::vector<double> sample;
  std::visit(
      [&](const auto& data) {
        visit_even_places(data.size(), [&](std::size_t index) {
          const auto value = static_cast<double>(data[index]);
          if (!std::isnan(value))
            sample.push_back(std::clamp(value, -largest_data_value, largest_data_value));
        });
      },
      volume.data());
  return sorted(std::move(sample));
}

namespace {

/// Returns the corners' weights at the n-th of points that fill a tetrahedron evenly: the parts
/// into which three numbers cut the unit interval, here multiples of the powers of 1/1.2207 (x⁴ = x
/// + 1), whose fractional parts are even in three dimensions.
std::array<double, 4> even_weights(std::size_t n) {
  constexpr double root = 1.2207440846057596;
  std::array<double, 3> cut{1 / root, 1 / (root * root), 1 / (root * root * root)};
  for (double& x : cut) {
    x *= static_cast<double>(n);
    x -= std::floor(x);
  }
  std::sort(cut.begin(), cut.end());
  return {cut[0], cut[1] - cut[0], cut[2] - cut[1], 1 - cut[2]};
}

double volume_of(const TetrahedralMesh& mesh, const Tetrahedron& tetrahedron) {
  const auto point = [&](int i) { return mesh.points()[static_cast<std::size_t>(tetrahedron[i])]; };
  const Vec3<double> a = point(0);
  return std::abs(dot(point(1) - a, cross(point(2) - a, point(3) - a))) / 6;
}

}  // namespace

std::vector<double> value_sample(const MeshChannels& channels) {
  const TetrahedralMesh& mesh = channels.mesh();
  std::vector<double> sample;
  sample.reserve(max_places);
  const double every = mesh.statistics().volume / static_cast<double>(max_places);
  double next = every / 2, passed = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra().size() && every > 0; ++t) {
    const Tetrahedron& tetrahedron = mesh.tetrahedra()[t];
    passed += volume_of(mesh, tetrahedron);
    for (; next < passed && sample.size() < max_places; next += every) {
      double value = 0;
      if (channels[0].centering == Centering::cell) {
        value = channels.value(0, t);
      } else {
        const std::array<double, 4> weight = even_weights(sample.size());
        for (int i = 0; i < 4; ++i) {
          value += weight[static_cast<std::size_t>(i)] *
                   channels.value(0, static_cast<std::size_t>(tetrahedron[i]));
        }
      }
      if (!std::isnan(value))
        sample.push_back(std::clamp(value, -largest_data_value, largest_data_value));
    }
  }
  return sorted(std::move(sample));
}

}  // namespace pellucid
