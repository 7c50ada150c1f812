// SPDX-License-Identifier: Apache-2.0
#include "vtk_cells.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// vtkCellType.h, of VTK 9: the types that have a volume.
enum VtkType : int {
  tetra = 10,
  voxel = 11,
  hexahedron = 12,
  wedge = 13,
  pyramid = 14,
  pentagonal_prism = 15,
  hexagonal_prism = 16,
  quadratic_tetra = 24,
  quadratic_hexahedron = 25,
  quadratic_wedge = 26,
  quadratic_pyramid = 27,
  triquadratic_hexahedron = 29,
  quadratic_linear_wedge = 31,
  biquadratic_quadratic_wedge = 32,
  biquadratic_quadratic_hexahedron = 33,
  triquadratic_pyramid = 37,
  convex_point_set = 41,
  polyhedron = 42,
  lagrange_tetrahedron = 71,
  lagrange_hexahedron = 72,
  lagrange_wedge = 73,
  lagrange_pyramid = 74,
  bezier_tetrahedron = 78,
  bezier_hexahedron = 79,
  bezier_wedge = 80,
  bezier_pyramid = 81
};

/// Returns whether cells of this type are surfaces, lines or points, or nothing.
bool is_flat(int type) {
  constexpr int flat[] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  21, 22, 23, 28, 30, 34,
                          35, 36, 51, 52, 53, 54, 60, 61, 62, 63, 68, 69, 70, 75, 76, 77};
  return std::ranges::find(flat, type) != std::end(flat);
}

/// Returns the shape of a type whose number of points is its own.
std::optional<CellShape> plain_shape(int type) {
  switch (type) {
    case tetra:
      return CellShape::tetrahedron;
    case voxel:
      return CellShape::voxel;
    case hexahedron:
      return CellShape::hexahedron;
    case wedge:
      return CellShape::wedge;
    case pyramid:
      return CellShape::pyramid;
    case quadratic_tetra:
      return CellShape::quadratic_tetrahedron;
    case quadratic_pyramid:
      return CellShape::quadratic_pyramid;
    case quadratic_wedge:
      return CellShape::quadratic_wedge;
    case quadratic_hexahedron:
      return CellShape::quadratic_hexahedron;
    case biquadratic_quadratic_wedge:
      return CellShape::biquadratic_wedge;
    case triquadratic_hexahedron:
      return CellShape::triquadratic_hexahedron;
    default:
      return std::nullopt;
  }
}

[[noreturn]] void refuse(const std::string& name, const std::string& remedy) {
  throw Error("there are cells of the type " + name + ", which are not read; " + remedy);
}

[[noreturn]] void refuse_type(int type) {
  constexpr const char* tetrahedralize =
      "cut them into tetrahedra first (ParaView: Tetrahedralize)";
  constexpr const char* linearize = "write the mesh with linear, quadratic or Lagrange cells";
  switch (type) {
    case convex_point_set:
      refuse("convex point set", tetrahedralize);
    case biquadratic_quadratic_hexahedron:
      refuse("biquadratic-quadratic hexahedron", linearize);
    case triquadratic_pyramid:
      refuse("triquadratic pyramid", linearize);
    case bezier_tetrahedron:
      refuse("Bezier tetrahedron", linearize);
    case bezier_hexahedron:
      refuse("Bezier hexahedron", linearize);
    case bezier_wedge:
      refuse("Bezier wedge", linearize);
    case bezier_pyramid:
      refuse("Bezier pyramid", linearize);
    default:
      refuse("number " + std::to_string(type), "correct the file, or take another kind of cell");
  }
}

/// Returns the order of a cell of so many points that has the same along each axis; 0: there is
/// none.
int uniform_order(CellShape shape, std::size_t points) {
  for (int order = 1;; ++order) {
    const int needed = lagrange_points(shape, {order, order, order});
    if (needed == 0 || static_cast<std::size_t>(needed) > points) return 0;
    if (static_cast<std::size_t>(needed) == points) return order;
  }
}

/// Returns the plain shape that a Lagrange cell of such orders is.
std::optional<CellShape> plain_shape(CellShape shape, const std::array<int, 3>& orders) {
  const bool linear = orders == std::array{1, 1, 1}, quadratic = orders == std::array{2, 2, 2};
  if (!linear && !quadratic) return std::nullopt;
  switch (shape) {
    case CellShape::lagrange_tetrahedron:
      return linear ? CellShape::tetrahedron : CellShape::quadratic_tetrahedron;
    case CellShape::lagrange_wedge:
      return linear ? CellShape::wedge : CellShape::biquadratic_wedge;
    default:
      return linear ? CellShape::hexahedron : CellShape::triquadratic_hexahedron;
  }
}

}  // namespace

bool VtkCells::add(std::int64_t cell, const VtkCell& given) {
  cell_ = cell;
  if (is_flat(given.type)) {
    ++file_.flat_cells;
    return false;
  }
  if (const auto shape = plain_shape(given.type)) {
    add_shape(*shape, given.points);
  } else if (given.type == pentagonal_prism || given.type == hexagonal_prism) {
    add_prism(given.points, given.type == pentagonal_prism ? 5 : 6);
  } else if (given.type == polyhedron) {
    add_polyhedron(given);
  } else if (given.type == quadratic_linear_wedge) {
    add_lagrange(CellShape::lagrange_wedge, {given.type, given.points, {}, {{2, 2, 1}}});
  } else if (given.type == lagrange_tetrahedron) {
    add_lagrange(CellShape::lagrange_tetrahedron, given);
  } else if (given.type == lagrange_hexahedron) {
    add_lagrange(CellShape::lagrange_hexahedron, given);
  } else if (given.type == lagrange_wedge) {
    add_lagrange(CellShape::lagrange_wedge, given);
  } else if (given.type == lagrange_pyramid) {
    // VTK has no pyramid of this kind; those of its other types are ordered alike.
    const std::size_t count = given.points.size();
    if (count != 5 && count != 13 && count != 14) {
      refuse("Lagrange pyramid of more than order 2",
             "VTK defines no order of its nodes; cut them into tetrahedra first");
    }
    add_shape(count == 5 ? CellShape::pyramid : CellShape::quadratic_pyramid, given.points);
  } else {
    refuse_type(given.type);
  }
  block_.cell_numbers.push_back(
      static_cast<std::int32_t>(static_cast<std::size_t>(cell) + first_number_));
  return true;
}

void VtkCells::add_points(std::span<const std::int64_t> points) {
  const auto count = static_cast<std::int64_t>(block_.points.size());
  for (const std::int64_t point : points) {
    if (point < 0 || point >= count) {
      throw Error("cell " + std::to_string(cell_) + " has the point " + std::to_string(point) +
                  ", but there are " + std::to_string(count) + damaged_file);
    }
    block_.corners.push_back(static_cast<std::int32_t>(point));
  }
}

void VtkCells::add_shape(CellShape shape, std::span<const std::int64_t> points) {
  const auto needed = static_cast<std::size_t>(point_count(shape));
  if (points.size() < needed) {
    throw Error("cell " + std::to_string(cell_) + " has " + std::to_string(points.size()) +
                " points, but one of its shape has " + std::to_string(needed) + damaged_file);
  }
  if (points.size() > needed) {
    if (file_.trimmed_cells++ == 0) {
      file_.first_trimmed_cell = static_cast<std::int64_t>(first_number_) + cell_;
    }
  }
  add_points(points.first(needed));
  block_.shapes.push_back(shape);
}

void VtkCells::add_lagrange(CellShape shape, const VtkCell& given) {
  const std::size_t count = given.points.size();
  std::array<int, 3> orders{};
  // Of tetrahedra and wedges one stands for two or three axes.
  const auto same = [&](std::array<int, 3> of) {
    if (shape != CellShape::lagrange_hexahedron) of[1] = of[0];
    if (shape == CellShape::lagrange_tetrahedron) of[2] = of[0];
    return of;
  };
  constexpr std::size_t tetrahedron_with_middles = 15, wedge_with_middles = 21;
  const bool with_middles =
      (shape == CellShape::lagrange_tetrahedron && count == tetrahedron_with_middles) ||
      (shape == CellShape::lagrange_wedge && count == wedge_with_middles);
  if (given.orders &&
      static_cast<std::size_t>(lagrange_points(shape, same(*given.orders))) == count) {
    orders = same(*given.orders);
  } else if (with_middles) {
    orders = {2, 2, 2};
  } else if (const int order = uniform_order(shape, count); order > 0) {
    orders = {order, order, order};
  } else {
    throw Error("cell " + std::to_string(cell_) + " has " + std::to_string(count) +
                " points, as no Lagrange cell of its shape has; where its orders differ from axis "
                "to axis, the cells need an array HIGHER_ORDER_DEGREES that says them");
  }
  if (const auto plain = plain_shape(shape, orders); plain && !with_middles) {
    add_shape(*plain, given.points);
    return;
  }
  add_points(given.points);
  block_.shapes.push_back(shape);
  block_.layouts.insert(block_.layouts.end(),
                        {static_cast<std::int32_t>(count), orders[0], orders[1], orders[2]});
}

void VtkCells::add_prism(std::span<const std::int64_t> points, std::size_t sides) {
  if (points.size() < 2 * sides) {
    throw Error("cell " + std::to_string(cell_) + " has " + std::to_string(points.size()) +
                " points, but one of its shape has " + std::to_string(2 * sides) + damaged_file);
  }
  add_points(points.first(2 * sides));  // the two polygons, one after the other
  std::vector<std::int32_t>& layout = block_.layouts;
  const auto n = static_cast<std::int32_t>(sides);
  layout.insert(layout.end(), {6 * n, n + 2, n, n});
  for (std::size_t i = 0; i < sides; ++i) {
    const std::size_t next = (i + 1) % sides;
    const std::array side{points[i], points[next], points[sides + next], points[sides + i]};
    add_points(side);
    layout.push_back(4);
  }
  block_.shapes.push_back(CellShape::polyhedron);
}

void VtkCells::add_polyhedron(const VtkCell& given) {
  const auto fail = [&](const std::string& what) {
    throw Error("cell " + std::to_string(cell_) + ", a polyhedron, " + what);
  };
  std::span<const std::int64_t> rest = given.faces;
  if (rest.empty()) {
    fail(
        "comes without its faces; the file is damaged, or VTK 9.4 or newer wrote them in lists "
        "that "
        "are not read: cut its cells into tetrahedra first (ParaView: Tetrahedralize)");
  }
  const auto take = [&] {
    if (rest.empty()) fail(std::string("has faces that are cut off") + damaged_file);
    const std::int64_t number = rest.front();
    rest = rest.subspan(1);
    return number;
  };
  const std::int64_t faces = take();
  if (faces < 0 || static_cast<std::uint64_t>(faces) > rest.size()) {
    fail("says that it has " + std::to_string(faces) + " faces" + damaged_file);
  }
  const std::size_t head = block_.layouts.size();
  block_.layouts.insert(block_.layouts.end(), {0, static_cast<std::int32_t>(faces)});
  std::size_t points = 0;
  for (std::int64_t face = 0; face < faces; ++face) {
    const std::int64_t count = take();
    if (count < 3 || static_cast<std::uint64_t>(count) > rest.size()) {
      fail("has a face of " + std::to_string(count) + " points" + damaged_file);
    }
    add_points(rest.first(static_cast<std::size_t>(count)));
    rest = rest.subspan(static_cast<std::size_t>(count));
    block_.layouts.push_back(static_cast<std::int32_t>(count));
    points += static_cast<std::size_t>(count);
  }
  if (points > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    fail("has more points than can be counted");
  }
  if (points == 0) fail("has no faces");
  block_.layouts[head] = static_cast<std::int32_t>(points);
  block_.shapes.push_back(CellShape::polyhedron);
}

}  // namespace pellucid
