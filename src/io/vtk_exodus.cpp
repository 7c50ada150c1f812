// SPDX-License-Identifier: Apache-2.0
#include <vtkExodusIIReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtk_exodusII.h>

#include "pellucid/scene/error.h"
#include "vtk_gather.h"
#include "vtk_readers.h"

namespace pellucid {

void read_exodus(const std::filesystem::path& path, const MeshReadOptions& options,
                 const VtkMessages& messages, MeshBlocks& mesh) {
  const auto reader = vtkSmartPointer<vtkExodusIIReader>::New();
  ex_opts(0);  // else Exodus prints what it finds wrong
  if (reader->CanReadFile(path.c_str()) == 0) {
    throw Error("is no Exodus II file, or is cut off or damaged");
  }
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  messages.check();
  reader->GenerateObjectIdCellArrayOff();
  for (const int kind : {vtkExodusIIReader::ELEM_BLOCK, vtkExodusIIReader::NODAL}) {
    reader->SetAllArrayStatus(kind, 1);
  }
  for (int i = 0; i < reader->GetNumberOfObjects(vtkExodusIIReader::ELEM_BLOCK); ++i) {
    reader->SetObjectStatus(vtkExodusIIReader::ELEM_BLOCK, i, 1);
  }
  update(*reader, options, messages, mesh.file);
  mesh.file.format = "Exodus II";
  gather(*reader->GetOutput(), mesh);
}

}  // namespace pellucid
