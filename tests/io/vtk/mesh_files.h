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

/// One piece of cells of any kind, with "p" on its points, which counts them from 0.
struct AnyVtu {
  std::string points, connectivity, offsets, types;
  std::string more;  ///< further arrays of <Cells>
  std::string cell_data;
  int point_count = 0, cell_count = 0;
  std::string version = "2.2";

  std::string text() const {
    std::string values;
    for (int i = 0; i < point_count; ++i) values += std::to_string(i) + " ";
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"" + version +
           "\" byte_order=\"LittleEndian\">\n<UnstructuredGrid><Piece NumberOfPoints=\"" +
           std::to_string(point_count) + "\" NumberOfCells=\"" + std::to_string(cell_count) +
           "\">\n<PointData Scalars=\"p\">" + xml_array("Float32", "p", values) + "</PointData>\n" +
           cell_data + "<Points>" + xml_array("Float64", "Points", points, 3) +
           "</Points>\n<Cells>" + xml_array("Int64", "connectivity", connectivity) +
           xml_array("Int64", "offsets", offsets) + xml_array("UInt8", "types", types) + more +
           "</Cells></Piece></UnstructuredGrid>\n</VTKFile>\n";
  }
};

/// A unit cube as a polyhedron, and beside it one as a hexahedron.
inline AnyVtu polyhedron_vtu() {
  AnyVtu of;
  of.points = "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1  2 0 0 2 1 0 2 0 1 2 1 1";
  of.point_count = 12;
  of.cell_count = 2;
  of.connectivity = "0 1 2 3 4 5 6 7  1 8 9 2 5 10 11 6";
  of.offsets = "8 16";
  of.types = "42 12";
  of.more =
      xml_array("Int64", "faces", "6 4 0 3 2 1 4 4 5 6 7 4 0 1 5 4 4 1 2 6 5 4 2 3 7 6 4 3 0 4 7") +
      xml_array("Int64", "faceoffsets", "31 -1");
  return of;
}

/// The same, as VTK wrote it until version 8 (its number 4.2) and writes it since (5.1).
inline std::string polyhedron_vtk(bool newer) {
  const std::string cells =
      newer ? "CELLS 3 39\nOFFSETS vtktypeint64\n0 31 39\nCONNECTIVITY vtktypeint64\n"
              "6 4 0 3 2 1 4 4 5 6 7 4 0 1 5 4 4 1 2 6 5 4 2 3 7 6 4 3 0 4 7\n"
              "1 8 9 2 5 10 11 6\n"
            : "CELLS 2 41\n"
              "31 6 4 0 3 2 1 4 4 5 6 7 4 0 1 5 4 4 1 2 6 5 4 2 3 7 6 4 3 0 4 7\n"
              "8 1 8 9 2 5 10 11 6\n";
  return "# vtk DataFile Version " + std::string(newer ? "5.1" : "4.2") +
         "\na polyhedron\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 12 float\n"
         "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1  2 0 0 2 1 0 2 0 1 2 1 1\n" +
         cells +
         "CELL_TYPES 2\n42\n12\nPOINT_DATA 12\nSCALARS p float 1\nLOOKUP_TABLE default\n"
         "0 1 2 3 4 5 6 7 8 9 10 11\n";
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
