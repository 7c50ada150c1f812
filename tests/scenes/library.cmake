# SPDX-License-Identifier: Apache-2.0
# The scenes that tests and benchmarks share; included where they are needed.
include_guard(GLOBAL)
find_package(Boost REQUIRED)
find_package(Threads REQUIRED)
set(scenes_folder "${CMAKE_CURRENT_LIST_DIR}")
set(scenes_sources
  analytic.cpp cameras.cpp difference.cpp gallery/cells.cpp gallery/gallery.cpp
  gallery/gaussians.cpp gallery/grids.cpp gallery/layers.cpp gallery/light.cpp
  gallery/marschner_lobb.cpp gallery/meshes.cpp gallery/scans.cpp gallery/strides.cpp
  gallery/tables.cpp layer_makers.cpp makers.cpp meshes.cpp peers.cpp real.cpp scene_hash.cpp)
set(matrix_sources reference_frame.cpp reference_truth.cpp tolerance_matrix.cpp verdict.cpp)
add_library(pellucid_test_scenes STATIC)
list(TRANSFORM scenes_sources PREPEND "${scenes_folder}/")
target_sources(pellucid_test_scenes PRIVATE ${scenes_sources})
target_include_directories(pellucid_test_scenes PUBLIC "${PROJECT_SOURCE_DIR}")
target_compile_definitions(pellucid_test_scenes PRIVATE PELLUCID_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
foreach(module IN ITEMS itk vtk)
  if(TARGET pellucid_${module})
    string(TOUPPER ${module} option)
    target_compile_definitions(pellucid_test_scenes PRIVATE PELLUCID_HAVE_${option})
  endif()
endforeach()
target_link_libraries(pellucid_test_scenes
  PUBLIC pellucid::scene
  PRIVATE pellucid::io Boost::headers pellucid_build_flags)
# Those of the gallery have names alike.
if(PELLUCID_TEST_UNITY)
  pellucid_unity(pellucid_test_scenes BATCH 5)
  set(gallery ${scenes_sources})
  list(FILTER gallery INCLUDE REGEX "/gallery/[^/]*$")
  set_source_files_properties(${gallery} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endif()

# What renders them to a tolerance and holds them against the reference.
add_library(pellucid_test_matrix STATIC)
list(TRANSFORM matrix_sources PREPEND "${scenes_folder}/")
target_sources(pellucid_test_matrix PRIVATE ${matrix_sources})
target_compile_definitions(pellucid_test_matrix PRIVATE PELLUCID_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
target_link_libraries(pellucid_test_matrix
  PUBLIC pellucid_test_scenes pellucid::cpu
  PRIVATE pellucid::reference Threads::Threads pellucid_build_flags)
if(PELLUCID_TEST_UNITY)
  pellucid_unity(pellucid_test_matrix BATCH 4)
endif()
