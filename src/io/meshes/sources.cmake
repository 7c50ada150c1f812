# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    load_mesh.cpp
    mesh_archive.cpp
    mesh_blocks.cpp
    read_mesh.cpp
    volume_tetrahedra.cpp
  LOOPS
    mesh_blocks.cpp
    volume_tetrahedra.cpp)
