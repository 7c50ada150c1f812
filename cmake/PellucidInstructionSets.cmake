# SPDX-License-Identifier: Apache-2.0
option(PELLUCID_SIMD
  "Packets of rays for SSE4.1, AVX2 and AVX-512, chosen at run time, or NEON (needs xsimd)" ON)

set(_pellucid_processor other)
if(PELLUCID_WEB)
  set(_pellucid_processor web)
elseif(CMAKE_SIZEOF_VOID_P EQUAL 8 AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    set(_pellucid_processor x86)
  elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
    set(_pellucid_processor arm)
  endif()
endif()

# The sets of the processor, best last (simd/instruction_set.h lists the same), the lanes of a
# packet in each, and the options of the compiler.
set(PELLUCID_INSTRUCTION_SETS sse4 avx2 avx512)
if(_pellucid_processor STREQUAL "arm")
  set(PELLUCID_INSTRUCTION_SETS neon64)
elseif(_pellucid_processor STREQUAL "web")
  set(PELLUCID_INSTRUCTION_SETS wasm128)
endif()
set(PELLUCID_BUILD_SETS "all" CACHE STRING
    "Instruction sets to build kernels for; native: the best of this machine; native+1: and one")
set(_pellucid_lanes_sse4 4)
set(_pellucid_lanes_avx2 8)
set(_pellucid_lanes_avx512 16)
set(_pellucid_lanes_neon64 4)
set(_pellucid_lanes_wasm128 4)
set(_pellucid_flags_sse4 -msse4.1)
set(_pellucid_flags_avx2 -mavx2 -mfma)
set(_pellucid_flags_avx512 -mavx512f -mavx512cd -mavx512dq -mavx512bw -mavx512vl -mfma
    -mprefer-vector-width=512)
# Since GCC 12: batches are copied by whole registers. By halves of them, its default for AVX2, a
# load of the whole waits until both are written.
set(_pellucid_gcc_12_flags_avx2 -mmove-max=256 -mstore-max=256)
set(_pellucid_flags_neon64)  # every AArch64 processor has it
set(_pellucid_flags_wasm128 -msimd128 -msse4.1)  # SSE's functions by WebAssembly's instructions

set(PELLUCID_SIMD_FOUND FALSE)
if(PELLUCID_SIMD AND NOT _pellucid_processor STREQUAL "other")
  # Its package file takes the same major version alone.
  find_package(xsimd QUIET)
  if(NOT xsimd_FOUND OR xsimd_VERSION VERSION_LESS 8.1)
    message(FATAL_ERROR "xsimd 8.1 or later is not there: install it (Debian: libxsimd-dev), "
                        "or do without packets: -DPELLUCID_SIMD=OFF")
  endif()
  set(PELLUCID_SIMD_FOUND TRUE)
endif()

set(_pellucid_built_sets ${PELLUCID_BUILD_SETS})
if(_pellucid_built_sets STREQUAL "all"
   OR (_pellucid_built_sets MATCHES "^native(\\+1)?$" AND NOT _pellucid_processor STREQUAL "x86"))
  set(_pellucid_built_sets ${PELLUCID_INSTRUCTION_SETS})
elseif(_pellucid_built_sets MATCHES "^native(\\+1)?$" AND PELLUCID_SIMD_FOUND)
  file(STRINGS /proc/cpuinfo _pellucid_flags REGEX "^flags" LIMIT_COUNT 1)
  set(_pellucid_native sse4)
  if(_pellucid_flags MATCHES " avx2( |$)" AND _pellucid_flags MATCHES " fma( |$)")
    list(APPEND _pellucid_native avx2)
    set(_pellucid_best TRUE)
    foreach(_pellucid_flag IN ITEMS avx512f avx512cd avx512dq avx512bw avx512vl)
      if(NOT _pellucid_flags MATCHES " ${_pellucid_flag}( |$)")
        set(_pellucid_best FALSE)
      endif()
    endforeach()
    if(_pellucid_best)
      list(APPEND _pellucid_native avx512)
    endif()
  endif()
  # The best set of the machine; for the tests of every change the next one as well, so that kernels
  # of two widths are held against each other.
  set(_pellucid_count 1)
  if(_pellucid_built_sets STREQUAL "native+1")
    set(_pellucid_count 2)
  endif()
  list(REVERSE _pellucid_native)
  list(SUBLIST _pellucid_native 0 ${_pellucid_count} _pellucid_built_sets)
  message(STATUS "Kernels are built for ${_pellucid_built_sets}, the best of this machine")
endif()
foreach(_pellucid_set IN LISTS _pellucid_built_sets)
  if(PELLUCID_SIMD_FOUND AND NOT _pellucid_set IN_LIST PELLUCID_INSTRUCTION_SETS)
    message(FATAL_ERROR "PELLUCID_BUILD_SETS: \"${_pellucid_set}\" is no instruction set; "
                        "name some of ${PELLUCID_INSTRUCTION_SETS}, or all, native, or native+1")
  endif()
endforeach()

# pellucid_instruction_sets(TARGET SOURCES file... [LATER file...] [INSTEAD file...] [ABSENT file]
#                           [ENTRIES name...] [LIBRARIES target...])
#
# Compiles the sources (LATER and INSTEAD: see pellucid_first_sources()) once per instruction set
# and adds the objects to TARGET; LIBRARIES say what they include. For a set that
# PELLUCID_BUILD_SETS leaves out, ABSENT is compiled in their place, or functions named by ENTRIES
# that return null.
# In these sources
#   PELLUCID_LANES             is 4, 8 or 16,
#   PELLUCID_INSTRUCTION_SET   is sse4, avx2, avx512, neon64 or wasm128,
#   pellucid                   is a macro: the project's namespace gets another name in each, so
#                              that an inline function compiled for AVX-512 is never the one that
#                              the linker keeps for code that runs elsewhere.
# What they give to others are functions declared extern "C" outside of that namespace, named by
# PELLUCID_ENTRY (simd/instruction_set.h), and plain structs; tests/architecture reads the objects'
# symbols. TARGET's own sources see PELLUCID_HAS_PACKETS, 1 or 0: on other processors than x86-64
# and AArch64 and WebAssembly's, or without PELLUCID_SIMD, nothing is compiled.
function(pellucid_instruction_sets target)
  cmake_parse_arguments(arg "" "ABSENT" "SOURCES;LATER;INSTEAD;ENTRIES;LIBRARIES" ${ARGN})
  set(sources ${arg_SOURCES})
  if(PELLUCID_FIRST_PICTURE)
    list(APPEND sources ${arg_INSTEAD})
  else()
    list(APPEND sources ${arg_LATER})
  endif()
  if(NOT PELLUCID_SIMD_FOUND)
    target_compile_definitions(${target} PRIVATE PELLUCID_HAS_PACKETS=0)
    return()
  endif()
  target_compile_definitions(${target} PRIVATE PELLUCID_HAS_PACKETS=1)
  foreach(set IN LISTS PELLUCID_INSTRUCTION_SETS)
    set(objects ${target}_${set})
    if(arg_ABSENT AND NOT set IN_LIST _pellucid_built_sets)
      add_library(${objects} OBJECT ${arg_ABSENT})
    elseif(arg_ENTRIES AND NOT set IN_LIST _pellucid_built_sets)
      set(absent "${CMAKE_CURRENT_BINARY_DIR}/absent_${objects}.cpp")
      set(functions "")
      foreach(entry IN LISTS arg_ENTRIES)
        string(APPEND functions "extern \"C\" const void* ${entry}_${set}() { return nullptr; }\n")
      endforeach()
      file(CONFIGURE OUTPUT "${absent}" @ONLY CONTENT "${functions}")
      add_library(${objects} OBJECT "${absent}")
    else()
      add_library(${objects} OBJECT ${sources})
    endif()
    set_target_properties(${objects} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF)
    target_compile_features(${objects} PRIVATE cxx_std_20)
    # The package's target also names a library that it does not need.
    target_include_directories(${objects} SYSTEM PRIVATE
      $<TARGET_PROPERTY:xsimd,INTERFACE_INCLUDE_DIRECTORIES>)
    target_compile_definitions(${objects} PRIVATE
      pellucid=pellucid_${set}
      PELLUCID_INSTRUCTION_SET=${set}
      PELLUCID_LANES=${_pellucid_lanes_${set}})
    set(since_gcc_12
        $<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,12>>)
    set(gcc_12 $<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>)
    target_compile_options(${objects} PRIVATE
      ${_pellucid_flags_${set}}
      "$<${since_gcc_12}:${_pellucid_gcc_12_flags_${set}}>"
      # Optimised in every configuration: batches that are not kept in registers are of no use, and
      # the standard library's small functions must be inlined, not left to the linker.
      $<$<CONFIG:Debug>:-O2>
      # GCC 12 takes the undefined operand of its own intrinsics for a mistake (GCC bug 105593).
      $<${gcc_12}:-Wno-uninitialized> $<${gcc_12}:-Wno-maybe-uninitialized>)
    target_link_libraries(${objects} PRIVATE ${arg_LIBRARIES} pellucid_build_flags)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
    set_property(GLOBAL APPEND PROPERTY PELLUCID_INSTRUCTION_SET_TARGETS ${objects})
  endforeach()
endfunction()
