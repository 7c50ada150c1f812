// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "array_axes.h"
#include "axis_role.h"

// The meaning of axes that have names: by the attributes of the CF conventions, else by the names
// that models and programs give them. NetCDF, HDF5 and Zarr share it. Needs pellucid::scene alone.

namespace pellucid {

/// The axes of a volume among those of an array.
struct NamedAxes {
  std::array<std::optional<std::size_t>, 3> space;  ///< x, y, z
  std::optional<std::size_t> time;                  ///< also where it has one entry
  std::vector<std::size_t> components;  ///< axes beside x, y and z, in the order of the file
  std::vector<std::size_t> unknown;     ///< axes without a meaning that are left over
  std::vector<std::size_t> by_place;    ///< axes without a meaning that became x, y or z
  std::vector<AxisRole> roles;
  bool is_twofold = false;  ///< whether two axes are the same of x, y and z
  bool is_known = false;    ///< whether any axis has a meaning
};

/// Returns the axes by their meaning. Axes without one fill what is missing of x, y and z, the last
/// of them first. Two axes of one meaning have it by their attributes, else neither has.
NamedAxes named_axes(std::span<const AxisText> axes, std::span<const std::int64_t> shape);

/// The axes of a volume with its components, and what a user should know of them.
struct VolumeAxes {
  std::array<std::size_t, 3> space{};   ///< x, y, z
  std::vector<std::size_t> components;  ///< axes of several entries, the last one fastest
  std::optional<std::size_t> time;
  std::string holds;               ///< "3 members (axis number) of 6 steps (axis time)"
  std::vector<std::string> notes;  ///< each begins with "its axis" or "its axes"

  int component_count(std::span<const std::int64_t> shape) const;
  /// Components inside one step in time.
  int components_of_a_step(std::span<const std::int64_t> shape) const;
  /// Sets the indices along the axes of components to those of one component.
  template <class Index>
  void set_component(std::span<Index> start, std::span<const std::int64_t> shape,
                     int component) const {
    for (std::size_t i = components.size(); i-- > 0;) {
      const std::int64_t side = shape[components[i]];
      start[components[i]] = static_cast<Index>(component % side);
      component = static_cast<int>(component / side);
    }
  }
};

/// Returns the axes of a volume by their meaning; nothing where no axis has one. Throws Error, "an
/// array whose axis time is time and not z: ...", where they are those of no volume.
std::optional<VolumeAxes> volume_axes(std::span<const AxisText> axes,
                                      std::span<const std::int64_t> shape);
/// Returns the same of axes that have no meaning.
VolumeAxes volume_axes(const ArrayAxes& axes, std::span<const std::int64_t> shape);

/// Positions along one axis, as a file has them.
struct AxisPositions {
  std::vector<double> numbers;  ///< empty: the file has none
  double rounding = 0;          ///< largest relative error that their type leaves them
  std::string name, units;      ///< of the coordinate
  bool down = false;            ///< whether they grow against the axis (positive: down)
  bool may_be_down = false;     ///< depths or pressures without the attribute
};

/// Returns positions without numbers: what the coordinate's attributes say of them.
AxisPositions positions_along(const AxisText& axis);

}  // namespace pellucid
