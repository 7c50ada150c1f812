// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// First and last point along each axis.
using VtkExtent = std::array<std::int64_t, 6>;

/// The element of a piece that an array stands in.
enum class VtkSection { points, cells, coordinates, point_data, cell_data };

/// An array of one of VTK's XML files, by what the file has of it.
struct VtkXmlArray {
  VtkSection section = VtkSection::point_data;
  std::string name, type;
  std::int64_t components = 1;
  std::vector<int> steps;  ///< the time steps that it is of; empty: all
  bool is_bits = false;    ///< eight values in a byte, so `values` are up to seven too many
  std::optional<std::uint64_t> values;  ///< numbers in the file; none: it does not say
  bool is_cut = false;                  ///< its header says more bytes than there are
  std::string stop;   ///< text: the first word that is no number of the type; empty: none
  std::string fault;  ///< what is wrong with its attributes; empty: nothing
};

/// Place of an image; nothing: the file does not say it.
struct VtkXmlPlace {
  std::optional<std::array<double, 3>> origin, spacing;
  std::optional<std::array<double, 9>> direction;
};

/// A piece of a file or, in a list of pieces, of another file.
struct VtkXmlPiece {
  std::string source;  ///< the other file
  VtkExtent extent{0, -1, 0, -1, 0, -1};
  std::uint64_t points = 0, cells = 0;
  std::vector<VtkXmlArray> arrays;
};

/// Contents of one of VTK's XML files, without values.
struct VtkXmlFile {
  std::string kind;  ///< "ImageData", "PUnstructuredGrid" …
  std::optional<VtkExtent> whole;
  VtkXmlPlace place;
  std::vector<double> times;  ///< of the steps in time; empty: there are none
  std::vector<VtkXmlPiece> pieces;
  std::vector<VtkXmlArray> listed;  ///< of a list of pieces: the arrays that each piece has
  std::vector<std::string> files;   ///< of a collection: its files
};

/// Reads it without VTK. Throws Error, without the file's name, where it is damaged.
VtkXmlFile read_vtk_xml(const std::filesystem::path& path);
/// Returns the same of a file in memory.
VtkXmlFile parse_vtk_xml(std::string_view text);

}  // namespace pellucid
