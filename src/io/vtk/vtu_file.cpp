// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/write_mesh.h"
#include "pellucid/scene/error.h"
#include "vtk/xml/vtk_xml_text.h"

namespace pellucid {

namespace {

/// VTK's number of a cell's type.
std::uint8_t vtk_type(CellShape shape) {
  switch (shape) {
    case CellShape::tetrahedron:
      return 10;
    case CellShape::voxel:
      return 11;
    case CellShape::hexahedron:
      return 12;
    case CellShape::wedge:
      return 13;
    case CellShape::pyramid:
      return 14;
    case CellShape::quadratic_tetrahedron:
      return 24;
    case CellShape::quadratic_hexahedron:
      return 25;
    case CellShape::quadratic_wedge:
      return 26;
    case CellShape::quadratic_pyramid:
      return 27;
    case CellShape::triquadratic_hexahedron:
      return 29;
    case CellShape::biquadratic_wedge:
      return 32;
    case CellShape::lagrange_tetrahedron:
    case CellShape::lagrange_wedge:
    case CellShape::lagrange_hexahedron:
    case CellShape::polyhedron:
      break;
  }
  return 0;  // VTK's empty cell
}

/// The file: a head of XML that says where each array begins in the bytes that follow.
class VtuFile {
 public:
  /// `path` is for messages.
  VtuFile(const UnstructuredGrid& grid, std::string path) : grid_(grid), path_(std::move(path)) {
    head_ = vtk_file_element("UnstructuredGrid") + "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
            std::to_string(grid.points.size()) + "\" NumberOfCells=\"" +
            std::to_string(grid.shapes.size()) + "\">\n";
    add_cells();
    add_arrays(Centering::point, "PointData");
    add_arrays(Centering::cell, "CellData");
    head_ += "</Piece>\n</UnstructuredGrid>\n";
    head_ += vtk_append_begin;
  }

  void write(std::ostream& stream) const {
    write(stream, head_.data(), head_.size());
    for (const Block& block : blocks_) {
      const auto bytes = static_cast<std::uint64_t>(block.bytes);
      write(stream, &bytes, sizeof bytes);
      write(stream, block.data, block.bytes);
    }
    write(stream, vtk_append_end.data(), vtk_append_end.size());
  }

 private:
  struct Block {
    const void* data;
    std::size_t bytes;
  };

  static void write(std::ostream& stream, const void* data, std::size_t bytes) {
    stream.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
  }

  /// `values` stay where they are until the file is written.
  template <class Value>
  void add(const std::string& name, std::size_t components, const Value* values,
           std::size_t count) {
    head_ += vtk_appended_array(vtk_type_name<Value>(), name, components, offset_);
    blocks_.push_back({values, count * sizeof(Value)});
    offset_ += sizeof(std::uint64_t) + blocks_.back().bytes;
  }

  void add_cells() {
    static_assert(sizeof(Vec3<double>) == 3 * sizeof(double));
    types_.reserve(grid_.shapes.size());
    ends_.reserve(grid_.shapes.size());
    std::int64_t end = 0;
    for (const CellShape shape : grid_.shapes) {
      if (point_count(shape) == 0) {
        throw Error(path_ +
                    ": not written: its Lagrange cells and polyhedra have to be cut into "
                    "tetrahedra first; write tetrahedralize() the grid");
      }
      types_.push_back(vtk_type(shape));
      ends_.push_back(end += point_count(shape));
    }
    if (static_cast<std::size_t>(end) != grid_.corners.size()) {
      throw Error(path_ + ": not written: the shapes of its cells need " + std::to_string(end) +
                  " corners, but " + std::to_string(grid_.corners.size()) + " are there");
    }
    head_ += "<Points>\n";
    add("Points", 3, reinterpret_cast<const double*>(grid_.points.data()), 3 * grid_.points.size());
    head_ += "</Points>\n<Cells>\n";
    add("connectivity", 1, grid_.corners.data(), grid_.corners.size());
    add("offsets", 1, ends_.data(), ends_.size());
    add("types", 1, types_.data(), types_.size());
    head_ += "</Cells>\n";
  }

  void add_arrays(Centering centering, const std::string& element) {
    const std::size_t places =
        centering == Centering::point ? grid_.points.size() : grid_.shapes.size();
    head_ += "<" + element + ">\n";
    for (const MeshArray& array : grid_.arrays) {
      if (array.centering != centering) continue;
      std::visit(
          [&](const auto& values) {
            const auto components = static_cast<std::size_t>(array.components);
            if (values.size() != places * components) {
              throw Error(path_ + ": not written: array \"" + array.name + "\" has " +
                          std::to_string(values.size()) + " values, but " +
                          std::to_string(places * components) + " are needed");
            }
            add(array.name, components, values.data(), values.size());
          },
          array.values);
    }
    head_ += "</" + element + ">\n";
  }

  const UnstructuredGrid& grid_;
  std::string path_, head_;
  std::vector<Block> blocks_;
  std::size_t offset_ = 0;
  std::vector<std::uint8_t> types_;
  std::vector<std::int64_t> ends_;
};

}  // namespace

void write_vtu(const UnstructuredGrid& grid, const std::filesystem::path& path) {
  const VtuFile vtu(grid, path.string());
  AtomicFile file(path);
  std::ofstream stream(file.temporary_path(), std::ios::binary);
  vtu.write(stream);
  stream.close();
  if (!stream) throw Error(path.string() + ": cannot write: is the disk full?");
  file.commit();
}

}  // namespace pellucid
