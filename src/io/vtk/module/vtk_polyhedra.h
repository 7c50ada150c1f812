// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkXMLUnstructuredGridReader.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

class vtkUnstructuredGrid;

namespace pellucid {

/// Reads .vtu files with the faces of polyhedra as VTK writes them since version 9.4, which older
/// ones do not read: "polyhedron_offsets" ends the list of each cell in "polyhedron_to_faces",
/// whose faces "face_offsets" ends in "face_connectivity".
class PolyhedraReader : public vtkXMLUnstructuredGridReader {
 public:
  static PolyhedraReader* New();
  vtkTypeMacro(PolyhedraReader, vtkXMLUnstructuredGridReader)
  PolyhedraReader(const PolyhedraReader&) = delete;
  PolyhedraReader& operator=(const PolyhedraReader&) = delete;

  /// Gives the grid that was read the faces of its polyhedra. Throws Error where they are damaged.
  void give_faces(vtkUnstructuredGrid& grid) const;

 protected:
  PolyhedraReader() = default;
  ~PolyhedraReader() override = default;
  int ReadPieceData() override;

 private:
  void read_faces(vtkXMLDataElement& cells);
  std::vector<std::int64_t> numbers(vtkXMLDataElement& cells, const char* name, std::int64_t count);
  std::vector<std::int64_t> offsets(vtkXMLDataElement& cells, const char* name, std::int64_t count);

  std::vector<std::int64_t> faces_, begins_;  ///< as VTK 9.3 keeps them; -1: no polyhedron
  std::string fault_;
  bool has_faces_ = false;
};

}  // namespace pellucid
