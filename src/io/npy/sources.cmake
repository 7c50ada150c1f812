# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    npy.cpp
  LATER
    mesh_npz.cpp
    npz.cpp
    write_npz.cpp
  LOOPS
    mesh_npz.cpp
    npy.cpp
    write_npz.cpp
  FIRST_VOLUME_FORMATS npy_format
  VOLUME_FORMATS npz_format
  MESH_FORMATS mesh_npz_format
  VOLUME_WRITERS npz_writer)
