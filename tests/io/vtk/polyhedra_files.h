// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mesh_files.h"
#include "tests/io/volume_files.h"
#ifdef PELLUCID_HAVE_HDF5
#include "tests/io/arrays/vtk_hdf_files.h"
#endif

// Files with the faces of polyhedra as VTK writes them since version 9.4.
namespace pellucid::test {

/// How arrays of whole numbers stand in a file.
enum class Coding { ascii, base64, raw, appended_base64, packed, packed_base64 };

inline std::string base64(const std::string& bytes) {
  static constexpr char letters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      word = word << 8 | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0U);
    }
    for (std::size_t c = 0; c < 4; ++c) {
      text += i + c > bytes.size() ? '=' : letters[word >> (18 - 6 * c) & 63];
    }
  }
  return text;
}

using Numbers = std::vector<std::int64_t>;

/// The lists of cells of the unit cube as a polyhedron, and beside it one as a hexahedron.
struct CellLists {
  Numbers connectivity{0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 9, 2, 5, 10, 11, 6};
  Numbers offsets{8, 16}, types{42, 12};
  Numbers face_connectivity{0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
  Numbers face_offsets{4, 8, 12, 16, 20, 24};
  Numbers polyhedron_to_faces{0, 1, 2, 3, 4, 5}, polyhedron_offsets{6, 6};
};

/// A .vtu file of lists, with "p" on its 12 points, which counts them.
class PolyhedraVtu {
 public:
  explicit PolyhedraVtu(Coding coding) : coding_(coding) {}

  std::string text(const CellLists& lists, int pieces = 1) {
    std::string all;
    for (int piece = 0; piece < pieces; ++piece) {
      const std::string shift = piece == 0 ? "" : "1";  // points of the second piece are at x + 10
      all +=
          "<Piece NumberOfPoints=\"12\" NumberOfCells=\"" + std::to_string(lists.types.size()) +
          "\"><PointData Scalars=\"p\">" + xml_array("Float32", "p", "0 1 2 3 4 5 6 7 8 9 10 11") +
          "</PointData><Points>" +
          xml_array("Float64", "Points",
                    shift + "0 0 0 " + shift + "1 0 0 " + shift + "1 1 0 " + shift + "0 1 0 " +
                        shift + "0 0 1 " + shift + "1 0 1 " + shift + "1 1 1 " + shift + "0 1 1 " +
                        shift + "2 0 0 " + shift + "2 1 0 " + shift + "2 0 1 " + shift + "2 1 1",
                    3) +
          "</Points><Cells>" + array("connectivity", lists.connectivity) +
          array("offsets", lists.offsets) + array("types", lists.types) +
          array("face_connectivity", lists.face_connectivity) +
          array("face_offsets", lists.face_offsets) +
          array("polyhedron_to_faces", lists.polyhedron_to_faces) +
          array("polyhedron_offsets", lists.polyhedron_offsets) + "</Cells></Piece>\n";
    }
    const bool is_packed = coding_ == Coding::packed || coding_ == Coding::packed_base64;
    std::string file =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"2.3\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\"" +
        std::string(is_packed ? " compressor=\"vtkZLibDataCompressor\"" : "") +
        ">\n<UnstructuredGrid>" + all + "</UnstructuredGrid>\n";
    if (!appended_.empty()) {
      const bool is_raw = coding_ == Coding::raw || coding_ == Coding::packed;
      file += "<AppendedData encoding=\"" + std::string(is_raw ? "raw" : "base64") + "\">\n_" +
              appended_ + "\n</AppendedData>\n";
    }
    return file + "</VTKFile>\n";
  }

 private:
  std::string array(const std::string& name, const Numbers& numbers) {
    const std::string head = "<DataArray type=\"Int64\" Name=\"" + name + "\" format=\"";
    if (coding_ == Coding::ascii) {
      std::string words;
      for (const std::int64_t number : numbers) words += std::to_string(number) + " ";
      return head + "ascii\">" + words + "</DataArray>";
    }
    const std::string values = bytes_of(numbers);
    if (coding_ == Coding::base64) {
      const std::string size = bytes_of(Numbers{static_cast<std::int64_t>(values.size())});
      return head + "binary\">" + base64(size + values) + "</DataArray>";
    }
    const std::size_t at = appended_.size();
    if (coding_ == Coding::raw || coding_ == Coding::appended_base64) {
      const std::string all = bytes_of(Numbers{static_cast<std::int64_t>(values.size())}) + values;
      appended_ += coding_ == Coding::raw ? all : base64(all);
    } else {
      // Two blocks, the second of which is shorter, if there are so many values.
      const std::size_t block = 64, whole = values.size() / block, rest = values.size() % block;
      Numbers header{static_cast<std::int64_t>(whole + (rest > 0 ? 1 : 0)),
                     static_cast<std::int64_t>(block), static_cast<std::int64_t>(rest)};
      std::string blocks;
      for (std::size_t begin = 0; begin < values.size(); begin += block) {
        const std::string packed = deflated(values.substr(begin, block), 15);
        header.push_back(static_cast<std::int64_t>(packed.size()));
        blocks += packed;
      }
      appended_ += coding_ == Coding::packed ? bytes_of(header) + blocks
                                             : base64(bytes_of(header)) + base64(blocks);
    }
    return head + "appended\" offset=\"" + std::to_string(at) + "\"/>";
  }

  Coding coding_;
  std::string appended_;
};

#ifdef PELLUCID_HAVE_HDF5
/// Two parts of the same cells; the second part is one along x.
struct PolyhedraVtkHdf {
  CellLists lists;

  void write(const std::filesystem::path& path) const {
    VtkHdfWriter file(path, "UnstructuredGrid");
    file.attribute<std::int64_t>("Version", {2, 5});
    const auto twice = [](Numbers numbers) {
      const Numbers one = numbers;
      numbers.insert(numbers.end(), one.begin(), one.end());
      return numbers;
    };
    const auto list = [&](const std::string& name, const Numbers& one) {
      const Numbers both = twice(one);
      file.array("", name, {both.size()}, both);
    };
    const auto count = [](const Numbers& numbers) {
      return Numbers{static_cast<std::int64_t>(numbers.size())};
    };
    const auto from_zero = [](Numbers numbers) {
      numbers.insert(numbers.begin(), 0);
      return numbers;
    };
    list("NumberOfPoints", {12});
    list("NumberOfCells", count(lists.types));
    list("NumberOfConnectivityIds", count(lists.connectivity));
    list("Connectivity", lists.connectivity);
    list("Offsets", from_zero(lists.offsets));
    list("Types", lists.types);
    list("NumberOfFaces", count(lists.face_offsets));
    list("NumberOfFaceConnectivityIds", count(lists.face_connectivity));
    list("NumberOfPolyhedronToFaceIds", count(lists.polyhedron_to_faces));
    list("FaceConnectivity", lists.face_connectivity);
    list("FaceOffsets", from_zero(lists.face_offsets));
    list("PolyhedronToFaces", lists.polyhedron_to_faces);
    list("PolyhedronOffsets", from_zero(lists.polyhedron_offsets));
    std::vector<double> points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1,
                               1, 1, 1, 0, 1, 1, 2, 0, 0, 2, 1, 0, 2, 0, 1, 2, 1, 1};
    for (std::size_t i = 0; i < 36; ++i) points.push_back(points[i] + (i % 3 == 0 ? 10 : 0));
    file.array("", "Points", {24, 3}, points);
    file.array("PointData", "p", {24}, std::vector<float>(24, 1));
  }
};

#endif

}  // namespace pellucid::test
