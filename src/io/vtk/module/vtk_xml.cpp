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
#include "text/text.h"
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

/// Returns the path of a file that a list beside it names. Throws Error where there is none.
std::filesystem::path beside(const std::filesystem::path& list, const std::string& name) {
  const std::filesystem::path file = list.parent_path() / name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw Error("names " + one_line(file.filename().string()) +
                ", which is not there; put it beside it");
  }
  return file;
}

/// Appends the files that a list's elements `name` give in the attribute `attribute`, however deep
/// in blocks they lie. An element without it stands for an empty block.
void list_files(vtkXMLDataElement& list, const std::string& name, const char* attribute,
                std::vector<std::string>& files) {
  for (int i = 0; i < list.GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement& element = *list.GetNestedElement(i);
    const char* const file = element.GetName() == name ? element.GetAttribute(attribute) : nullptr;
    if (file != nullptr && *file != '\0') files.emplace_back(file);
    list_files(element, name, attribute, files);
  }
}

/// Returns the files that a list of this kind names; none: it is no list. They are read one by one,
/// for VTK (until 9.3 at least) makes faces of polyhedra out of types of cells that it has not read
/// yet when it reads a PUnstructuredGrid, does not find the levels of ghosts that it converts in
/// each piece, leaves out arrays that the list does not name, and knows one form of polyhedra.
std::vector<std::string> listed_files(const std::filesystem::path& path, const std::string& kind) {
  const bool of_pieces = kind == "PUnstructuredGrid";
  if (!of_pieces && kind != "vtkMultiBlockDataSet") return {};
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  vtkXMLDataElement* const list =
      root == nullptr ? nullptr : root->FindNestedElementWithName(kind.c_str());
  std::vector<std::string> files;
  if (list != nullptr) {
    list_files(*list, of_pieces ? "Piece" : "DataSet", of_pieces ? "Source" : "file", files);
  }
  if (files.empty()) throw Error("names no file; it is empty or damaged");
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
               const VtkMessages& messages, MeshBlocks& mesh);

/// Reads the files of a list.
void read_listed(const std::filesystem::path& path, const std::string& kind,
                 const std::vector<std::string>& files, const CheckVtkXml& check,
                 const VtkMessages& messages, MeshBlocks& mesh) {
  for (const std::string& name : files) {
    const std::filesystem::path file = beside(path, name);
    try {
      const std::string own = kind_of(file, messages);
      if (kind == "PUnstructuredGrid" && own != "UnstructuredGrid") {
        throw Error("holds " + own.substr(0, 40) + " in place of UnstructuredGrid");
      }
      if (own == "vtkMultiBlockDataSet") {
        throw Error("is a list of blocks itself; name its files in the first list");
      }
      if (own.ends_with("PolyData")) {
        const auto reader = vtkSmartPointer<vtkXMLGenericDataObjectReader>::New();
        reader->SetFileName(file.c_str());
        update(*reader, {}, messages, mesh.file);
        if (reader->GetOutput() != nullptr) gather(*reader->GetOutput(), mesh);
      } else {
        read_data(file, own, {}, check, messages, mesh);
      }
    } catch (const Error& part) {
      throw Error("its part " + one_line(file.filename().string()) + " " + part.what());
    }
  }
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
  if (const auto files = listed_files(path, kind); !files.empty()) {
    refuse_time(options);
    const auto check_once = [&](const std::filesystem::path& file) {
      return checked.files.contains(file) ? CheckedVtkXml{} : check(file);
    };
    read_listed(path, kind, files, check_once, messages, mesh);
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
  std::string file;
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
    steps.push_back({time, file});
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
    const std::filesystem::path file = beside(path, step.file);
    try {
      read_data(file, kind_of(file, messages), {}, check, messages, mesh);
      if (mesh.file.times.size() > 1) {
        throw Error("has steps in time of its own, of which a list chooses none; give it alone");
      }
    } catch (const Error& part) {
      throw Error(one_line(file.filename().string()) + " " + part.what());
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
