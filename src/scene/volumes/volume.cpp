// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/volume.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "blocks/volume_blocks.h"
#include "blocks/volume_scan.h"
#include "message.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/box_corners.h"
#include "volume_check.h"
#include "volume_noise.h"

namespace pellucid {
namespace {

constexpr std::array<std::string_view, std::variant_size_v<VolumeData>> type_names{
    "u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64"};

template <std::size_t... I>
VolumeData make_data(std::size_t index, std::size_t count, std::index_sequence<I...>) {
  VolumeData data;
  ((index == I ? static_cast<void>(data.emplace<I>(count)) : static_cast<void>(0)), ...);
  return data;
}

std::size_t data_size(const VolumeData& data) {
  return std::visit([](const auto& values) { return values.size(); }, data);
}

/// Returns the planes of a rectilinear axis (GridAxis): the coordinates themselves where the values
/// are points; first face, centres, last face where they are cells.
std::vector<double> make_planes(const std::vector<double>& coordinates, Centering centering) {
  if (coordinates.empty() || centering == Centering::point) return coordinates;
  std::vector<double> planes{coordinates.front()};
  for (std::size_t i = 0; i + 1 < coordinates.size(); ++i) {
    planes.push_back(std::midpoint(coordinates[i], coordinates[i + 1]));
  }
  planes.push_back(coordinates.back());
  return planes;
}

/// Returns the inverse of m, or nothing where its columns are parallel or vanish. The columns are
/// scaled to length 1 first, so that no unit of length is too small or too large.
std::optional<Mat3<double>> checked_inverse(const Mat3<double>& m) {
  Mat3<double> unit;
  std::array<double, 3> norm;
  for (int a = 0; a < 3; ++a) {
    const Vec3<double>& c = m.column[a];
    const double n = std::hypot(c.x, c.y, c.z);
    norm[static_cast<std::size_t>(a)] = n;
    unit.column[a] = {c.x / n, c.y / n, c.z / n};
  }
  // Below this volume of the unit columns, positions would keep fewer than half of a double's
  // digits. A NaN (a column of length 0) is refused as well.
  const double smallest = std::sqrt(std::numeric_limits<double>::epsilon());
  if (!(std::abs(determinant(unit)) > smallest)) return std::nullopt;
  Mat3<double> inv = inverse(unit);
  for (Vec3<double>& column : inv.column) {
    column = {column.x / norm[0], column.y / norm[1], column.z / norm[2]};
  }
  return inv;
}

}  // namespace

std::string_view type_name(const VolumeData& data) noexcept {
  return type_names[data.index()];
}

VolumeData make_volume_data(std::string_view type_name, std::size_t count) {
  const auto* const found = std::find(type_names.begin(), type_names.end(), type_name);
  if (found == type_names.end()) {
    throw Error("data type \"" + std::string(type_name) +
                "\" is unknown; use u8, i8, u16, i16, u32, i32, f32 or f64");
  }
  return make_data(static_cast<std::size_t>(found - type_names.begin()), count,
                   std::make_index_sequence<type_names.size()>());
}

Volume::Volume(Description description, VolumeData data)
    : description_(std::move(description)),
      data_(std::move(data)),
      blocks_(std::make_shared<VolumeBlocks>()),
      noise_(std::make_shared<VolumeNoise>()) {
  const VolumeCheck check(description_);
  check.dimensions(data_size(data_));
  place(check);
  const VolumeScan s =
      std::visit([](const auto& values) { return scan(std::span(values)); }, data_);
  statistics_ = s.statistics;
  if (statistics_.infinite > 0) {
    check.fail(std::to_string(statistics_.infinite) + " infinite value" +
               (statistics_.infinite == 1 ? "" : "s") + ", the first at index " +
               check.position_text(s.first_infinite) +
               "; replace by finite numbers, or by NaN for empty space");
  }
  if (s.large) {
    check.fail("the value at index " + check.position_text(s.first_large) + " is beyond " +
               number(largest_value) + " in magnitude, more than float arithmetic carries; " +
               "rescale the data, or replace by NaN where it marks empty space");
  }
}

void Volume::place(const VolumeCheck& check) {
  check.placement();
  const GridPlacement& placement = description_.placement;
  world_from_grid_.translation = placement.origin;
  double shortest[3];
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    check.coordinates(axis);
    const std::vector<double>& c = description_.coordinates[axis];
    plane_position_[axis] = make_planes(c, description_.centering);
    const std::vector<double>& planes = plane_position_[axis];
    if (std::adjacent_find(planes.begin(), planes.end(), std::greater_equal<>()) != planes.end()) {
      check.fail(std::string("coordinates along ") + axis_names[axis] +
                 ": two neighbours have no double between them; spread them");
    }
    shortest[a] = 1;
    for (std::size_t i = 1; i < c.size(); ++i) {
      shortest[a] = i == 1 ? c[1] - c[0] : std::min(shortest[a], c[i] - c[i - 1]);
    }
    world_from_grid_.matrix.column[a] =
        placement.direction.column[a] * (c.empty() ? placement.spacing[a] : 1.0);
  }

  const std::optional<Mat3<double>> inv = checked_inverse(world_from_grid_.matrix);
  if (!inv) {
    check.fail("direction is singular, with columns " + tuple(placement.direction.column[0]) +
               ", " + tuple(placement.direction.column[1]) + ", " +
               tuple(placement.direction.column[2]) +
               "; its columns must be three independent axes");
  }
  grid_from_world_ = {*inv, -(*inv * world_from_grid_.translation)};

  bool in_range = VolumeCheck::finite(grid_from_world_.translation);
  voxel_size_ = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const Vec3<double>& column = world_from_grid_.matrix.column[a];
    voxel_size_ = std::min(voxel_size_, shortest[a] * std::hypot(column.x, column.y, column.z));
    in_range = in_range && VolumeCheck::finite(grid_from_world_.matrix.column[a]);
  }
  for (const Vec3<double>& corner : world_corners())
    in_range = in_range && VolumeCheck::finite(corner);
  if (!in_range || !(voxel_size_ > 0 && std::isfinite(voxel_size_))) {
    check.fail("origin, spacing and direction place the box beyond the range of double; " +
               std::string("use another unit of length"));
  }
}

Volume Volume::moved(const Affine<double>& transform) const {
  Volume result = *this;
  GridPlacement& placement = result.description_.placement;
  placement.origin = transform.point(placement.origin);
  for (Vec3<double>& column : placement.direction.column) column = transform.vector(column);
  result.place(VolumeCheck(result.description_));
  return result;
}

Volume Volume::as_part_of(double minimum, double maximum) const {
  if (statistics_.finite > 0 && (minimum > statistics_.minimum || maximum < statistics_.maximum)) {
    VolumeCheck(description_)
        .fail("values from " + number(statistics_.minimum) + " to " + number(statistics_.maximum) +
              " are no part of data from " + number(minimum) + " to " + number(maximum));
  }
  Volume result = *this;
  result.statistics_.minimum = minimum;
  result.statistics_.maximum = maximum;
  result.noise_ = std::make_shared<VolumeNoise>();
  return result;
}

const ValueNoise& Volume::noise() const {
  const std::scoped_lock lock(noise_->building);
  if (!noise_->found) noise_->found.emplace(*this);
  return *noise_->found;
}

Histogram Volume::histogram(int bins) const {
  if (bins < 1) {
    throw Error("histogram: bins is " + std::to_string(bins) + ", but must be at least 1");
  }
  Histogram h{statistics_.minimum, statistics_.maximum,
              std::vector<std::uint64_t>(static_cast<std::size_t>(bins))};
  std::visit([&](const auto& values) { fill_histogram(std::span(values), h); }, data_);
  return h;
}

GridAxis<double> Volume::axis(int a) const noexcept {
  const auto i = static_cast<std::size_t>(a);
  return {plane_position_[i].empty() ? nullptr : plane_position_[i].data(),
          description_.dimensions[i], description_.centering == Centering::cell ? 1 : 0};
}

Vec3<double> Volume::grid_lower() const noexcept {
  return {axis(0).plane(0), axis(1).plane(0), axis(2).plane(0)};
}

Vec3<double> Volume::grid_upper() const noexcept {
  return {axis(0).plane(axis(0).cells()), axis(1).plane(axis(1).cells()),
          axis(2).plane(axis(2).cells())};
}

std::array<Vec3<double>, 8> Volume::world_corners() const noexcept {
  return box_corners({grid_lower(), grid_upper()}, world_from_grid_);
}

}  // namespace pellucid
