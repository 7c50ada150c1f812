# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    child_process.cpp
    module.cpp
  NOT_WEB
    child_process.cpp
    module.cpp
  WEB
    no_module.cpp)

file(RELATIVE_PATH modules_from_program
  "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}/pellucid")
# Programs of others that link the library lie elsewhere: they look where `cmake --install` puts the
# modules, and where the Debian package does (cmake/PellucidPackage.cmake).
# A wheel looks in its own folder alone: what else is installed may be of another version.
if(NOT PELLUCID_PYTHON_FOLDER STREQUAL ".")
  set_property(SOURCE process/module.cpp APPEND PROPERTY COMPILE_DEFINITIONS
    PELLUCID_MODULES_FROM_PROGRAM="${modules_from_program}"
    PELLUCID_MODULES_PACKAGED="/usr/${CMAKE_INSTALL_LIBDIR}/pellucid"
    PELLUCID_MODULES_INSTALLED="${CMAKE_INSTALL_FULL_LIBDIR}/pellucid")
endif()
