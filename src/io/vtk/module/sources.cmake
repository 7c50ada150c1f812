# SPDX-License-Identifier: Apache-2.0

# VTK's targets stay in this folder: benchmarks/ looks for others.
if(PELLUCID_WITH_VTK)
  enable_language(C)
  set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL OFF)
  set(vtk_modules CommonCore CommonDataModel CommonExecutionModel IOExodus IOLegacy IOXML)
  set(vtk_required "")
  if(NOT PELLUCID_WITH_VTK STREQUAL "AUTO")
    set(vtk_required REQUIRED)
  endif()
  find_package(VTK 9.0 ${vtk_required} QUIET COMPONENTS ${vtk_modules})
  set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
  if(VTK_FOUND)
    message(STATUS "VTK's files and Exodus are read through VTK ${VTK_VERSION}")
    list(TRANSFORM vtk_modules PREPEND VTK::)
    pellucid_module(pellucid_vtk
      SOURCES
        volumes/stored_numbers.cpp
        vtk/module/vtk_compare_pieces.cpp
        vtk/module/vtk_exodus.cpp
        vtk/module/vtk_gather.cpp
        vtk/module/vtk_legacy.cpp
        vtk/module/vtk_messages.cpp
        vtk/module/vtk_polyhedra.cpp
        vtk/module/vtk_read.cpp
        vtk/module/vtk_values.cpp
        vtk/module/vtk_volume_read.cpp
        vtk/module/vtk_xml.cpp
        vtk/vtk_cells.cpp
      LIBRARIES ${vtk_modules})
  elseif(vtk_required)
    message(FATAL_ERROR "VTK was not found; set PELLUCID_WITH_VTK=OFF to build without")
  else()
    message(STATUS "VTK was not found: its files and Exodus are not read")
  endif()
endif()
