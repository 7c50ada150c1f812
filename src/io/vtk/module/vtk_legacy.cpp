// SPDX-License-Identifier: Apache-2.0
#include <vtkDataReader.h>
#include <vtkStructuredGrid.h>
#include <vtkStructuredGridReader.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>

#include <fstream>
#include <sstream>
#include <string>

#include "pellucid/scene/error.h"
#include "vtk_gather.h"
#include "vtk_readers.h"

namespace pellucid {

namespace {

std::string upper_case(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

/// Returns the word behind DATASET, in capitals. It stands in the fourth line.
std::string dataset_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  constexpr std::size_t longest = 2048;
  std::string head(longest, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  std::istringstream lines(head);
  std::string line;
  if (!std::getline(lines, line) || !line.starts_with("# vtk DataFile")) {
    throw Error("does not begin with \"# vtk DataFile\"; it is no VTK file, or damaged");
  }
  std::getline(lines, line);  // the title
  std::string coding, key, dataset;
  lines >> coding >> key >> dataset;
  coding = upper_case(coding);
  if ((coding != "ASCII" && coding != "BINARY") || upper_case(key) != "DATASET") {
    throw Error("the header lacks ASCII or BINARY, or the kind of its data; it is damaged");
  }
  return upper_case(dataset);
}

template <class Reader>
void read_grid(const std::filesystem::path& path, const VtkMessages& messages, MeshBlocks& mesh) {
  const auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(path.c_str());
  read_all_arrays(*reader);
  update(*reader, {}, messages, mesh.file);
  // Steps are files of their own; one alone is given the time 0.
  mesh.file.times.clear();
  mesh.file.time.reset();
  gather(*reader->GetOutput(), mesh);
}

}  // namespace

void read_all_arrays(vtkDataReader& reader) {
  reader.ReadAllScalarsOn();
  reader.ReadAllVectorsOn();
  reader.ReadAllNormalsOn();
  reader.ReadAllTensorsOn();
  reader.ReadAllColorScalarsOn();
  reader.ReadAllTCoordsOn();
  reader.ReadAllFieldsOn();
}

void read_legacy(const std::filesystem::path& path, const MeshReadOptions& options,
                 const VtkMessages& messages, MeshBlocks& mesh) {
  refuse_time(options);
  mesh.file.format = "legacy VTK";
  const std::string dataset = dataset_of(path);
  if (dataset == "UNSTRUCTURED_GRID") {
    read_grid<vtkUnstructuredGridReader>(path, messages, mesh);
  } else if (dataset == "STRUCTURED_GRID") {
    read_grid<vtkStructuredGridReader>(path, messages, mesh);
  } else if (dataset == "STRUCTURED_POINTS" || dataset == "RECTILINEAR_GRID") {
    throw Error("holds " + dataset + ", a volume on a regular grid and no mesh; read it as one");
  } else if (dataset == "POLYDATA") {
    throw Error("holds POLYDATA, a surface; give the volume that it belongs to");
  } else {
    throw Error("holds " + dataset.substr(0, 40) +
                "; read are UNSTRUCTURED_GRID and STRUCTURED_GRID");
  }
}

}  // namespace pellucid
