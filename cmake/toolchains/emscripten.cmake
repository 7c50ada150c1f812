# SPDX-License-Identifier: Apache-2.0
#
# Builds for WebAssembly with Debian's Emscripten, for pages (scripts/build-web).
find_program(PELLUCID_EMXX em++)
if(NOT PELLUCID_EMXX)
  message(FATAL_ERROR "em++ was not found: install Emscripten (Debian: emscripten)")
endif()
file(REAL_PATH "${PELLUCID_EMXX}" _pellucid_emxx)
cmake_path(GET _pellucid_emxx PARENT_PATH _pellucid_emscripten)
include("${_pellucid_emscripten}/cmake/Modules/Platform/Emscripten.cmake")
