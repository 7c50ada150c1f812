# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    hdf5_format.cpp
    vtk_hdf.cpp
    vtk_hdf_mesh.cpp
    vtk_hdf_volume.cpp
  VOLUME_FORMATS hdf5_format vtk_hdf_format
  MESH_FORMATS vtk_hdf_mesh_format)

include("${CMAKE_CURRENT_SOURCE_DIR}/grid_modules/grid_module.cmake")
set(hdf5_sources
  ${pellucid_axes_sources}
  hdf5/hdf5_attributes.cpp
  hdf5/hdf5_imaris.cpp
  hdf5/hdf5_read.cpp
  hdf5/vtk_hdf_read.cpp)
pellucid_grid_module(HDF5 pellucid_hdf5 hdf5.h "hdf5_serial;hdf5" hdf5/serial
  "${hdf5_sources}" HDF5)
if(TARGET pellucid_hdf5)
  # Two functions have one more argument from HDF5 1.12 on. 1.10 does not know this name.
  target_compile_definitions(pellucid_hdf5 PRIVATE H5_USE_110_API)
endif()
