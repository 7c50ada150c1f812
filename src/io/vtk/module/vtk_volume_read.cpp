// SPDX-License-Identifier: Apache-2.0
#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkRectilinearGridReader.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStructuredPoints.h>
#include <vtkStructuredPointsReader.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPImageDataReader.h>
#include <vtkXMLPRectilinearGridReader.h>
#include <vtkXMLReader.h>
#include <vtkXMLRectilinearGridReader.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pellucid/scene/error.h"
#include "process/module_answer.h"
#include "vtk/vtk_cells.h"
#include "vtk/vtk_module.h"
#include "vtk_compare_pieces.h"
#include "vtk_messages.h"
#include "vtk_readers.h"
#include "vtk_values.h"

namespace pellucid {

namespace {

constexpr const char* remedy = "crop or reduce the volume";
constexpr const char* no_times = "the file has no steps in time; leave the time out";

/// An array of the file, by the name that it is called by here.
struct Entry {
  std::string name, in_file;
  Centering centering = Centering::point;
  int components = 1, type = VTK_DOUBLE;
  bool active = false;
};

std::string ghost_name() {
  return vtkDataSetAttributes::GhostArrayName();
}

/// Returns whether an array has flags or, in old files, levels of ghosts.
bool is_of_ghosts(const std::string& name) {
  return name == ghost_name() || name == "vtkGhostLevels";
}

/// One of cells that is named like one of points gets "_cell" behind its name, as in meshes.
void add_entry(Entry entry, std::vector<Entry>& entries) {
  if (entry.in_file.empty() || is_of_ghosts(entry.in_file) || entry.components < 1) return;
  entry.name = entry.in_file;
  const bool is_step = std::ranges::any_of(entries, [&](const Entry& other) {
    return other.in_file == entry.in_file && other.centering == entry.centering;
  });
  if (is_step) return;  // another step in time of an array that is known
  const bool is_taken =
      std::ranges::any_of(entries, [&](const Entry& other) { return other.name == entry.name; });
  if (is_taken) entry.name += "_cell";
  entries.push_back(std::move(entry));
}

/// Returns the entries as the file's head tells them, before values are read.
std::vector<Entry> entries_of(vtkInformation& about) {
  std::vector<Entry> entries;
  for (const Centering centering : {Centering::point, Centering::cell}) {
    vtkInformationVector* const fields =
        about.Get(centering == Centering::point ? vtkDataObject::POINT_DATA_VECTOR()
                                                : vtkDataObject::CELL_DATA_VECTOR());
    for (int i = 0; fields != nullptr && i < fields->GetNumberOfInformationObjects(); ++i) {
      vtkInformation* const field = fields->GetInformationObject(i);
      const char* const name = field->Get(vtkDataObject::FIELD_NAME());
      const int type = field->Get(vtkDataObject::FIELD_ARRAY_TYPE());
      if (name == nullptr || type == VTK_STRING) continue;
      const int active = field->Get(vtkDataObject::FIELD_ACTIVE_ATTRIBUTE());
      add_entry({"", name, centering,
                 std::max(field->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS()), 1), type,
                 (active & (1 << vtkDataSetAttributes::SCALARS)) != 0},
                entries);
    }
  }
  return entries;
}

vtkDataSetAttributes& attributes(vtkDataSet& set, Centering centering) {
  if (centering == Centering::point) return *set.GetPointData();
  return *set.GetCellData();
}

std::vector<Entry> entries_of(vtkDataSet& set) {
  std::vector<Entry> entries;
  for (const Centering centering : {Centering::point, Centering::cell}) {
    vtkDataSetAttributes& data = attributes(set, centering);
    for (int a = 0; a < data.GetNumberOfArrays(); ++a) {
      vtkDataArray* const array = data.GetArray(a);  // null for text
      if (array == nullptr || array->GetName() == nullptr) continue;
      add_entry({"", array->GetName(), centering, array->GetNumberOfComponents(),
                 array->GetDataType(), array == data.GetScalars()},
                entries);
    }
  }
  return entries;
}

/// Returns the active scalars, else the first of points with one component, else the first.
const Entry& entry_to_show(const std::vector<Entry>& entries) {
  const auto active = std::ranges::find_if(entries, [](const Entry& e) { return e.active; });
  if (active != entries.end()) return *active;
  const auto scalar = std::ranges::find_if(
      entries, [](const Entry& e) { return e.centering == Centering::point && e.components == 1; });
  return scalar != entries.end() ? *scalar : entries.front();
}

/// Returns the entries that are wanted. Throws Error where there is none, or none of that name.
std::vector<Entry> choose(const std::vector<Entry>& entries, const VtkVolumeRequest& request,
                          VtkVolume& volume) {
  if (entries.empty()) throw Error("has no array of numbers");
  volume.shown = entry_to_show(entries).name;
  std::string list;
  for (const Entry& entry : entries) {
    volume.names.push_back(entry.name);
    list += (list.empty() ? "" : ", ") + entry.name;
  }
  if (request.all) return entries;
  const std::string& wanted = request.array ? *request.array : volume.shown;
  const auto found =
      std::ranges::find_if(entries, [&](const Entry& entry) { return entry.name == wanted; });
  if (found != entries.end()) return {*found};
  constexpr std::size_t longest = 400;
  if (list.size() > longest) list = list.substr(0, longest) + " ...";
  throw Error("has no array \"" + wanted + "\"; its arrays are " + list);
}

std::vector<std::uint8_t> ghosts_of(vtkDataSetAttributes& data, vtkIdType count) {
  auto* const ghosts = vtkUnsignedCharArray::SafeDownCast(data.GetArray(ghost_name().c_str()));
  if (ghosts == nullptr) return {};
  if (ghosts->GetNumberOfValues() != count) {
    throw Error(std::string("the number of ghost flags is not that of the values") + damaged_file);
  }
  return {ghosts->GetPointer(0), ghosts->GetPointer(0) + count};
}

void take_values(vtkDataSet& set, const std::vector<Entry>& entries, VtkVolume& volume) {
  for (const Entry& entry : entries) {
    const bool point = entry.centering == Centering::point;
    vtkDataArray* const array = attributes(set, entry.centering).GetArray(entry.in_file.c_str());
    const vtkIdType count = point ? set.GetNumberOfPoints() : set.GetNumberOfCells();
    if (array == nullptr || array->GetNumberOfTuples() != count) {
      throw Error("the array \"" + entry.name + "\" has " +
                  std::to_string(array == nullptr ? 0 : array->GetNumberOfTuples()) +
                  " values, but there are " + std::to_string(count) +
                  (point ? " points" : " cells") + damaged_file);
    }
    std::string rounded;
    volume.arrays.push_back({entry.name, entry.centering, array->GetNumberOfComponents(),
                             values_in_place(*array, rounded)});
    if (!rounded.empty()) volume.notes.push_back("of \"" + entry.name + "\" " + rounded);
  }
  volume.point_ghosts = ghosts_of(*set.GetPointData(), set.GetNumberOfPoints());
  volume.cell_ghosts = ghosts_of(*set.GetCellData(), set.GetNumberOfCells());
}

/// `direction`: row after row.
void take_place(const int* extent, const double* origin, const double* spacing,
                const double* direction, VtkVolume& volume) {
  GridPlacement& placement = volume.placement;
  for (int a = 0; a < 3; ++a) {
    volume.points[static_cast<std::size_t>(a)] = extent[2 * a + 1] - extent[2 * a] + 1;
    volume.first[static_cast<std::size_t>(a)] = extent[2 * a];
    for (int row = 0; row < 3; ++row) {
      placement.direction.column[a][row] = direction[3 * row + a];
    }
    placement.origin[a] = origin[a];
    placement.spacing[a] = spacing[a];
  }
  for (int a = 0; a < 3; ++a) {
    placement.origin =
        placement.origin + placement.direction.column[a] * (placement.spacing[a] * extent[2 * a]);
    if (placement.spacing[a] < 0) {
      placement.spacing[a] = -placement.spacing[a];
      placement.direction.column[a] = placement.direction.column[a] * -1.0;
    }
  }
}

void take_grid(vtkImageData& image, VtkVolume& volume) {
  take_place(image.GetExtent(), image.GetOrigin(), image.GetSpacing(),
             image.GetDirectionMatrix()->GetData(), volume);
}

void take_grid(vtkRectilinearGrid& grid, VtkVolume& volume) {
  grid.GetDimensions(volume.points.data());
  vtkDataArray* const axes[] = {grid.GetXCoordinates(), grid.GetYCoordinates(),
                                grid.GetZCoordinates()};
  for (std::size_t a = 0; a < 3; ++a) {
    if (axes[a] == nullptr || axes[a]->GetNumberOfTuples() != volume.points[a]) {
      throw Error("the positions along " + std::string(1, "xyz"[a]) +
                  " are not as many as its points" + damaged_file);
    }
    std::vector<double>& positions = volume.positions[a];
    for (int i = 0; i < volume.points[a]; ++i) {
      positions.push_back(axes[a]->GetComponent(i, 0));
    }
    volume.rounding =
        std::max(volume.rounding, axes[a]->GetDataType() == VTK_FLOAT ? 0x1p-24 : 0x1p-53);
  }
}

template <class Grid>
void take_all(vtkDataObject* object, VtkVolume& volume) {
  auto* const grid = Grid::SafeDownCast(object);
  if (grid == nullptr || grid->GetNumberOfPoints() < 1) {
    throw Error("the file has no points, or is cut off or damaged");
  }
  take_grid(*grid, volume);
}

void check(vtkAlgorithm& reader, const VtkMessages& messages) {
  messages.check();
  if (reader.GetErrorCode() != 0) throw Error("the file is cut off or damaged");
}

using Extent = std::array<int, 6>;

/// Returns the first and last points along the axes.
Extent whole_extent(vtkInformation& about) {
  Extent extent{0, -1, 0, -1, 0, -1};
  about.Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
  return extent;
}

/// Returns the size of the entries, as they are read and as they are kept.
std::uintmax_t bytes_of(const std::vector<Entry>& entries, const Extent& of) {
  const int* const extent = of.data();
  double points = 1, bytes = 0;
  for (int a = 0; a < 3; ++a) {
    const double side = static_cast<double>(extent[2 * a + 1]) - extent[2 * a] + 1;
    if (side < 1) throw Error("the file has no points, or is cut off or damaged");
    points *= side;
  }
  for (const Entry& entry : entries) {
    bytes += points * entry.components * std::max(1, vtkDataArray::GetDataTypeSize(entry.type));
  }
  constexpr double most = 0x1p62;
  if (bytes > most) throw Error("a volume of that many values is too large");
  return static_cast<std::uintmax_t>(bytes);
}

/// Returns whether the entries' values have one type, whichever part is read, and none is hidden.
bool reads_parts(const std::vector<Entry>& entries, vtkDataArraySelection& points,
                 vtkDataArraySelection& cells, bool hides_nothing) {
  const std::string ghosts = ghost_name();
  if (hides_nothing) {
    points.DisableArray(ghosts.c_str());
    cells.DisableArray(ghosts.c_str());
  } else if (points.ArrayExists(ghosts.c_str()) != 0 || cells.ArrayExists(ghosts.c_str()) != 0) {
    return false;
  }
  // Whole numbers of 64 bits have the type of the largest.
  return std::ranges::all_of(entries, [](const Entry& entry) {
    return entry.type == VTK_FLOAT || entry.type == VTK_DOUBLE ||
           (entry.type != VTK_BIT && vtkDataArray::GetDataTypeSize(entry.type) <= 4);
  });
}

/// Returns the points of the whole extent that are in the box.
Extent extent_of(const Extent& whole, const IndexBox& box) {
  Extent extent{};
  for (std::size_t a = 0; a < 3; ++a) {
    extent[2 * a] = whole[2 * a] + box.first[a];
    extent[2 * a + 1] = extent[2 * a] + box.count[a] - 1;
  }
  return extent;
}

/// Reads the entries of a part of an image, by a reader that has read the head.
template <class Reader>
void read_part(Reader& reader, const std::vector<Entry>& entries, const Extent& extent,
               const VtkMessages& messages, VtkVolume& volume) {
  // The readers have a member of this name.
  static_cast<vtkAlgorithm&>(reader).UpdateExtent(extent.data());
  check(reader, messages);
  vtkImageData* const image = vtkImageData::SafeDownCast(reader.GetOutput());
  if (image == nullptr || !std::equal(extent.begin(), extent.end(), image->GetExtent())) {
    throw Error("VTK does not give the part that is asked for" + std::string(damaged_file));
  }
  take_grid(*image, volume);
  take_values(*image, entries, volume);
  // The values belong to whoever has them.
  image->ReleaseData();
}

/// Takes from the head the description of an image, without values.
void take_outline(vtkInformation& about, const std::vector<Entry>& entries, VtkVolume& volume) {
  double origin[] = {0, 0, 0}, spacing[] = {1, 1, 1};
  double direction[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (about.Has(vtkDataObject::ORIGIN()) != 0) about.Get(vtkDataObject::ORIGIN(), origin);
  if (about.Has(vtkDataObject::SPACING()) != 0) about.Get(vtkDataObject::SPACING(), spacing);
  if (about.Has(vtkDataObject::DIRECTION()) != 0) {
    about.Get(vtkDataObject::DIRECTION(), direction);
  }
  take_place(whole_extent(about).data(), origin, spacing, direction, volume);
  for (const Entry& entry : entries) {
    volume.arrays.push_back({entry.name, entry.centering, entry.components, {}});
  }
}

/// Returns the type of values whose type does not depend on them: "f32".
std::string value_type(const Entry& entry) {
  const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(entry.type));
  std::string rounded;
  return std::string(type_name(values_in_place(*array, rounded)));
}

std::vector<VtkArrayName> names_of(const std::vector<Entry>& entries, bool with_ghosts) {
  std::vector<VtkArrayName> names;
  names.reserve(entries.size() + 2);
  for (const Entry& entry : entries) names.push_back({entry.centering, entry.in_file});
  if (with_ghosts) {
    names.push_back({Centering::point, ghost_name()});
    names.push_back({Centering::cell, ghost_name()});
  }
  return names;
}

/// Has the reader read the step nearest to the wanted time, the first if none is wanted.
void choose_step(vtkXMLReader& reader, const std::vector<double>& times,
                 const VtkVolumeRequest& request, VtkVolume& volume) {
  volume.times = times;
  if (!times.empty()) {
    reader.SetTimeStep(static_cast<int>(nearest_step(times, request.time)));
  } else if (request.time) {
    throw Error(no_times);
  }
}

template <class Reader, class Grid>
void read_xml_grid(const std::filesystem::path& path, const VtkVolumeRequest& request,
                   const VtkMessages& messages, VtkVolume& volume) {
  const auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  check(*reader, messages);
  vtkInformation* const about = reader->GetOutputInformation(0);
  if (about == nullptr) throw Error("the file is cut off or damaged");
  const std::vector<Entry> entries = choose(entries_of(*about), request, volume);
  const Extent whole = whole_extent(*about);
  vtkDataArraySelection* const points = reader->GetPointDataArraySelection();
  vtkDataArraySelection* const cells = reader->GetCellDataArraySelection();
  for (vtkDataArraySelection* const selection : {points, cells}) {
    selection->DisableAllArrays();
    if (selection->ArrayExists(ghost_name().c_str()) != 0) {
      selection->EnableArray(ghost_name().c_str());
    }
  }
  for (const Entry& entry : entries) {
    (entry.centering == Centering::point ? points : cells)->EnableArray(entry.in_file.c_str());
  }
  const CheckedVtkXml checked = request.check_arrays(names_of(entries, !request.hides_nothing));
  choose_step(*reader, checked.times, request, volume);
  const std::uintmax_t bytes = bytes_of(entries, whole);
  if constexpr (std::is_same_v<Grid, vtkImageData>) {
    // Readers read an array of several steps once.
    if (request.outline && checked.times.size() < 2 &&
        reads_parts(entries, *points, *cells, request.hides_nothing)) {
      volume.type = entries.front().type;
      volume.value_type = value_type(entries.front());
      take_outline(*about, entries, volume);
      volume.read = [reader, entries, whole, check_memory = request.check_memory](
                        const IndexBox& box, VtkVolume& part) {
        answer(part.error, remedy, [&] {
          const Extent extent = extent_of(whole, box);
          check_memory(bytes_of(entries, extent));
          const VtkMessages own;
          read_part(*reader, entries, extent, own, part);
        });
      };
      return;
    }
  }
  request.check_memory(bytes);
  reader->Update();
  check(*reader, messages);
  take_all<Grid>(reader->GetOutput(), volume);
  if constexpr (std::is_same_v<Grid, vtkRectilinearGrid>) {
    compare_pieces(*reader->GetOutput(), checked.pieces, messages, volume.notes);
  }
  take_values(*reader->GetOutput(), entries, volume);
}

template <class Reader, class Grid>
void read_legacy_grid(const std::filesystem::path& path, const VtkVolumeRequest& request,
                      const VtkMessages& messages, VtkVolume& volume) {
  if (request.time) throw Error(no_times);
  const auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(path.c_str());
  read_all_arrays(*reader);
  reader->Update();
  check(*reader, messages);
  take_all<Grid>(reader->GetOutput(), volume);
  take_values(*reader->GetOutput(), choose(entries_of(*reader->GetOutput()), request, volume),
              volume);
}

void read_volume(const std::filesystem::path& path, const VtkVolumeRequest& request,
                 VtkVolume& volume) {
  const VtkMessages messages;
  const std::string& data = request.data;
  const auto read = request.format == VtkFormat::legacy
                        ? (data == "RECTILINEAR_GRID"
                               ? read_legacy_grid<vtkRectilinearGridReader, vtkRectilinearGrid>
                               : read_legacy_grid<vtkStructuredPointsReader, vtkImageData>)
                    : data == "ImageData"  ? read_xml_grid<vtkXMLImageDataReader, vtkImageData>
                    : data == "PImageData" ? read_xml_grid<vtkXMLPImageDataReader, vtkImageData>
                    : data == "PRectilinearGrid"
                        ? read_xml_grid<vtkXMLPRectilinearGridReader, vtkRectilinearGrid>
                        : read_xml_grid<vtkXMLRectilinearGridReader, vtkRectilinearGrid>;
  read(path, request, messages, volume);
}

}  // namespace

}  // namespace pellucid

extern "C" __attribute__((visibility("default"))) void pellucid_read_volume_with_vtk_5(
    const std::filesystem::path& path, const pellucid::VtkVolumeRequest& request,
    pellucid::VtkVolume& answer) {
  pellucid::answer(answer.error, pellucid::remedy,
                   [&] { pellucid::read_volume(path, request, answer); });
}
