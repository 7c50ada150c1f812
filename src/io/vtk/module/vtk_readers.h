// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkDataObject.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <vector>

#include "meshes/mesh_blocks.h"
#include "vtk/vtk_module.h"
#include "vtk_messages.h"

class vtkAlgorithm;
class vtkDataReader;

namespace pellucid {

/// .vtu, .vts, .vtm and what they are parts of; .pvd.
void read_xml(const std::filesystem::path& path, const MeshReadOptions& options,
              const CheckVtkXml& check, const VtkMessages& messages, MeshBlocks& mesh);
void read_legacy(const std::filesystem::path& path, const MeshReadOptions& options,
                 const VtkMessages& messages, MeshBlocks& mesh);
/// Displacements are applied to the points, where a file has them.
void read_exodus(const std::filesystem::path& path, const MeshReadOptions& options,
                 const VtkMessages& messages, MeshBlocks& mesh);

/// Returns the times of its steps that have one.
std::vector<double> exodus_times(const std::filesystem::path& path, const VtkMessages& messages);

/// Runs the reader at the step that the options ask for, and puts the file's times into `file`.
/// Throws Error where VTK says one, or a time is asked for where there is none.
void update(vtkAlgorithm& reader, const MeshReadOptions& options, const VtkMessages& messages,
            MeshFile& file);
/// The same among these times, of a reader that has read the head.
void update(vtkAlgorithm& reader, const MeshReadOptions& options, const std::vector<double>& times,
            const VtkMessages& messages, MeshFile& file);
/// Returns the times of the steps, where the reader has read the head.
std::vector<double> times_of(vtkAlgorithm& reader);
/// Legacy files: by itself a reader takes the first array of each kind.
void read_all_arrays(vtkDataReader& reader);
/// Throws Error where a time is asked for.
void refuse_time(const MeshReadOptions& options);

}  // namespace pellucid
