// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/stretch_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "finite.h"
#include "message.h"
#include "moved_source.h"
#include "pellucid/geometry/box_around.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/box_corners.h"
#include "readable_numbers.h"

namespace pellucid {
namespace {

[[noreturn]] void fail(const StretchSource::Description& description, const std::string& what) {
  throw Error((description.name.empty() ? "stretch source" : description.name) + ": " + what);
}

void check(const StretchSource::Description& d) {
  const auto& [lower, upper] = d.bounds;
  const bool has_volume = lower.x < upper.x && lower.y < upper.y && lower.z < upper.z;
  if (!is_finite(lower) || !is_finite(upper) || !has_volume) {
    fail(d, "the bounds go from " + tuple(lower) + " to " + tuple(upper) +
                ", but must be finite and ascend along each axis");
  }
  if (d.variables.empty() || d.variables.size() > std::size_t{max_channels}) {
    fail(d, "there are " + std::to_string(d.variables.size()) +
                " variables, but there must be from 1 to " + std::to_string(max_channels));
  }
  for (const StretchSource::Variable& variable : d.variables) {
    if (variable.name.empty()) fail(d, "a variable has no name; give it one");
    if (!(variable.minimum <= variable.maximum) ||
        !(std::max(-variable.minimum, variable.maximum) <= largest_data_value)) {
      fail(d, "the variable " + variable.name + " goes from " + number(variable.minimum) + " to " +
                  number(variable.maximum) + ", but must go up, within ±2.1e37");
    }
  }
  if (!(d.voxel_size > 0) || !std::isfinite(d.voxel_size)) {
    fail(d, "the voxel size is " + number(d.voxel_size) + ", but must be positive and finite");
  }
}

/// The streams of a source in its own world, seen from another one.
class MovedStream : public StretchStream {
 public:
  MovedStream(std::unique_ptr<StretchStream> own, const Affine<double>& from_world,
              const StretchDemand& demand)
      : own_(std::move(own)), from_world_(from_world), demand_(demand) {}

  Interval<double> start(const Ray<double>& ray) override {
    Ray<double> there = from_world_.ray(ray);
    scale_ = length(there.direction);
    there.direction = there.direction * (1 / scale_);
    // A few roundings of the map, and of what it maps.
    const Mat3<double>& m = from_world_.matrix;
    double size = length(from_world_.translation);
    for (int a = 0; a < 3; ++a) size += length(m.column[a]) * std::abs(ray.origin[a]);
    origin_error_ = 16 * rounding * size / scale_;
    const auto [begin, end] = own_->start(there);
    return {begin / scale_, end / scale_};
  }
  void restrict_to_range(Interval<double> range) override {
    own_->restrict_to_range({range.begin * scale_, range.end * scale_});
  }
  bool next(FieldStretch& stretch) override {
    if (!own_->next(stretch)) return false;
    stretch.begin /= scale_;
    stretch.end /= scale_;
    stretch.position_error =
        stretch.position_error / scale_ + origin_error_ + 16 * rounding * std::abs(stretch.end);
    // The gradient is a covector; what light may ignore of it grows as it does at most.
    const Mat3<double>& m = from_world_.matrix;
    if (demand_.gradient >= 0) {
      for (int k = 0; k < 4; ++k) {
        const Vec3<double> own{stretch.gradient[0].b[k], stretch.gradient[1].b[k],
                               stretch.gradient[2].b[k]};
        for (int a = 0; a < 3; ++a) stretch.gradient[a].b[k] = dot(m.column[a], own);
      }
      stretch.gradient_error *=
          length(Vec3<double>{length(m.column[0]), length(m.column[1]), length(m.column[2])});
    }
    if (demand_.magnitude >= 0) {
      for (double& b : stretch.magnitude.b) b *= length(m.column[0]);
    }
    return true;
  }

 private:
  static constexpr double rounding = 0x1p-53;

  std::unique_ptr<StretchStream> own_;
  const Affine<double> from_world_;
  const StretchDemand demand_;
  double scale_ = 1, origin_error_ = 0;
};

class MovedSource : public StretchSource {
 public:
  MovedSource(std::shared_ptr<const StretchSource> own, const Affine<double>& to)
      : StretchSource(moved(own->description(), to)),
        own_(std::move(own)),
        from_world_(inverse(to)) {}

  std::unique_ptr<StretchStream> stream(const StretchDemand& demand) const override {
    std::unique_ptr<StretchStream> own = own_->stream(demand);
    if (own == nullptr) return nullptr;
    return std::make_unique<MovedStream>(std::move(own), from_world_, demand);
  }

 private:
  static Description moved(Description description, const Affine<double>& to) {
    description.bounds = box_around(box_corners(description.bounds, to));
    description.voxel_size *= std::cbrt(std::abs(determinant(to.matrix)));
    return description;
  }

  const std::shared_ptr<const StretchSource> own_;
  const Affine<double> from_world_;
};

}  // namespace

StretchSource::StretchSource(Description description) : description_(std::move(description)) {
  check(description_);
}

std::shared_ptr<const StretchSource> moved_source(std::shared_ptr<const StretchSource> source,
                                                  const Affine<double>& to) {
  return std::make_shared<const MovedSource>(std::move(source), to);
}

bool keeps_angles(const Mat3<double>& matrix) noexcept {
  const double size = length(matrix.column[0]);
  const auto near = [&](double x, double wanted) {
    return std::abs(x - wanted) <= 1e-9 * size * size;
  };
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      const double product = dot(matrix.column[a], matrix.column[b]);
      if (!near(product, a == b ? size * size : 0)) return false;
    }
  }
  return true;
}

}  // namespace pellucid
