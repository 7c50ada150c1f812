// SPDX-License-Identifier: Apache-2.0
#include "import_ways.h"

#include <algorithm>

#include "pellucid/scene/error.h"

namespace pellucid::imported {
namespace {

/// Samples, and others that what they make is held against.
constexpr int found_by = 131'073, held_against = 50'021;
/// Changes of a color from sample to sample that are alike, in units of the numbers.
constexpr double alike = 1e-12;

std::vector<Rgb<double>> sampled(const SampleWay& sample, const Rgb<double>& from,
                                 const Rgb<double>& to, int count) {
  std::vector<Rgb<double>> colors = sample(from, to, count);
  if (colors.size() != static_cast<std::size_t>(count)) {
    throw Error("colors: VTK gives no colors of CIEDE2000");
  }
  return colors;
}

Rgb<double> color_at(const std::vector<WayPoint>& corners, std::size_t& place, double share) {
  while (place + 2 < corners.size() && corners[place + 1].share < share) ++place;
  const WayPoint &a = corners[place], &b = corners[place + 1];
  return a.color + (share - a.share) / (b.share - a.share) * (b.color - a.color);
}

}  // namespace

MeasuredWay measured_way(const Rgb<double>& from, const Rgb<double>& to, const SampleWay& sample) {
  const std::vector<Rgb<double>> c = sampled(sample, from, to, found_by);
  constexpr double scale = found_by - 1;
  MeasuredWay way;
  way.corners.push_back({0, c.front()});
  const auto changes_alike = [&](std::size_t i) {
    return largest_component((c[i + 1] - c[i]) - (c[i] - c[i - 1])) <= alike;
  };
  for (std::size_t i = 1; i + 1 < c.size(); ++i) {
    if (!changes_alike(i)) way.corners.push_back({static_cast<double>(i) / scale, c[i]});
  }
  way.corners.push_back({1, c.back()});
  // Between neighboring corners lies a step, whose place is not known closer.
  for (std::size_t i = 1; i < way.corners.size(); ++i) {
    const WayPoint &a = way.corners[i - 1], &b = way.corners[i];
    if (b.share - a.share > 1.5 / scale) continue;
    way.deviation = std::max(way.deviation, largest_component(b.color - a.color));
  }
  const std::vector<Rgb<double>> others = sampled(sample, from, to, held_against);
  std::size_t place = 0;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const double share = static_cast<double>(i) / (held_against - 1);
    way.deviation =
        std::max(way.deviation, largest_component(color_at(way.corners, place, share) - others[i]));
  }
  return way;
}

}  // namespace pellucid::imported
