# SPDX-License-Identifier: Apache-2.0
option(PELLUCID_LIBFUZZER "Link the fuzz targets with libFuzzer (clang; preset fuzz)" OFF)

# pellucid_fuzz_target(NAME SOURCES file... [LIBRARIES target...] [SEEDS folder] [RUNS number])
#
# The executable fuzz_NAME from sources that define LLVMFuzzerTestOneInput, and the ctest fuzz.NAME.
# With PELLUCID_LIBFUZZER the test is ten seconds of libFuzzer that begin with the seeds; without,
# it runs the seeds and RUNS mutants of them, always the same ones (tests/fuzz/standalone_main.cpp).
function(pellucid_fuzz_target name)
  cmake_parse_arguments(arg "" "SEEDS;RUNS" "SOURCES;LIBRARIES" ${ARGN})
  if(NOT arg_RUNS)
    set(arg_RUNS 2000)
  endif()
  add_executable(fuzz_${name} ${arg_SOURCES})
  set_target_properties(fuzz_${name} PROPERTIES CXX_EXTENSIONS OFF)
  target_link_libraries(fuzz_${name} PRIVATE ${arg_LIBRARIES} pellucid_build_flags)
  set(seeds)
  if(arg_SEEDS)
    get_filename_component(seeds "${arg_SEEDS}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
  endif()
  if(PELLUCID_LIBFUZZER)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
    set(corpus "${CMAKE_CURRENT_BINARY_DIR}/corpus/${name}")
    file(MAKE_DIRECTORY "${corpus}")
    add_test(NAME fuzz.${name}
      COMMAND fuzz_${name} -max_total_time=10 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1
              "${corpus}" ${seeds})
  else()
    target_sources(fuzz_${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests/fuzz/standalone_main.cpp")
    add_test(NAME fuzz.${name} COMMAND fuzz_${name} -runs=${arg_RUNS} ${seeds})
  endif()
  set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT ${PELLUCID_TEST_SECONDS}
    WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}")
  if(NOT TARGET fuzz_targets)
    add_custom_target(fuzz_targets)
  endif()
  add_dependencies(fuzz_targets fuzz_${name})
endfunction()
