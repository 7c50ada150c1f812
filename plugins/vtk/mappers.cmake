# SPDX-License-Identifier: Apache-2.0

# pellucid_vtk_mappers(TARGET MODULES module... [SOURCES file...]): what draws volumes in a window
# of VTK, as objects, and more sources of this folder. The plug-ins for VTK and for ParaView are
# made of it, each for its own VTK.
set(_pellucid_vtk_folder "${CMAKE_CURRENT_LIST_DIR}")
function(pellucid_vtk_mappers target)
  cmake_parse_arguments(arg "" "" "MODULES;SOURCES" ${ARGN})
  set(sources
    ghost_cells.cpp
    grid_data.cpp
    grid_layers.cpp
    mapper_core.cpp
    mesh_layers.cpp
    selection.cpp
    settings.cpp
    view.cpp
    vtkPellucidUnstructuredGridMapper.cpp
    ${arg_SOURCES})
  list(TRANSFORM sources PREPEND "${_pellucid_vtk_folder}/")
  add_library(${target} OBJECT
    ${sources}
    # Arrays of VTK are taken as by the readers of its files.
    "${PROJECT_SOURCE_DIR}/src/io/vtk/module/vtk_gather.cpp"
    "${PROJECT_SOURCE_DIR}/src/io/vtk/module/vtk_values.cpp")
  set_target_properties(${target} PROPERTIES
    POSITION_INDEPENDENT_CODE ON
    CXX_EXTENSIONS OFF
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON)
  pellucid_unity(${target} BATCH 5)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target}
    PUBLIC "${_pellucid_vtk_folder}" "${PROJECT_SOURCE_DIR}/src/io")
  target_link_libraries(${target}
    PUBLIC pellucid::cpu pellucid::io ${arg_MODULES}
    PRIVATE pellucid_build_flags)
  vtk_module_autoinit(TARGETS ${target} MODULES ${arg_MODULES})
endfunction()
