# SPDX-License-Identifier: Apache-2.0
include_guard(DIRECTORY)

# pellucid_grid_module(OPTION MODULE HEADER LIBRARY FOLDER SOURCES WHAT [target...]): a module that
# reads WHAT by a library without a package of CMake's that all systems have, by the header and the
# library. Targets are what its headers need beside.
function(pellucid_grid_module option module header library folder source what)
  if(NOT PELLUCID_WITH_${option})
    return()
  endif()
  find_path(PELLUCID_${option}_INCLUDE_DIR ${header} PATH_SUFFIXES ${folder})
  find_library(PELLUCID_${option}_LIBRARY NAMES ${library} PATH_SUFFIXES ${folder})
  mark_as_advanced(PELLUCID_${option}_INCLUDE_DIR PELLUCID_${option}_LIBRARY)
  if(PELLUCID_${option}_INCLUDE_DIR AND PELLUCID_${option}_LIBRARY)
    message(STATUS "${what} files are read through ${PELLUCID_${option}_LIBRARY}")
    pellucid_module(${module} SOURCES grid_modules/grid_module_entries.cpp
      volumes/stored_numbers.cpp ${source}
      LIBRARIES "${PELLUCID_${option}_LIBRARY}" ${ARGN})
    target_include_directories(${module} SYSTEM PRIVATE "${PELLUCID_${option}_INCLUDE_DIR}")
  elseif(NOT PELLUCID_WITH_${option} STREQUAL "AUTO")
    message(FATAL_ERROR "${what} was not found; set PELLUCID_WITH_${option}=OFF to build without")
  else()
    message(STATUS "${what} was not found: its files are not read")
  endif()
endfunction()

# What names and attributes of axes and values mean, in HDF5 and NetCDF alike.
set(pellucid_axes_sources
  axes/array_axes.cpp
  axes/axis_meaning.cpp
  axes/axis_role.cpp
  axes/position_names.cpp
  axes/positions_beside.cpp
  axes/value_meaning.cpp
  axes/variable_notes.cpp)
