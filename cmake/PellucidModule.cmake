# SPDX-License-Identifier: Apache-2.0

# Compiler settings of our own code. Not exported: consumers keep theirs.
set(_pellucid_gcc $<CXX_COMPILER_ID:GNU>)
set(_pellucid_clang $<CXX_COMPILER_ID:Clang>)
set(_pellucid_gxx $<CXX_COMPILER_VERSION>)
add_library(pellucid_build_flags INTERFACE)
target_compile_options(pellucid_build_flags INTERFACE
  # Contraction would make a picture depend on the machine's instruction set and break the exactness
  # arguments of kernels written for separately rounded operations; fma() is called where it is
  # meant.
  -ffp-contract=off
  # Nothing here reads errno or the floating-point exception flags; values do not change.
  -fno-math-errno -fno-trapping-math
  -Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wunused -Wformat=2
  # Where several sources are compiled as one, names of one may hide those of another, and types of
  # anonymous namespaces are not those of the main file.
  $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow>
  $<$<AND:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>
  $<$<CXX_COMPILER_ID:GNU>:-Wduplicated-cond -Wlogical-op -Wuseless-cast>
  # To clang it is also double to long double, which the reference renderer is written in.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-double-promotion>
  # Kernels take masks of lanes and bools alike: | and & throughout.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-bitwise-instead-of-logical>
  # clang 19 takes each std::stable_sort() for a use of a deprecated function, which libstdc++ 12
  # calls in there; clang 14 does not. Uses of ours are found by GCC.
  $<$<AND:${_pellucid_clang},$<VERSION_GREATER:${_pellucid_gxx},15>>:-Wno-deprecated-declarations>
  # GCC 12 sees overlaps and overruns in "text" + std::string that are not there (GCC bug 105651).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-array-bounds>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-stringop-overflow>
  # GCC 13 and later take what a view of a JSON document gives for a part of the view.
  $<$<AND:${_pellucid_gcc},$<VERSION_GREATER_EQUAL:${_pellucid_gxx},13>>:-Wno-dangling-reference>
  $<$<BOOL:${PELLUCID_WERROR}>:-Werror>)

# GCC collects its garbage from 128 MB on. Where there is memory, later: a source then takes a tenth
# less time, and a quarter more memory, 1.4 GB at most.
cmake_host_system_information(RESULT _pellucid_memory QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT _pellucid_processors QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR _pellucid_memory "${_pellucid_memory} / ${_pellucid_processors}")
if(_pellucid_memory GREATER 2500)
  target_compile_options(pellucid_build_flags INTERFACE
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=1000000>)
endif()

# OpenVDB includes a part of Boost 1.74 that casts -1 to an enumeration, which is an error there.
set(pellucid_openvdb_options)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER 16
   AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 20)
  set(pellucid_openvdb_options -Wno-enum-constexpr-conversion)
endif()

if(PELLUCID_WEB)
  # What Emscripten's standard library lacks stands in front of it. Exceptions are WebAssembly's own
  # (-fwasm-exceptions, also where it is linked). Of sizes that are 32 bits wide there is no end.
  target_include_directories(pellucid_build_flags SYSTEM BEFORE INTERFACE
    "${PROJECT_SOURCE_DIR}/cmake/web/include")
  target_compile_options(pellucid_build_flags INTERFACE
    -fwasm-exceptions -Wno-shorten-64-to-32 -Wno-unused-command-line-argument)
  target_link_options(pellucid_build_flags INTERFACE -fwasm-exceptions)
  if(PELLUCID_WEB_THREADS)
    target_compile_options(pellucid_build_flags INTERFACE -pthread)
    target_link_options(pellucid_build_flags INTERFACE -pthread)
  endif()
endif()

option(PELLUCID_PRECOMPILE_HEADERS
       "Precompile what most sources of the libraries include" ${PROJECT_IS_TOP_LEVEL})

# GCC 13 and later refuse headers that were precompiled at another level of optimisation.
set(PELLUCID_HEADERS_PER_LEVEL FALSE)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
  set(PELLUCID_HEADERS_PER_LEVEL TRUE)
endif()

# pellucid_precompiled_headers(TARGET [HEADERS header...] [OF target] [OWN]): sources of TARGET have
# the headers of `scene`, which owns one file of them for all libraries, or of the target OF, which
# is compiled alike, or HEADERS as well, in a file of its own, as with OWN. They must still include
# what they use: the presets of clang and the sanitizers compile without.
function(pellucid_precompiled_headers target)
  cmake_parse_arguments(arg "OWN" "OF" "HEADERS" ${ARGN})
  if(NOT PELLUCID_PRECOMPILE_HEADERS)
    return()
  endif()
  if(arg_OF)
    target_precompile_headers(${target} REUSE_FROM ${arg_OF})
  elseif(arg_HEADERS OR arg_OWN OR NOT TARGET pellucid_scene OR target STREQUAL "pellucid_scene")
    target_precompile_headers(${target} PRIVATE
      <algorithm> <array> <cmath> <cstddef> <cstdint> <filesystem> <functional> <limits> <memory>
      <optional> <span> <string> <string_view> <utility> <variant> <vector>
      <pellucid/scene/volume.h> ${arg_HEADERS})
  else()
    target_precompile_headers(${target} REUSE_FROM pellucid_scene)
  endif()
  # With this ccache can tell what a precompiled header holds.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()

option(PELLUCID_UNITY "Compile several sources as one" ${PROJECT_IS_TOP_LEVEL})

# pellucid_unity(TARGET [BATCH n]): with PELLUCID_UNITY the sources of TARGET that are in the groups
# of pellucid_first_sources() are compiled together, or n at a time in their order. What a source
# declares in an anonymous namespace must have another name than in the others of its group. They
# must still include what they use: the preset of clang compiles each by itself.
function(pellucid_unity target)
  cmake_parse_arguments(arg "" "BATCH" "" ${ARGN})
  if(NOT PELLUCID_UNITY)
    return()
  endif()
  if(arg_BATCH)
    set_target_properties(${target} PROPERTIES
      UNITY_BUILD ON UNITY_BUILD_MODE BATCH UNITY_BUILD_BATCH_SIZE ${arg_BATCH})
  else()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  endif()
endfunction()

# Puts sources in groups of at most `size` of one folder, whose names begin with `part`. A new
# source changes the groups of its folder alone.
function(_pellucid_unity_groups part size)
  foreach(source IN LISTS ARGN)
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${part}_${folder}" name)
    if(NOT DEFINED ${name}_size)
      set(${name}_size 0)
    endif()
    math(EXPR group "${${name}_size} / ${size}")
    math(EXPR ${name}_size "${${name}_size} + 1")
    set_property(SOURCE "${source}" PROPERTY UNITY_GROUP "${name}_${group}")
  endforeach()
endfunction()

# What the functions below declare is kept in global properties, from which the package
# (PellucidInstall) and the test of the include order (tests/architecture) are made:
#   PELLUCID_MODULES            names, in the order of declaration
#   PELLUCID_DEPENDS_<name>     the modules that its files include

# pellucid_header_module(NAME [DEPENDS NAME...]): the folder include/pellucid/NAME as
# pellucid::NAME.
function(pellucid_header_module name)
  cmake_parse_arguments(arg "" "" "DEPENDS" ${ARGN})
  add_library(pellucid_${name} INTERFACE)
  _pellucid_declare(${name} INTERFACE "${arg_DEPENDS}")
endfunction()

# pellucid_first_sources(RESULT TARGET SOURCES file... [LATER file...] [INSTEAD file...]
#                        [NOT_WEB file...] [WEB file...]): the files of a target. LATER: those that
# no first picture needs; with PELLUCID_FIRST_PICTURE the files INSTEAD stand in for them. Both
# builds compile SOURCES alike, in the same groups (pellucid_unity()), so that the whole one takes
# over their objects. NOT_WEB: those of SOURCES and LATER that WebAssembly does without, with the
# files WEB in their place.
# tests/first_picture links what is left without LATER, which is kept in global properties:
#   PELLUCID_FIRST_TARGETS      the targets
#   PELLUCID_LATER_<target>     as seen from the target's folder
#   PELLUCID_INSTEAD            absolute paths
function(pellucid_first_sources result target)
  cmake_parse_arguments(arg "" "" "SOURCES;LATER;INSTEAD;NOT_WEB;WEB" ${ARGN})
  if(PELLUCID_WEB)
    set(all ${arg_SOURCES} ${arg_LATER} ${arg_WEB})
    list(REMOVE_ITEM all ${arg_NOT_WEB} "")
    # Nobody works on one of them there.
    _pellucid_unity_groups(web 16 ${all})
    set(${result} ${all} PARENT_SCOPE)
    return()
  endif()
  _pellucid_unity_groups(first 8 ${arg_SOURCES})
  _pellucid_unity_groups(later 8 ${arg_LATER})
  if(PELLUCID_FIRST_PICTURE)
    set(${result} ${arg_SOURCES} ${arg_INSTEAD} PARENT_SCOPE)
  else()
    set(${result} ${arg_SOURCES} ${arg_LATER} PARENT_SCOPE)
  endif()
  if(arg_LATER OR arg_INSTEAD)
    get_property(targets GLOBAL PROPERTY PELLUCID_FIRST_TARGETS)
    if(NOT target IN_LIST targets)
      set_property(GLOBAL APPEND PROPERTY PELLUCID_FIRST_TARGETS ${target})
    endif()
    set_property(GLOBAL APPEND PROPERTY PELLUCID_LATER_${target} ${arg_LATER})
    list(TRANSFORM arg_INSTEAD PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
    set_property(GLOBAL APPEND PROPERTY PELLUCID_INSTEAD ${arg_INSTEAD})
  endif()
endfunction()

# pellucid_add_sources(TARGET FOLDER [SOURCES file...] [LATER file...] [INSTEAD file...]
#                      [NOT_WEB file...] [WEB file...]): further files of a target of this folder,
# which lie in its sub-folder FOLDER, as of pellucid_first_sources().
function(pellucid_add_sources target folder)
  set(lists SOURCES LATER INSTEAD NOT_WEB WEB)
  cmake_parse_arguments(arg "" "" "${lists}" ${ARGN})
  set(arguments)
  foreach(list IN LISTS lists)
    list(TRANSFORM arg_${list} PREPEND "${folder}/")
    list(APPEND arguments ${list} ${arg_${list}})
  endforeach()
  pellucid_first_sources(sources ${target} ${arguments})
  target_sources(${target} PRIVATE ${sources})
endfunction()

# pellucid_library(NAME [SOURCES file...] [LATER file...] [INSTEAD file...] [NOT_WEB file...]
# [WEB file...] [DEPENDS NAME...] [PRIVATE target...] [LEVEL option]): the folders src/NAME and
# include/pellucid/NAME as the compiled library pellucid::NAME, its files as of
# pellucid_first_sources(). It is static, so whoever links it links its PRIVATE targets too
# (PellucidInstall); those that are headers alone stand in $<BUILD_INTERFACE:...>. LEVEL is what GCC
# and Emscripten optimise it by in a release, where that is not what the others have.
function(pellucid_library name)
  cmake_parse_arguments(arg "" "LEVEL"
    "SOURCES;LATER;INSTEAD;NOT_WEB;WEB;DEPENDS;PRIVATE" ${ARGN})
  pellucid_first_sources(sources pellucid_${name}
    SOURCES ${arg_SOURCES} LATER ${arg_LATER} INSTEAD ${arg_INSTEAD}
    NOT_WEB ${arg_NOT_WEB} WEB ${arg_WEB})
  add_library(pellucid_${name} STATIC ${sources})
  set_target_properties(pellucid_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF)
  _pellucid_declare(${name} PUBLIC "${arg_DEPENDS}")
  target_link_libraries(pellucid_${name}
    PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:pellucid_build_flags>)
  if(arg_LEVEL AND PELLUCID_HEADERS_PER_LEVEL)
    pellucid_precompiled_headers(pellucid_${name} OWN)
  else()
    pellucid_precompiled_headers(pellucid_${name})
  endif()
  if(arg_LEVEL)
    set(takes_level $<OR:$<CXX_COMPILER_ID:GNU>,$<BOOL:${PELLUCID_WEB}>>)
    target_compile_options(pellucid_${name}
      PRIVATE $<$<AND:$<CONFIG:Release>,${takes_level}>:${arg_LEVEL}>)
  endif()
endfunction()

function(_pellucid_declare name scope depends)
  add_library(pellucid::${name} ALIAS pellucid_${name})
  set_target_properties(pellucid_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(pellucid_${name} ${scope} cxx_std_20)
  target_include_directories(pellucid_${name} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set_property(GLOBAL APPEND PROPERTY PELLUCID_MODULES ${name})
  set_property(GLOBAL PROPERTY PELLUCID_DEPENDS_${name} "${depends}")
  list(TRANSFORM depends PREPEND pellucid::)
  target_link_libraries(pellucid_${name} ${scope} ${depends})
endfunction()
