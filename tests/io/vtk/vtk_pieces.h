// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "mesh_files.h"

// Files of VTK's in XML that are written piece by piece.
namespace pellucid::test {

/// x + 10 y + 100 z over a box of points, or cells, in words.
inline std::string vtk_values(std::array<int, 6> box) {
  std::string text;
  for (int z = box[4]; z <= box[5]; ++z) {
    for (int y = box[2]; y <= box[3]; ++y) {
      for (int x = box[0]; x <= box[1]; ++x) text += std::to_string(x + 10 * y + 100 * z) + " ";
    }
  }
  return text;
}

inline std::string vtk_words(const std::array<int, 6>& extent) {
  std::string text;
  for (const int n : extent) text += (text.empty() ? "" : " ") + std::to_string(n);
  return text;
}

/// One piece of a grid of 4 x 5 x 6 points, with values at points ("v") or cells ("c").
struct VtkPiece {
  std::array<int, 6> extent{0, 3, 0, 4, 0, 5};
  std::string points, cells;  ///< arrays in place of the right ones
  bool has_points = true, has_cells = false;

  std::string text(const std::string& kind) const {
    const auto& e = extent;
    std::string inside;
    std::string coordinates;
    if (kind == "RectilinearGrid") {
      for (std::size_t a = 0; a < 3; ++a) {
        std::string list;
        for (int i = e[2 * a]; i <= e[2 * a + 1]; ++i) list += std::to_string(i * i) + " ";
        coordinates += xml_array("Float64", std::string(1, "xyz"[a]), list);
      }
      inside += "<Coordinates>" + coordinates + "</Coordinates>\n";
    }
    if (kind == "StructuredGrid") {
      for (int z = e[4]; z <= e[5]; ++z) {
        for (int y = e[2]; y <= e[3]; ++y) {
          for (int x = e[0]; x <= e[1]; ++x) {
            coordinates +=
                std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " ";
          }
        }
      }
      inside += "<Points>" + xml_array("Float64", "Points", coordinates, 3) + "</Points>\n";
    }
    if (has_points) {
      inside += "<PointData>" +
                (points.empty() ? xml_array("Int16", "v", vtk_values(extent)) : points) +
                "</PointData>\n";
    }
    if (has_cells) {
      inside +=
          "<CellData>" +
          (cells.empty() ? xml_array("Int16", "c",
                                     vtk_values({e[0], e[1] - 1, e[2], e[3] - 1, e[4], e[5] - 1}))
                         : cells) +
          "</CellData>\n";
    }
    return "<Piece Extent=\"" + vtk_words(extent) + "\">\n" + inside + "</Piece>\n";
  }
};

inline std::string vtk_grid(const std::string& kind, const std::vector<VtkPiece>& pieces,
                            const std::string& whole = "0 3 0 4 0 5") {
  std::string inside;
  for (const VtkPiece& piece : pieces) inside += piece.text(kind);
  return xml_file(kind, "<" + kind + " WholeExtent=\"" + whole +
                            "\" Origin=\"0 0 0\" Spacing=\"1 2 3\">\n" + inside + "</" + kind +
                            ">\n");
}

/// A list of pieces: extents and files.
inline std::string vtk_list(const std::string& kind,
                            const std::vector<std::pair<std::string, std::string>>& pieces,
                            const std::string& type = "Int16", bool cells = false) {
  std::string inside = std::string(cells ? "<PCellData>" : "<PPointData>") + "<PDataArray type=\"" +
                       type + "\" Name=\"" + (cells ? "c" : "v") + "\"/>" +
                       (cells ? "</PCellData>" : "</PPointData>");
  if (kind == "PRectilinearGrid") {
    inside += "<PCoordinates>";
    for (const char* axis : {"x", "y", "z"}) {
      inside += "<PDataArray type=\"Float64\" Name=\"" + std::string(axis) + "\"/>";
    }
    inside += "</PCoordinates>";
  }
  if (kind == "PStructuredGrid") {
    inside +=
        "<PPoints><PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>"
        "</PPoints>";
  }
  for (const auto& [extent, source] : pieces) {
    inside += "<Piece Extent=\"" + extent + "\" Source=\"" + source + "\"/>";
  }
  return xml_file(kind, "<" + kind +
                            " WholeExtent=\"0 3 0 4 0 5\" GhostLevel=\"0\" "
                            "Origin=\"0 0 0\" Spacing=\"1 2 3\">" +
                            inside + "</" + kind + ">\n");
}

}  // namespace pellucid::test
