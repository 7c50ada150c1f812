# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    plot3d.cpp
  LOOPS
    plot3d.cpp
  MESH_FORMATS plot3d_format)
