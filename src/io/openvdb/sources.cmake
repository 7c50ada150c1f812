# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    vdb_format.cpp
    vdb_size.cpp
  VOLUME_FORMATS vdb_format)

include("${CMAKE_CURRENT_SOURCE_DIR}/grid_modules/grid_module.cmake")
if(PELLUCID_WITH_OPENVDB)
  find_package(Imath 3 REQUIRED CONFIG)  # as OpenEXR, which stands on it
  find_package(TBB REQUIRED)
  pellucid_grid_module(OPENVDB pellucid_openvdb openvdb/openvdb.h openvdb ""
    openvdb/openvdb_read.cpp OpenVDB TBB::tbb Imath::Imath)
  if(TARGET pellucid_openvdb)
    target_compile_options(pellucid_openvdb PRIVATE ${pellucid_openvdb_options})
  endif()
endif()
