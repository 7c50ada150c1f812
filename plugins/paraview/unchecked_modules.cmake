# SPDX-License-Identifier: Apache-2.0

# Debian 13's package of ParaView 5.13 calls ParaView's modules of Python what they are not called:
# vtkCommonCore.so in the place of vtkCommonCore.cpython-313-x86_64-linux-gnu.so. find_package()
# ends at the first that is not there, for everybody. The plug-in links none of them. CMake from
# 3.28 on, which Debian 13 has, does not ask for the files of a target that has a framework of
# Apple's in their place, and of that only whether it is a folder.
file(GLOB folders "/usr/lib/*/cmake/paraview-*")
if(IS_DIRECTORY "${ParaView_DIR}")
  list(APPEND folders "${ParaView_DIR}")
endif()
set(begin "^list\\(APPEND _cmake_import_check_targets ")
foreach(folder IN LISTS folders)
  file(GLOB lists "${folder}/*Python*-targets-*.cmake" "${folder}/vtk/*Python*-targets-*.cmake")
  foreach(list IN LISTS lists)
    file(STRINGS "${list}" lines REGEX "${begin}")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "${begin}([^ )]*).*" "\\1" target "${line}")
      set(_cmake_import_check_xcframework_for_${target} "${folder}")
    endforeach()
  endforeach()
endforeach()
