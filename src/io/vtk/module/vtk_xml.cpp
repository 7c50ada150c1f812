// SPDX-License-Identifier: Apache-2.0
#include <vtkDataObject.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLFileReadTester.h>
#include <vtkXMLGenericDataObjectReader.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pellucid/scene/error.h"
#include "vtk_compare_pieces.h"
#include "vtk_gather.h"
#include "vtk_polyhedra.h"
#include "vtk_readers.h"

namespace pellucid {

namespace {

/// Returns the contents of the file that the root element names.
std::string kind_of(const std::filesystem::path& path, const VtkMessages& messages) {
  const auto tester = vtkSmartPointer<vtkXMLFileReadTester>::New();
  tester->SetFileName(path.c_str());
  const bool readable = tester->TestReadFile() != 0;
  messages.check();
  const char* const kind = tester->GetFileDataType();
  if (!readable || kind == nullptr) throw Error("is no XML file of VTK's, or damaged");
  return kind;
}

/// Returns the files of the pieces of a list if it names levels of ghosts, which VTK converts in
/// each piece, and then does not find, or if it does not name the flags of ghosts that they have,
/// or if they have faces of polyhedra that VTK does not read in a list. Else returns none.
std::vector<std::filesystem::path> pieces_alone(const std::filesystem::path& path,
                                                const std::string& kind,
                                                const CheckedVtkXml& checked) {
  if (kind != "PUnstructuredGrid") return {};
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  vtkXMLDataElement* const list =
      root == nullptr ? nullptr : root->FindNestedElementWithName(kind.c_str());
  if (list == nullptr) return {};
  bool has_levels = checked.has_unlisted_ghosts || checked.has_face_lists;
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < list->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* const element = list->GetNestedElement(i);
    const char* const source = element->GetAttribute("Source");
    if (source != nullptr) files.push_back(path.parent_path() / source);
    for (int a = 0; source == nullptr && a < element->GetNumberOfNestedElements(); ++a) {
      const char* const name = element->GetNestedElement(a)->GetAttribute("Name");
      has_levels = has_levels || (name != nullptr && std::string(name) == "vtkGhostLevels");
    }
  }
  if (!has_levels) files.clear();
  return files;
}

/// Runs the reader at a step in time. The readers count steps, and do not know the times.
void update_step(vtkXMLReader& reader, const MeshReadOptions& options,
                 const std::vector<double>& times, const VtkMessages& messages, MeshFile& file) {
  if (times.size() < 2) {
    update(reader, options, messages, file);
    return;
  }
  reader.UpdateInformation();
  messages.check();
  const std::size_t step = nearest_step(times, options.time);
  MeshFile counted;
  std::vector<double> numbers;
  for (std::size_t i = 0; i < times.size(); ++i) numbers.push_back(static_cast<double>(i));
  update(reader, {numbers[step], {}, {}}, numbers, messages, counted);
  file.times = times;
  file.time = times[step];
}

void read_data(const std::filesystem::path& path, const std::string& kind,
               const MeshReadOptions& options, const CheckVtkXml& check,
               const VtkMessages& messages, MeshBlocks& mesh) {
  if (kind.ends_with("ImageData") || kind.ends_with("RectilinearGrid")) {
    throw Error("holds " + kind + ", a volume on a regular grid and no mesh; read it as one");
  }
  if (kind.ends_with("PolyData")) {
    throw Error("holds " + kind + ", a surface; give the volume that it belongs to");
  }
  if (kind != "UnstructuredGrid" && kind != "PUnstructuredGrid" && kind != "StructuredGrid" &&
      kind != "PStructuredGrid" && kind != "vtkMultiBlockDataSet") {
    throw Error("holds " + kind.substr(0, 40) +
                "; read are unstructured and structured grids and multiblock files of them");
  }
  const CheckedVtkXml checked = check(path);
  if (const auto pieces = pieces_alone(path, kind, checked); !pieces.empty()) {
    refuse_time(options);
    for (const std::filesystem::path& piece : pieces) {
      const std::string own = kind_of(piece, messages);
      if (own != "UnstructuredGrid") throw Error("has a piece that holds " + own.substr(0, 40));
      read_data(piece, own, {}, check, messages, mesh);
    }
    return;
  }
  if (kind == "UnstructuredGrid") {
    const auto reader = vtkSmartPointer<PolyhedraReader>::New();
    reader->SetFileName(path.c_str());
    update_step(*reader, options, checked.times, messages, mesh.file);
    vtkUnstructuredGrid* const grid = reader->GetOutput();
    if (grid == nullptr) throw Error("the file is cut off or damaged");
    reader->give_faces(*grid);
    gather(*grid, mesh);
    return;
  }
  const auto reader = vtkSmartPointer<vtkXMLGenericDataObjectReader>::New();
  reader->SetFileName(path.c_str());
  update_step(*reader, options, checked.times, messages, mesh.file);
  vtkDataObject* const data = reader->GetOutput();
  if (data == nullptr) throw Error("the file is cut off or damaged");
  gather(*data, mesh);
  if (auto* const grid = vtkStructuredGrid::SafeDownCast(data); grid != nullptr) {
    compare_pieces(*grid, checked.pieces, messages, mesh.file.notes);
  }
}

struct Step {
  double time;
  std::filesystem::path file;
};

/// Returns the files of a .pvd, ascending by time.
std::vector<Step> steps_of(const std::filesystem::path& path, const VtkMessages& messages) {
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  messages.check();
  vtkXMLDataElement* const collection =
      root == nullptr ? nullptr : root->FindNestedElementWithName("Collection");
  if (collection == nullptr) throw Error("has no Collection of files; it is damaged");
  std::vector<Step> steps;
  const int count = collection->GetNumberOfNestedElements();
  steps.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    vtkXMLDataElement* const entry = collection->GetNestedElement(i);
    const char* const file = entry->GetAttribute("file");
    if (file == nullptr || *file == '\0') continue;
    double time = 0;
    if (entry->GetAttribute("timestep") != nullptr &&
        (entry->GetScalarAttribute("timestep", time) == 0 || !std::isfinite(time))) {
      throw Error("the timestep of " + std::string(file) + " is no number; correct the file");
    }
    steps.push_back({time, path.parent_path() / file});
  }
  if (steps.empty()) throw Error("its Collection names no file; it is damaged");
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.time < b.time; });
  return steps;
}

void read_collection(const std::filesystem::path& path, const MeshReadOptions& options,
                     const CheckVtkXml& check, const VtkMessages& messages, MeshBlocks& mesh) {
  const std::vector<Step> steps = steps_of(path, messages);
  std::vector<double> times;
  times.reserve(steps.size());
  for (const Step& step : steps) {
    if (times.empty() || times.back() != step.time) times.push_back(step.time);
  }
  const double time = times[nearest_step(times, options.time)];
  for (const Step& step : steps) {
    if (step.time != time) continue;
    const std::string name = step.file.filename().string();
    std::error_code error;
    if (!std::filesystem::is_regular_file(step.file, error)) {
      throw Error("names " + name + ", which is not there; put it beside it");
    }
    try {
      read_data(step.file, kind_of(step.file, messages), {}, check, messages, mesh);
      if (mesh.file.times.size() > 1) {
        throw Error("has steps in time of its own, of which a list chooses none; give it alone");
      }
    } catch (const Error& part) {
      throw Error(name + " " + part.what());
    }
  }
  mesh.file.times = times;
  mesh.file.time = time;
}

}  // namespace

void read_xml(const std::filesystem::path& path, const MeshReadOptions& options,
              const CheckVtkXml& check, const VtkMessages& messages, MeshBlocks& mesh) {
  const std::string kind = kind_of(path, messages);
  mesh.file.format = "VTK XML";
  if (kind == "Collection") {
    read_collection(path, options, check, messages, mesh);
  } else {
    read_data(path, kind, options, check, messages, mesh);
  }
}

}  // namespace pellucid
