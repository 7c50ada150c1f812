// SPDX-License-Identifier: Apache-2.0
//
// The format: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.

#include <cstdint>
#include <string>

#include "volumes/volume_writers.h"
#include "vtk/xml/vtk_xml_text.h"

namespace pellucid {

namespace {

Losses write_vti(const WrittenVolume& volume, const Sink& sink) {
  const Volume::Description& d = volume.description();
  const GridPlacement& placement = d.placement;
  const bool cell = d.centering == Centering::cell;
  std::string extent, direction;
  // The first point, half a cell before the first value where values fill cells.
  Vec3<double> origin = placement.origin;
  for (int a = 0; a < 3; ++a) {
    const std::string separator = a < 2 ? " " : "";
    const int points = d.dimensions[static_cast<std::size_t>(a)] + (cell ? 1 : 0);
    extent += "0 " + std::to_string(points - 1) + separator;
    if (cell) origin = origin - placement.direction.column[a] * (placement.spacing[a] / 2);
    const Vec3<double> row{placement.direction.column[0][a], placement.direction.column[1][a],
                           placement.direction.column[2][a]};
    direction += exact_text(row, " ") + separator;
  }
  const std::string element = cell ? "CellData" : "PointData";
  std::uint64_t bytes = 0;
  const std::string type = std::visit(
      [&](const auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        bytes = std::uint64_t{values.size()} * sizeof(Value) * volume.components.size();
        return vtk_type_name<Value>();
      },
      volume.data());
  std::string head = vtk_file_element("ImageData");
  head += "<ImageData WholeExtent=\"" + extent + "\" Origin=\"" + exact_text(origin, " ") +
          "\" Spacing=\"" + exact_text(placement.spacing, " ") + "\" Direction=\"" + direction +
          "\">\n<Piece Extent=\"" + extent + "\">\n<" + element + " Scalars=\"" +
          xml_attribute(volume.array) + "\">\n" +
          vtk_appended_array(type, volume.array, volume.components.size(), 0) + "</" + element +
          ">\n</Piece>\n</ImageData>\n";
  head += vtk_append_begin;
  put_text(head, sink);
  sink(std::as_bytes(std::span(&bytes, 1)));
  put_interleaved(volume, sink);
  put_text(std::string(vtk_append_end), sink);
  return {};
}

}  // namespace

extern const VolumeWriter vti_writer{.extension = ".vti", .write = write_vti};

}  // namespace pellucid
