# SPDX-License-Identifier: Apache-2.0

# What is installed beside the program: manual page, bash completion, examples.
if(NOT PELLUCID_BUILD_RENDERER)
  return()
endif()

# The manual page is made from the texts of --help. Building the program alone does not make it.
find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
set(manual "${PROJECT_BINARY_DIR}/share/man/man1/pellucid.1")
if(TARGET Python3::Interpreter)
  add_custom_command(
    OUTPUT "${manual}"
    COMMAND Python3::Interpreter -B "${PROJECT_SOURCE_DIR}/tools/man_page.py"
      $<TARGET_FILE:pellucid_cli> "${manual}"
    DEPENDS pellucid_cli "${PROJECT_SOURCE_DIR}/tools/man_page.py"
    COMMENT "Making the manual page from --help"
    VERBATIM)
  add_custom_target(pellucid_manual ALL DEPENDS "${manual}")
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
