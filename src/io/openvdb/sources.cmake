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
  # OpenVDB includes a part of Boost 1.74 that casts -1 to an enumeration, which is an error there.
  if(TARGET pellucid_openvdb AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang"
     AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER 16
     AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 20)
    target_compile_options(pellucid_openvdb PRIVATE -Wno-enum-constexpr-conversion)
  endif()
endif()
