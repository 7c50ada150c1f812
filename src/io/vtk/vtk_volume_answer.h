// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "process/child_process.h"
#include "vtk_volume_open.h"

namespace pellucid {

/// Write what a process found to the bytes that go to another.
void write_opened(const OpenedVtkVolume& opened, const MakeAnswer& make);
void write_arrays(const std::vector<VolumeArray>& arrays, const MakeAnswer& make);

/// Read what these wrote; nothing where it does not stand there, for the process may have written
/// anything. The values stay in place.
std::optional<OpenedVtkVolume> read_opened(const ChildBytes& bytes, const std::string& name);
std::optional<std::vector<VolumeArray>> read_arrays(const ChildBytes& bytes);

}  // namespace pellucid
