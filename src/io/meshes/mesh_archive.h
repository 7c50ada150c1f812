// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "mesh_blocks.h"
#include "process/child_process.h"

namespace pellucid {

/// Writes a mesh as a process hands it to another.
void write_mesh_blocks(const MeshBlocks& mesh, const MakeAnswer& make);
/// Reads what that wrote; nothing where it is damaged.
std::optional<MeshBlocks> read_mesh_blocks(std::span<const std::byte> from);

}  // namespace pellucid
