# SPDX-License-Identifier: Apache-2.0

# cmake --install: the headers and libraries of what was built, and the package `pellucid`, whose
# components are the modules. The program installs itself (apps/cli).
include(CMakePackageConfigHelpers)

# The find_dependency() arguments for what a static library links: the package is the namespace of a
# target (TBB::tbb: TBB).
function(_pellucid_packages target result)
  set(packages)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    get_target_property(libraries ${target} LINK_LIBRARIES)
    foreach(library IN LISTS libraries)
      if(library MATCHES "^(pellucid::|\\$<BUILD_INTERFACE:)")
        continue()
      elseif(library MATCHES "^CUDA::")
        list(APPEND packages CUDAToolkit)
      elseif(library MATCHES "^([A-Za-z0-9_]+)::")
        list(APPEND packages "${CMAKE_MATCH_1}")
      endif()
    endforeach()
  endif()
  list(REMOVE_DUPLICATES packages)
  set(${result} "${packages}" PARENT_SCOPE)
endfunction()

get_property(modules GLOBAL PROPERTY PELLUCID_MODULES)
list(TRANSFORM modules PREPEND pellucid_ OUTPUT_VARIABLE targets)
install(TARGETS ${targets} EXPORT pellucidTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})

set(component_table "")
foreach(module IN LISTS modules)
  install(DIRECTORY include/pellucid/${module}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pellucid FILES_MATCHING PATTERN "*.h"
    PATTERN internal EXCLUDE)
  get_property(depends GLOBAL PROPERTY PELLUCID_DEPENDS_${module})
  _pellucid_packages(pellucid_${module} packages)
  string(APPEND component_table
    "set(_pellucid_depends_${module} \"${depends}\")\n"
    "set(_pellucid_packages_${module} \"${packages}\")\n")
endforeach()

if("cpu" IN_LIST modules AND "io" IN_LIST modules)
  install(FILES include/pellucid/pellucid.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pellucid)
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pellucid)
install(EXPORT pellucidTargets NAMESPACE pellucid:: DESTINATION ${package_dir})
configure_package_config_file(cmake/pellucidConfig.cmake.in pellucidConfig.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(pellucidConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  "${CMAKE_CURRENT_BINARY_DIR}/pellucidConfig.cmake"
  "${CMAKE_CURRENT_BINARY_DIR}/pellucidConfigVersion.cmake"
  DESTINATION ${package_dir})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/pellucid)
