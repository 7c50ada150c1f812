// SPDX-License-Identifier: Apache-2.0
//
// The matrix: https://nipy.org/nibabel/coordinate_systems.html.
#include "positions_beside.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "axis_role.h"
#include "nifti/ras_affine.h"
#include "position_names.h"
#include "text/text.h"

namespace pellucid {

namespace {

bool is_matrix(const ArrayBeside& array) {
  return array.shape.size() == 2 && (array.shape[0] == 4 || array.shape[0] == 3) &&
         array.shape[1] == 4;
}

std::int64_t count_of(const ArrayBeside& array) {
  constexpr std::int64_t largest = std::int64_t{1} << 30;
  std::int64_t count = 1;
  for (const std::int64_t side : array.shape) {
    if (side > largest) return largest;
    count = std::min(count * side, largest);
  }
  return count;
}

bool is_coordinate(const ArrayBeside& array, std::span<const std::int64_t> shape) {
  return array.shape.size() == 1 && array.shape[0] > 1 &&
         std::ranges::find(shape, array.shape[0]) != shape.end() &&
         coordinate_role(array.name) != AxisRole::unknown;
}

/// Coordinates that change along several axes: X, Y and Z of numpy.meshgrid.
bool is_wide_coordinate(const ArrayBeside& array, std::span<const std::int64_t> shape) {
  constexpr auto names = std::to_array<std::string_view>(
      {"x", "y", "z", "xx", "yy", "zz", "xc", "yc", "zc", "lon", "lat", "longitude", "latitude"});
  if (array.shape.size() < 2 || !is_among(names, in_small_letters(array.name))) return false;
  return std::ranges::all_of(array.shape, [&](std::int64_t side) {
    return side == 1 || std::ranges::find(shape, side) != shape.end();
  });
}

/// Returns whether an array holds the coordinates of all axes or points, of any size.
bool is_list_of_coordinates(const ArrayBeside& array) {
  constexpr auto names = std::to_array<std::string_view>(
      {"coords", "coordinates", "gridcoords", "gridcoordinates", "positions"});
  return is_among(names, parts_of(array.name).bare);
}

bool is_finite(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

/// Returns whether positions are finite and in order, upwards or downwards.
bool is_in_order(std::span<const double> positions) {
  return is_finite(positions) &&
         (std::ranges::adjacent_find(positions, std::greater_equal<>{}) == positions.end() ||
          std::ranges::adjacent_find(positions, std::less_equal<>{}) == positions.end());
}

bool is_evenly(std::span<const double> numbers, double value) {
  return std::ranges::all_of(numbers, [&](double number) { return number == value; });
}

std::string number_text(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", number);
  return text.data();
}

std::string numbers_text(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + number_text(number);
  return text;
}

/// Takes arrays for positions, one after the other.
class Reader {
 public:
  Reader(std::span<const ArrayBeside> arrays, std::span<const std::int64_t> shape,
         const KnownAxes& axes)
      : arrays_(arrays), shape_(shape), axes_(axes), is_said_(axes.is_said) {
    found_.space = axes.space;
  }

  PositionsBeside read() {
    if (!axes_.is_placed && !read_matrix()) {
      read_coordinates();
      read_distances();
    }
    read_times();
    tell_others();
    return std::move(found_);
  }

 private:
  bool is_taken(const ArrayBeside& array) const {
    return std::ranges::find(taken_, &array) != taken_.end();
  }
  void tell(const std::string& text) { found_.notes.push_back("its " + text); }

  /// Returns whether there is a matrix that places the array.
  bool read_matrix() {
    for (const ArrayBeside& array : arrays_) {
      const NameParts parts = parts_of(array.name);
      if (!says_matrix(parts) || !is_matrix(array) || array.is_of_several) continue;
      const std::vector<double>& m = array.numbers;
      const bool is_whole = m.size() == static_cast<std::size_t>(4 * array.shape[0]);
      const bool ends_well =
          array.shape[0] == 3 || (is_whole && m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1);
      if (!is_whole || !is_finite(m) || !ends_well || !take_matrix(m, parts)) continue;
      taken_.push_back(&array);
      tell("array " + array.name + " places it, as nibabel does: from indices in the order of " +
           "the array's axes, " + order_text() + ", to " +
           (is_lps(parts) ? "left, posterior" : "right, anterior") + " and superior");
      return true;
    }
    return false;
  }

  static bool is_lps(const NameParts& parts) { return parts.bare == "ijktolps"; }

  bool take_matrix(const std::vector<double>& m, const NameParts& parts) {
    std::array<std::size_t, 3> space = found_.space;
    // The first index is x, unless somebody says otherwise.
    if (!is_said_) std::ranges::sort(space);
    std::array<std::size_t, 3> sorted = space;
    std::ranges::sort(sorted);
    RasRows rows{};
    for (std::size_t row = 0; row < 3; ++row) {
      const double sign = is_lps(parts) && row < 2 ? -1 : 1;
      for (std::size_t a = 0; a < 3; ++a) {
        const auto column =
            static_cast<std::size_t>(std::ranges::find(sorted, space[a]) - sorted.begin());
        rows[row][a] = sign * m[4 * row + column];
      }
      rows[row][3] = sign * m[4 * row + 3];
    }
    const GridPlacement placement = placement_from_ras(rows);
    const auto& column = placement.direction.column;
    const double volume = dot(cross(column[0], column[1]), column[2]);
    constexpr double flat = 1e-6;
    if (!(std::abs(volume) > flat)) return false;
    found_.space = space;
    found_.placement = placement;
    return true;
  }

  /// Returns "x, y, z" of the array's axes.
  std::string order_text() const {
    std::vector<std::pair<std::size_t, char>> axes;
    for (std::size_t a = 0; a < 3; ++a) axes.emplace_back(found_.space[a], axis_letters[a]);
    std::ranges::sort(axes);
    std::string text;
    for (const auto& [axis, letter] : axes)
      text += (text.empty() ? "" : ", ") + std::string(1, letter);
    return text;
  }

  using Coordinates = std::array<const ArrayBeside*, 3>;

  Coordinates coordinates() const {
    Coordinates of{};
    for (const ArrayBeside& array : arrays_) {
      if (array.numbers.empty() || !is_coordinate(array, shape_)) continue;
      const AxisRole role = coordinate_role(array.name);
      if (role == AxisRole::time || !is_in_order(array.numbers)) continue;
      const std::size_t a = role == AxisRole::x ? 0 : role == AxisRole::y ? 1 : 2;
      const bool is_letter = in_small_letters(array.name) == std::string(1, axis_letters[a]);
      if (of[a] == nullptr || is_letter) of[a] = &array;
    }
    return of;
  }

  bool fits(const Coordinates& of, const std::array<std::size_t, 3>& space) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (of[a] != nullptr && of[a]->shape[0] != shape_[space[a]]) return false;
    }
    return true;
  }

  /// Returns the axes that the lengths of coordinates fit; nothing where there are none.
  std::optional<std::array<std::size_t, 3>> fitting(const Coordinates& of, bool& is_open) const {
    const std::array<std::size_t, 3>& given = found_.space;
    const std::array<std::size_t, 3> turned{given[2], given[1], given[0]};
    is_open = false;
    if (fits(of, given)) {
      const bool is_same = of[0] != nullptr && of[2] != nullptr && of[0]->numbers == of[2]->numbers;
      is_open = !is_said_ && !is_same && fits(of, turned);
      return given;
    }
    if (is_said_) return std::nullopt;
    if (fits(of, turned)) return turned;
    std::optional<std::array<std::size_t, 3>> only;
    std::array<std::size_t, 3> space = given;
    std::ranges::sort(space);
    do {
      if (!fits(of, space)) continue;
      if (only) return std::nullopt;
      only = space;
    } while (std::ranges::next_permutation(space).found);
    return only;
  }

  void read_coordinates() {
    const Coordinates of = coordinates();
    if (of == Coordinates{}) return;
    bool is_open = false;
    const auto space = fitting(of, is_open);
    if (!space) return;
    std::string list;
    for (std::size_t a = 0; a < 3; ++a) {
      if (of[a] == nullptr) continue;
      AxisPositions& positions = found_.positions[a];
      AxisText text;
      text.name = of[a]->name;
      positions = positions_along(text);
      positions.numbers = of[a]->numbers;
      positions.units = of[a]->units;
      constexpr double float_rounding = 0x1p-24;
      positions.rounding = float_rounding;
      taken_.push_back(of[a]);
      list += (list.empty() ? "" : ", ") + of[a]->name;
    }
    found_.space = *space;
    tell("arrays " + list + " place it; its axes are " + order_text() +
         (is_open ? ", which the arrays' lengths do not tell; give axes (--axes) if they are others"
                  : ""));
  }

  /// Returns the three numbers of an array along x, y and z; nothing where their order is not
  /// plain.
  std::optional<std::array<double, 3>> along_axes(const ArrayBeside& array,
                                                  const NameParts& parts) const {
    const std::vector<double>& n = array.numbers;
    if (n.size() == 1) return std::array{n[0], n[0], n[0]};
    if (n.size() != 3) return std::nullopt;
    const bool is_zyx =
        parts.order == "zyx" || (parts.bare == "elementsize" && parts.units == "um");
    if (is_zyx) return std::array{n[2], n[1], n[0]};
    if (parts.order == "xyz" || n[0] == n[2]) return std::array{n[0], n[1], n[2]};
    return std::nullopt;
  }

  void tell_order(const ArrayBeside& array, const char* option) {
    tell("array " + array.name + " (" + numbers_text(array.numbers) +
         ") does not say whether it begins with x or with z, and is not applied; give " + option);
    taken_.push_back(&array);
  }

  static bool is_usable(const ArrayBeside& array) {
    return !array.is_of_several && !array.numbers.empty() && is_finite(array.numbers);
  }

  /// Takes spacings and origins of all axes, then those of one axis.
  void read_distances() {
    std::array<std::optional<double>, 3> spacing, origin;
    std::string list, units;
    const auto take = [&](const ArrayBeside& array, const NameParts& parts) {
      taken_.push_back(&array);
      list += (list.empty() ? "" : ", ") + array.name;
      if (units.empty()) units = array.units.empty() ? parts.units : array.units;
    };
    bool is_refused = false;
    for (const ArrayBeside& array : arrays_) {
      const NameParts parts = parts_of(array.name);
      if (!is_usable(array) || parts.axis || !says_spacing(parts)) continue;
      if (!std::ranges::all_of(array.numbers, [](double n) { return n > 0; })) continue;
      const auto along = along_axes(array, parts);
      if (!along && array.numbers.size() == 3) {
        tell_order(array, "--spacing");
        is_refused = true;
      }
      if (!along) continue;
      if (is_evenly(*along, 1) && parts.units.empty() && array.units.empty()) {
        taken_.push_back(&array);  // as without it
        continue;
      }
      if (!spacing[0]) {
        std::ranges::copy(*along, spacing.begin());
        take(array, parts);
      }
    }
    for (const ArrayBeside& array : arrays_) {
      const NameParts parts = parts_of(array.name);
      std::size_t axis = 0;
      const AlongOne what = along_one(parts, axis);
      if (what == AlongOne::none || array.numbers.size() != 1 || !is_usable(array)) continue;
      const double number = array.numbers[0];
      auto& of = what == AlongOne::spacing ? spacing[axis] : origin[axis];
      if (of || (what == AlongOne::spacing && !(number > 0))) continue;
      of = number;
      take(array, parts);
    }
    for (const ArrayBeside& array : arrays_) {
      const NameParts parts = parts_of(array.name);
      if (!is_usable(array) || parts.axis || !says_origin(parts)) continue;
      if (array.numbers.size() != 3) continue;
      if (is_evenly(array.numbers, 0)) {
        taken_.push_back(&array);
        continue;
      }
      const auto along = along_axes(array, parts);
      if (!along) tell_order(array, "--origin");
      if (!along || is_refused || origin[0]) continue;
      std::ranges::copy(*along, origin.begin());
      take(array, parts);
    }
    if (list.empty()) return;
    for (std::size_t a = 0; a < 3; ++a) {
      AxisPositions& positions = found_.positions[a];
      if ((!spacing[a] && !origin[a]) || !positions.numbers.empty()) continue;
      const auto side = static_cast<std::size_t>(shape_[found_.space[a]]);
      positions.name = list;
      positions.units = units;
      for (std::size_t i = 0; i < side; ++i) {
        positions.numbers.push_back(origin[a].value_or(0) +
                                    static_cast<double>(i) * spacing[a].value_or(1));
      }
    }
    tell("arrays " + list + " place it; its axes are " + order_text());
  }

  /// Reads the coordinates of the fourth axis.
  void read_times() {
    if (!axes_.components) return;
    for (const ArrayBeside& array : arrays_) {
      if (coordinate_role(array.name) != AxisRole::time || array.shape.size() != 1) continue;
      const std::int64_t times = array.shape[0], steps = shape_[*axes_.components];
      if (times != steps) {
        if (times < 2) continue;
        tell("array " + array.name + " has " + std::to_string(times) + " times, and the fourth " +
             "axis " + std::to_string(steps) + " values; it is not read");
        taken_.push_back(&array);
        continue;
      }
      const auto is_missing = [](double number) { return !std::isfinite(number); };
      if (std::ranges::all_of(array.numbers, is_missing)) continue;
      // Steps whose time is missing are never the nearest.
      found_.times = array.numbers;
      std::ranges::replace_if(found_.times, is_missing, std::numeric_limits<double>::quiet_NaN());
      taken_.push_back(&array);
      return;
    }
  }

  /// Tells of arrays that speak of places, and say nothing that is plain.
  void tell_others() {
    std::string list, wide;
    for (const ArrayBeside& array : arrays_) {
      if (is_taken(array)) continue;
      if (is_wide_coordinate(array, shape_)) {
        wide += (wide.empty() ? "" : ", ") + array.name;
      } else if (is_coordinate(array, shape_) || is_list_of_coordinates(array) ||
                 (count_of(array) <= most_beside && speaks_of_places(parts_of(array.name)))) {
        list += (list.empty() ? "" : ", ") + array.name;
      }
    }
    if (!list.empty()) {
      tell("arrays " + list.substr(0, 200) +
           " may place or scale it and are not applied; give --spacing and --origin");
    }
    if (!wide.empty()) {
      tell("coordinates " + wide.substr(0, 200) +
           ", which change along several axes, are left out; give --spacing and --origin");
    }
  }

  std::span<const ArrayBeside> arrays_;
  std::span<const std::int64_t> shape_;
  KnownAxes axes_;
  bool is_said_;
  PositionsBeside found_;
  std::vector<const ArrayBeside*> taken_;  ///< that are spoken of
};

}  // namespace

bool may_say_positions(const ArrayBeside& array, std::span<const std::int64_t> shape) {
  if (is_coordinate(array, shape)) return true;
  return array.shape.size() <= 2 && count_of(array) <= most_beside &&
         speaks_of_places(parts_of(array.name));
}

PositionsBeside positions_beside(std::span<const ArrayBeside> arrays,
                                 std::span<const std::int64_t> shape, const KnownAxes& axes) {
  return Reader(arrays, shape, axes).read();
}

}  // namespace pellucid
