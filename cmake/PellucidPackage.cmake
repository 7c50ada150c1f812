# SPDX-License-Identifier: Apache-2.0

# What is installed beside the program (manual page, bash completion, examples), and the Debian
# package that cpack makes of a build. scripts/package builds and packs.
if(NOT PELLUCID_BUILD_RENDERER)
  return()
endif()

# The manual page is made from the texts of --help. Building the program alone does not make it.
find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
set(manual "${PROJECT_BINARY_DIR}/share/man/man1/pellucid.1")
if(TARGET Python3::Interpreter AND NOT CMAKE_CROSSCOMPILING)
  # A program with sanitizers need not run while it is built.
  set(all "")
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    set(all ALL)
  endif()
  add_custom_command(
    OUTPUT "${manual}"
    COMMAND Python3::Interpreter -B "${PROJECT_SOURCE_DIR}/tools/man_page.py"
      $<TARGET_FILE:pellucid_cli> "${manual}"
    DEPENDS pellucid_cli "${PROJECT_SOURCE_DIR}/tools/man_page.py"
    COMMENT "Making the manual page from --help"
    VERBATIM)
  add_custom_target(pellucid_manual ${all} DEPENDS "${manual}")
endif()
install(FILES "${manual}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" OPTIONAL)
install(FILES share/bash-completion/completions/pellucid
  DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")

# The examples whose data are built in or come with Debian: they run as they are.
set(examples examples/README.md)
file(GLOB scenes CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}"
  "${PROJECT_SOURCE_DIR}/examples/*.json")
foreach(scene IN LISTS scenes)
  file(STRINGS "${scene}" shared_data REGEX "\"\\.\\./")
  if(NOT shared_data)
    list(APPEND examples "${scene}")
  endif()
endforeach()
install(FILES ${examples} DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/pellucid/examples")

if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pellucid)
set(CPACK_PACKAGE_CONTACT "The Pellucid authors <pellucid@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "volume renderer with a stated error per pixel")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Pellucid renders volumes (medical images, simulations, microscopy) and meshes
by evaluating the volume rendering integral cell by cell, instead of sampling
it along the ray. Every pixel is within a tolerance that you choose.
.
The package holds the program, its static libraries, headers and a CMake
package. Formats that need VTK, ITK, HDF5, NetCDF or OpenVDB are read by
modules, whose libraries are recommended: without them those files alone are
not read.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Runs when the files are in place, before they are packed.
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/PellucidPackageContents.cmake")
set(CPACK_PELLUCID_SOURCE_DIR "${PROJECT_SOURCE_DIR}")
set(CPACK_PELLUCID_LIBDIR "${CMAKE_INSTALL_LIBDIR}")
include(CPack)
