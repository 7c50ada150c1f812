# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    vtk_mesh.cpp
    legacy_vtk_cells.cpp
    legacy_vtk_numbers.cpp
    vtk_cells.cpp
    vtk_collection.cpp
    vtk_file_kind.cpp
    vtk_files.cpp
    vtk_image_pieces.cpp
    vtk_js.cpp
    vtk_module.cpp
    vtk_volume.cpp
    vtk_volume_answer.cpp
    vtk_volume_open.cpp
    vtu_file.cpp
    write_vti.cpp
  LOOPS
    vtk_image_pieces.cpp
    vtk_volume_open.cpp
    vtu_file.cpp
    write_vti.cpp
  VOLUME_FORMATS vtk_format image_collection_format vtk_js_format
  MESH_FORMATS vtk_xml_mesh_format vtk_legacy_mesh_format exodus_format
  VOLUME_WRITERS vti_writer)
