# SPDX-License-Identifier: Apache-2.0

# cpack runs this when the files of the package are in place: adds what Debian asks for, and finds
# out which packages the program (Depends) and its modules (Recommends) need.
set(usr "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr")
set(doc "${usr}/share/doc/pellucid")
set(work "${CPACK_TOPLEVEL_DIRECTORY}/contents")

foreach(file IN ITEMS bin/pellucid share/man/man1/pellucid.1)
  if(NOT EXISTS "${usr}/${file}")
    message(FATAL_ERROR "The package would lack ${file}: build the targets pellucid_cli, "
                        "pellucid_modules and pellucid_manual first, or run scripts/package")
  endif()
endforeach()

# The same commit gives the same package: its files have the time of the commit.
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  execute_process(
    COMMAND git -C "${CPACK_PELLUCID_SOURCE_DIR}" log -1 --format=%ct
    OUTPUT_VARIABLE commit_time OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT commit_time MATCHES "^[0-9]+$")
    file(TIMESTAMP "${CPACK_PELLUCID_SOURCE_DIR}/CHANGELOG.md" commit_time "%s" UTC)
  endif()
  set(ENV{SOURCE_DATE_EPOCH} "${commit_time}")
endif()

# /usr/share/doc/pellucid and the compressed manual page.
function(compress file)
  execute_process(COMMAND gzip -9nf "${file}" COMMAND_ERROR_IS_FATAL ANY)
endfunction()

string(TIMESTAMP year "%Y" UTC)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(REMOVE "${doc}/LICENSE")
file(WRITE "${doc}/copyright"
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: pellucid

Files: *
Copyright: ${year} The Pellucid authors
License: Apache-2.0
 On Debian systems the full text of the Apache License, version 2.0, is in
 /usr/share/common-licenses/Apache-2.0.
")
file(WRITE "${doc}/changelog"
"pellucid (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * Version ${CPACK_PACKAGE_VERSION}: see /usr/share/doc/pellucid/NEWS.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
configure_file("${CPACK_PELLUCID_SOURCE_DIR}/CHANGELOG.md" "${doc}/NEWS" COPYONLY)
file(CHMOD "${doc}/copyright" "${doc}/changelog" "${doc}/NEWS"
  PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
compress("${doc}/changelog")
compress("${doc}/NEWS")
compress("${usr}/share/man/man1/pellucid.1")

# Whatever the umask is.
file(CHMOD_RECURSE "${usr}" DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# What the program needs stands in Depends; what its modules need beside, in Recommends.
file(GLOB modules "${usr}/${CPACK_PELLUCID_LIBDIR}/pellucid/*.so"
  "${usr}/lib/python3/dist-packages/pellucid/*.so")
list(TRANSFORM modules PREPEND -e OUTPUT_VARIABLE module_arguments)
file(WRITE "${work}/debian/control" "Source: pellucid\n\nPackage: pellucid\nArchitecture: any\n")
execute_process(
  COMMAND dpkg-shlibdeps -O -dDepends "-e${usr}/bin/pellucid" -dRecommends ${module_arguments}
  WORKING_DIRECTORY "${work}"
  OUTPUT_VARIABLE needed
  ERROR_VARIABLE errors
  RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "dpkg-shlibdeps (package dpkg-dev) failed:\n${errors}")
endif()
foreach(field IN ITEMS Depends Recommends)
  set(packages "")
  if(needed MATCHES "shlibs:${field}=([^\n]*)")
    set(packages "${CMAKE_MATCH_1}")
  endif()
  string(TOUPPER "${field}" upper)
  set(CPACK_DEBIAN_PACKAGE_${upper} "${packages}")
endforeach()
if(EXISTS "${usr}/lib/python3/dist-packages/pellucid")
  string(APPEND CPACK_DEBIAN_PACKAGE_RECOMMENDS ", python3-numpy")
endif()

# What a program needs that links the static libraries, from the one list of packages.
file(READ "${CPACK_PELLUCID_SOURCE_DIR}/scripts/install-packages" lists)
if(NOT lists MATCHES "\nlink=\\(([^)]*)\\)")
  message(FATAL_ERROR "scripts/install-packages has no list `link`")
endif()
string(REGEX REPLACE "[ \n]+" ", " suggested "${CMAKE_MATCH_1}")
# ... and the data of two examples.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "${suggested}, mricron-data")
