# SPDX-License-Identifier: Apache-2.0
#
# Answers find_package() in builds for WebAssembly. Libraries of headers are those of this machine,
# in a folder of their own: beside them lie headers of its C library, which are not Emscripten's.
# zlib is pako's, which is written in JavaScript (cmake/web/include/zlib.h). What a page does
# without has a target that holds nothing, so that its users need not ask.
set(PELLUCID_WEB ON)

set(_pellucid_web_headers "${CMAKE_BINARY_DIR}/web_headers")
set(_pellucid_web_folder "${CMAKE_CURRENT_LIST_DIR}")

# _pellucid_web_library(TARGET PROBE FOLDER): headers FOLDER of this machine, known by PROBE.
function(_pellucid_web_library target probe folder)
  find_path(_pellucid_found_${folder} ${probe} NO_CMAKE_FIND_ROOT_PATH PATHS /usr/include
            NO_DEFAULT_PATH)
  mark_as_advanced(_pellucid_found_${folder})
  if(NOT _pellucid_found_${folder})
    message(FATAL_ERROR "${probe} was not found; scripts/install-packages build installs it")
  endif()
  file(MAKE_DIRECTORY "${_pellucid_web_headers}")
  file(CREATE_LINK "${_pellucid_found_${folder}}/${folder}" "${_pellucid_web_headers}/${folder}"
       SYMBOLIC)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE "${_pellucid_web_headers}")
endfunction()

macro(pellucid_web_package method name)
  if("${name}" STREQUAL "fmt" AND NOT TARGET fmt::fmt)
    _pellucid_web_library(fmt::fmt fmt/format.h fmt)
    target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
  elseif("${name}" STREQUAL "nlohmann_json" AND NOT TARGET nlohmann_json::nlohmann_json)
    _pellucid_web_library(nlohmann_json::nlohmann_json nlohmann/json.hpp nlohmann)
  elseif("${name}" STREQUAL "xsimd" AND NOT TARGET xsimd)
    _pellucid_web_library(xsimd xsimd/xsimd.hpp xsimd)
    set(xsimd_VERSION 8.1)
  endif()
  set(_pellucid_nothing
    PNG PNG::PNG OpenEXR OpenEXR::OpenEXR TIFF TIFF::TIFF ZLIB ZLIB::ZLIB TBB TBB::tbb
    Boost Boost::headers Threads Threads::Threads CLI11 CLI11::CLI11)
  list(FIND _pellucid_nothing "${name}" _pellucid_at)
  if(_pellucid_at GREATER_EQUAL 0)
    math(EXPR _pellucid_at "${_pellucid_at} + 1")
    list(GET _pellucid_nothing ${_pellucid_at} _pellucid_target)
    if(NOT TARGET ${_pellucid_target})
      add_library(${_pellucid_target} INTERFACE IMPORTED GLOBAL)
    endif()
    set(${name}_FOUND TRUE)
  elseif("${name}" MATCHES "^(fmt|nlohmann_json|xsimd)$")
    set(${name}_FOUND TRUE)
  elseif("${name}" STREQUAL "Python3")
    find_package(${name} ${ARGN} BYPASS_PROVIDER)
  else()
    set(${name}_FOUND FALSE)
  endif()
endmacro()

cmake_language(SET_DEPENDENCY_PROVIDER pellucid_web_package SUPPORTED_METHODS FIND_PACKAGE)
