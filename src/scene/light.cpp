// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "enum_names.h"
#include "finite.h"
#include "message.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

TransferFunction factors(const std::vector<GradientOpacity::Point>& points, double unit) {
  std::vector<TransferFunction::Point> result;
  result.reserve(points.size());
  for (const GradientOpacity::Point& point : points) {
    result.push_back({point.gradient / unit, point.factor, {}});
  }
  return TransferFunction(std::move(result));
}

}  // namespace

void check_light(const Light& light, const std::string& where) {
  if (const auto* directional = std::get_if<DirectionalLight>(&light.kind)) {
    const Vec3<double>& d = directional->direction;
    if (!is_finite(d) || !(std::hypot(d.x, d.y, d.z) > 0) ||
        !std::isfinite(std::hypot(d.x, d.y, d.z))) {
      throw Error(where + ": direction is " + tuple(d) + ", but must be finite and not zero");
    }
  }
  if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    const Vec3<double>& p = point->position;
    if (!is_finite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 1e30) {
      throw Error(where + ": position is " + tuple(p) + ", but must be within 1e30 of the origin");
    }
  }
  for (const double channel : {light.color.r, light.color.g, light.color.b}) {
    if (!(channel >= 0 && channel <= 1e6)) {
      throw Error(where + ": a color is " + number(channel) + ", but must be from 0 to 1e6");
    }
  }
}

std::string_view gradient_kind_name(GradientKind kind) noexcept {
  return name_of(gradient_kind_names, kind);
}

GradientOpacity::GradientOpacity(std::vector<Point> points, Unit unit, ChannelRef channel)
    : points_(std::move(points)), unit_(unit), channel_(std::move(channel)) {
  try {
    factors(points_, 1);
  } catch (const Error& error) {
    throw Error("gradient opacity: " + std::string(error.what()));
  }
  for (const Point& point : points_) {
    if (!(point.gradient >= 0)) {
      throw Error("gradient opacity: a point is at gradient " + number(point.gradient) +
                  ", but magnitudes are 0 or more");
    }
    largest_ = std::max(largest_, point.factor);
  }
}

TransferFunction GradientOpacity::per_world(double voxel) const {
  return factors(points_, unit_ == Unit::voxel ? voxel : 1);
}

}  // namespace pellucid
