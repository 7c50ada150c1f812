// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "message.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

inline constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

/// The checks of a description: each throws with the volume's name in front.
class VolumeCheck {
 public:
  explicit VolumeCheck(const Volume::Description& description) : d_(description) {}

  void dimensions(std::size_t size) const {
    constexpr auto largest_count =
        static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / sizeof(double);
    std::size_t count = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const int n = d_.dimensions[a];
      if (n < 1 || n > std::numeric_limits<int>::max() - 2) {
        fail("dimensions are " + dimensions_text() + ", but each must be from 1 to " +
             std::to_string(std::numeric_limits<int>::max() - 2));
      }
      if (n < 2 && d_.centering == Centering::point) {
        fail("dimensions are " + dimensions_text() + ": a single value along " + axis_names[a] +
             " spans no cell when the values are points; use cell centering, or give at least two");
      }
      if (count > largest_count / static_cast<std::size_t>(n)) {
        fail("dimensions are " + dimensions_text() + ": more values than can be addressed");
      }
      count *= static_cast<std::size_t>(n);
    }
    if (size != count) {
      fail("dimensions " + dimensions_text() + " need " + std::to_string(count) +
           " values, but there are " + std::to_string(size));
    }
  }

  void placement() const {
    const GridPlacement& p = d_.placement;
    if (!finite(p.origin)) fail("origin is " + tuple(p.origin) + ", but must be finite");
    for (int a = 0; a < 3; ++a) {
      const bool rectilinear = !d_.coordinates[static_cast<std::size_t>(a)].empty();
      if (!rectilinear && !(p.spacing[a] > 0 && std::isfinite(p.spacing[a]))) {
        fail("spacing along " + std::string(axis_names[static_cast<std::size_t>(a)]) + " is " +
             number(p.spacing[a]) + ", but must be a positive number");
      }
      if (!finite(p.direction.column[a])) {
        fail("direction has a number that is not finite in its column " + std::to_string(a));
      }
    }
  }

  void coordinates(std::size_t a) const {
    const std::vector<double>& c = d_.coordinates[a];
    if (c.empty()) return;
    const bool cell = d_.centering == Centering::cell;
    const std::size_t expected = static_cast<std::size_t>(d_.dimensions[a]) + (cell ? 1 : 0);
    const std::string name = std::string("coordinates along ") + axis_names[a];
    if (c.size() != expected) {
      fail(name + ": there are " + std::to_string(c.size()) + ", but " +
           std::to_string(d_.dimensions[a]) + " values need " + std::to_string(expected) +
           (cell ? " (the faces of their cells)" : " (one for each)"));
    }
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (!std::isfinite(c[i])) {
        fail(name + ": number " + std::to_string(i) + " is " + number(c[i]) +
             ", but all must be finite");
      }
      if (i > 0 && !(c[i] > c[i - 1])) {
        fail(name + ": number " + std::to_string(i) + " is " + number(c[i]) + " after " +
             number(c[i - 1]) +
             ", but they must ascend; sort them (and the data) and drop repeats");
      }
    }
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error((d_.name.empty() ? "volume" : d_.name) + ": " + message);
  }

  std::string position_text(std::size_t offset) const {
    const auto nx = static_cast<std::size_t>(d_.dimensions[0]);
    const auto ny = static_cast<std::size_t>(d_.dimensions[1]);
    return std::string("(") + std::to_string(offset % nx) + ", " +
           std::to_string(offset / nx % ny) + ", " + std::to_string(offset / nx / ny) + ")";
  }

  static bool finite(const Vec3<double>& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  }

 private:
  std::string dimensions_text() const {
    return std::to_string(d_.dimensions[0]) + " x " + std::to_string(d_.dimensions[1]) + " x " +
           std::to_string(d_.dimensions[2]);
  }

  const Volume::Description& d_;
};

}  // namespace pellucid
