// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>

namespace pellucid {

/// Whether a file of VTK's has polyhedra, or looks as if. VTK 9.1 follows the numbers of their
/// faces without a look at where they lead: such a file is read by a process of its own, which may
/// crash.
bool has_vtk_polyhedra(const std::set<std::filesystem::path>& files);

}  // namespace pellucid
