// SPDX-License-Identifier: Apache-2.0
#include "vtk_cells.h"

#include <vtkCellType.h>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& remedy) {
  throw Error("there are cells of the type " + name + ", which are not read; " + remedy);
}

constexpr const char* tetrahedralize = "cut them into tetrahedra first (ParaView: Tetrahedralize)";
constexpr const char* linearize = "write the mesh with linear or quadratic cells";

}  // namespace

VtkCellKind cell_kind(int vtk_type) {
  switch (vtk_type) {
    case VTK_TETRA:
      return {CellShape::tetrahedron, 4};
    case VTK_VOXEL:
      return {CellShape::voxel, 8};
    case VTK_HEXAHEDRON:
      return {CellShape::hexahedron, 8};
    case VTK_WEDGE:
      return {CellShape::wedge, 6};
    case VTK_PYRAMID:
      return {CellShape::pyramid, 5};
    case VTK_QUADRATIC_TETRA:
      return {CellShape::quadratic_tetrahedron, 10};
    case VTK_QUADRATIC_PYRAMID:
      return {CellShape::quadratic_pyramid, 13};
    case VTK_QUADRATIC_WEDGE:
      return {CellShape::quadratic_wedge, 15};
    case VTK_QUADRATIC_HEXAHEDRON:
      return {CellShape::quadratic_hexahedron, 20};
    case VTK_BIQUADRATIC_QUADRATIC_WEDGE:
      return {CellShape::biquadratic_wedge, 18};
    case VTK_TRIQUADRATIC_HEXAHEDRON:
      return {CellShape::triquadratic_hexahedron, 27};

    case VTK_EMPTY_CELL:
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
    case VTK_LINE:
    case VTK_POLY_LINE:
    case VTK_TRIANGLE:
    case VTK_TRIANGLE_STRIP:
    case VTK_POLYGON:
    case VTK_PIXEL:
    case VTK_QUAD:
    case VTK_QUADRATIC_EDGE:
    case VTK_QUADRATIC_TRIANGLE:
    case VTK_QUADRATIC_QUAD:
    case VTK_QUADRATIC_POLYGON:
    case VTK_BIQUADRATIC_QUAD:
    case VTK_QUADRATIC_LINEAR_QUAD:
    case VTK_BIQUADRATIC_TRIANGLE:
    case VTK_CUBIC_LINE:
    case VTK_PARAMETRIC_CURVE:
    case VTK_PARAMETRIC_SURFACE:
    case VTK_PARAMETRIC_TRI_SURFACE:
    case VTK_PARAMETRIC_QUAD_SURFACE:
    case VTK_HIGHER_ORDER_EDGE:
    case VTK_HIGHER_ORDER_TRIANGLE:
    case VTK_HIGHER_ORDER_QUAD:
    case VTK_HIGHER_ORDER_POLYGON:
    case VTK_LAGRANGE_CURVE:
    case VTK_LAGRANGE_TRIANGLE:
    case VTK_LAGRANGE_QUADRILATERAL:
    case VTK_BEZIER_CURVE:
    case VTK_BEZIER_TRIANGLE:
    case VTK_BEZIER_QUADRILATERAL:
      return {};

    case VTK_PENTAGONAL_PRISM:
      refuse("pentagonal prism", tetrahedralize);
    case VTK_HEXAGONAL_PRISM:
      refuse("hexagonal prism", tetrahedralize);
    case VTK_CONVEX_POINT_SET:
      refuse("convex point set", tetrahedralize);
    case VTK_POLYHEDRON:
      refuse("polyhedron", tetrahedralize);
    case VTK_QUADRATIC_LINEAR_WEDGE:
      refuse("quadratic-linear wedge", linearize);
    case VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON:
      refuse("biquadratic-quadratic hexahedron", linearize);
    case VTK_LAGRANGE_TETRAHEDRON:
      refuse("Lagrange tetrahedron", linearize);
    case VTK_LAGRANGE_HEXAHEDRON:
      refuse("Lagrange hexahedron", linearize);
    case VTK_LAGRANGE_WEDGE:
      refuse("Lagrange wedge", linearize);
    case VTK_LAGRANGE_PYRAMID:
      refuse("Lagrange pyramid", linearize);
    case VTK_BEZIER_TETRAHEDRON:
      refuse("Bezier tetrahedron", linearize);
    case VTK_BEZIER_HEXAHEDRON:
      refuse("Bezier hexahedron", linearize);
    case VTK_BEZIER_WEDGE:
      refuse("Bezier wedge", linearize);
    case VTK_BEZIER_PYRAMID:
      refuse("Bezier pyramid", linearize);
    default:
      refuse("number " + std::to_string(vtk_type),
             "correct the file, or take another kind of cell");
  }
}

}  // namespace pellucid
