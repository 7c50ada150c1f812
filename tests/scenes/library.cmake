# SPDX-License-Identifier: Apache-2.0
# The scenes that tests and benchmarks share; included where they are needed.
include_guard(GLOBAL)
find_package(Boost REQUIRED)
set(scenes_folder "${CMAKE_CURRENT_LIST_DIR}")
add_library(pellucid_test_scenes STATIC
  "${scenes_folder}/analytic.cpp" "${scenes_folder}/difference.cpp" "${scenes_folder}/peers.cpp"
  "${scenes_folder}/real.cpp")
target_include_directories(pellucid_test_scenes PUBLIC "${PROJECT_SOURCE_DIR}")
target_compile_definitions(pellucid_test_scenes PRIVATE PELLUCID_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
target_link_libraries(pellucid_test_scenes
  PUBLIC pellucid::scene
  PRIVATE pellucid::io Boost::headers pellucid_build_flags)
