// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pellucid::test {

/// An array of a VTK XML file, in words.
inline std::string xml_array(const std::string& type, const std::string& name,
                             const std::string& values, int components = 1) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">" + values + "</DataArray>\n";
}

inline std::string xml_file(const std::string& kind, const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + kind +
         "\" version=\"1.0\" byte_order=\"LittleEndian\">\n" + content + "</VTKFile>\n";
}

/// What may be put in the place of what is right.
struct SmallVtu {
  std::string points = "0 0 0  1 0 0  0 1 0  0 0 1  1 1 1";
  std::string values = "0 1 2 3 4";
  std::string more;  ///< further arrays of the cells
  std::string connectivity = "0 1 2 3  1 2 3 4  0 1 2";
  std::string offsets = "4 8 11";
  std::string types = "10 10 5";
  std::string number_of_points = "5";
};

/// Two tetrahedra that share a face, and a triangle. "p" on the points is the active one; "id",
/// which counts the cells, and "v" on the points, vectors.
inline std::string small_vtu(const SmallVtu& of = {}) {
  return xml_file("UnstructuredGrid",
                  "<UnstructuredGrid><Piece NumberOfPoints=\"" + of.number_of_points +
                      "\" NumberOfCells=\"3\">\n<PointData Scalars=\"p\">\n" +
                      xml_array("Float64", "v", "3 4 0  0 0 2  0 0 0  1 0 0  0 1 0", 3) +
                      xml_array("Float32", "p", of.values) + "</PointData>\n<CellData>\n" +
                      xml_array("Int32", "id", "7 8 9") + of.more + "</CellData>\n<Points>" +
                      xml_array("Float64", "Points", of.points, 3) + "</Points>\n<Cells>" +
                      xml_array("Int64", "connectivity", of.connectivity) +
                      xml_array("Int64", "offsets", of.offsets) +
                      xml_array("UInt8", "types", of.types) +
                      "</Cells></Piece></UnstructuredGrid>\n");
}

/// The same tetrahedra and "p".
inline std::string small_vtk(const std::string& coding = "ASCII") {
  return "# vtk DataFile Version 3.0\ntwo tetrahedra\n" + coding +
         "\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\n"
         "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10 10\n"
         "POINT_DATA 5\nSCALARS p float 1\nLOOKUP_TABLE default\n0 1 2 3 4\n"
         "SCALARS q float 1\nLOOKUP_TABLE default\n5 6 7 8 9\n";
}

/// A curvilinear grid of 3 x 2 x 2 points.
inline std::string small_structured_vtk() {
  return "# vtk DataFile Version 2.0\na bent row of two hexahedra\nASCII\nDATASET STRUCTURED_GRID\n"
         "DIMENSIONS 3 2 2\nPOINTS 12 float\n"
         "0 0 0 1 0 .1 2 0 .4 0 1 0 1 1 .1 2 1 .4 0 0 1 1 0 1.1 2 0 1.4 0 1 1 1 1 1.1 2 1 1.4\n"
         "CELL_DATA 2\nSCALARS c int 1\nLOOKUP_TABLE default\n5 6\n";
}

}  // namespace pellucid::test
