# SPDX-License-Identifier: Apache-2.0

# The classes in Python, wrapped as VTK wraps its own: the module pellucid.vtkPellucid, for the
# Python that the package is built for. Its use is in python/pellucid/vtk.py.
set(wrapped vtkPellucidFactory vtkPellucidUnstructuredGridMapper vtkPellucidVolumeMapper)
set(python_problem)
if(NOT TARGET pellucid_python)
  set(python_problem "the Python module is not built")
else()
  set(Python_EXECUTABLE "${PELLUCID_PYTHON_EXECUTABLE}")
  find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module)
  set(vtk_version "${VTK_MAJOR_VERSION}.${VTK_MINOR_VERSION}")
  foreach(tool WrapHierarchy WrapPython WrapPythonInit)
    find_program(PELLUCID_VTK_${tool} NAMES vtk${tool}-${vtk_version} vtk${tool})
    mark_as_advanced(PELLUCID_VTK_${tool})
    if(NOT PELLUCID_VTK_${tool})
      set(python_problem "vtk${tool} was not found (Debian: vtk9)")
    endif()
  endforeach()
  find_library(PELLUCID_VTK_PYTHON_CORE
    NAMES vtkWrappingPythonCore${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}-${vtk_version})
  get_target_property(location VTK::CommonCore LOCATION)
  cmake_path(GET location PARENT_PATH location)
  find_path(PELLUCID_VTK_HIERARCHY vtkCommonCore-hierarchy.txt
    PATHS "${location}/vtk-${vtk_version}/hierarchy/VTK" "${location}/vtk/hierarchy/VTK"
    NO_DEFAULT_PATH)
  mark_as_advanced(PELLUCID_VTK_PYTHON_CORE PELLUCID_VTK_HIERARCHY)
  if(NOT PELLUCID_VTK_PYTHON_CORE OR NOT PELLUCID_VTK_HIERARCHY)
    set(python_problem "VTK for Python ${Python_VERSION} was not found (Debian: python3-vtk9)")
  endif()
endif()
if(python_problem)
  message(STATUS "The plug-in for VTK has no classes in Python: ${python_problem}")
  return()
endif()

set(hierarchies)
foreach(module CommonCore CommonDataModel CommonExecutionModel RenderingCore RenderingVolume)
  list(APPEND hierarchies "${PELLUCID_VTK_HIERARCHY}/vtk${module}-hierarchy.txt")
endforeach()
set(folder "${CMAKE_CURRENT_BINARY_DIR}/python")
get_target_property(include_folders VTK::CommonCore INTERFACE_INCLUDE_DIRECTORIES)
set(headers ${wrapped})
list(TRANSFORM headers REPLACE "(.+)" "${CMAKE_CURRENT_SOURCE_DIR}/\\1.h")
set(flags)
foreach(include IN LISTS include_folders ITEMS "${CMAKE_CURRENT_SOURCE_DIR}")
  string(APPEND flags "-I'${include}'\n")
endforeach()
set(data)
foreach(header IN LISTS headers)
  string(APPEND data "${header};vtkPellucid\n")
endforeach()
file(CONFIGURE OUTPUT "${folder}/flags" CONTENT "${flags}" @ONLY)
file(CONFIGURE OUTPUT "${folder}/headers" CONTENT "${data}" @ONLY)
set(hierarchy "${folder}/vtkPellucid-hierarchy.txt")
set(types "${flags}")
foreach(file IN LISTS hierarchies ITEMS "${hierarchy}")
  string(APPEND types "--types '${file}'\n")
endforeach()
file(CONFIGURE OUTPUT "${folder}/types" CONTENT "${types}" @ONLY)
string(REPLACE ";" "\n" classes "${wrapped}")
set(depends "vtkmodules.vtkCommonCore\nvtkmodules.vtkRenderingVolume")
file(CONFIGURE OUTPUT "${folder}/module"
  CONTENT "vtkPellucid\n${classes}\nDEPENDS\n${depends}\n" @ONLY)

add_custom_command(OUTPUT "${hierarchy}"
  COMMAND "${PELLUCID_VTK_WrapHierarchy}" "@${folder}/flags" -o "${hierarchy}"
    "${folder}/headers" ${hierarchies}
  DEPENDS ${headers} "${folder}/flags" "${folder}/headers" VERBATIM)
set(sources)
foreach(class IN LISTS wrapped)
  add_custom_command(OUTPUT "${folder}/${class}Python.cpp"
    COMMAND "${PELLUCID_VTK_WrapPython}" "@${folder}/types" -o "${folder}/${class}Python.cpp"
      "${CMAKE_CURRENT_SOURCE_DIR}/${class}.h"
    DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${class}.h" "${folder}/types" "${hierarchy}" VERBATIM)
  list(APPEND sources "${folder}/${class}Python.cpp")
endforeach()
add_custom_command(OUTPUT "${folder}/init.cpp" "${folder}/init_parts.cpp"
  COMMAND "${PELLUCID_VTK_WrapPythonInit}" "${folder}/module" "${folder}/init.cpp"
    "${folder}/init_parts.cpp"
  DEPENDS "${folder}/module" VERBATIM)
add_library(pellucid_vtk_python MODULE
  ${sources} "${folder}/init.cpp" "${folder}/init_parts.cpp")
set_target_properties(pellucid_vtk_python PROPERTIES
  PREFIX "" OUTPUT_NAME vtkPellucid CXX_EXTENSIONS OFF
  LIBRARY_OUTPUT_DIRECTORY "${PELLUCID_PYTHON_PATH}/pellucid"
  INSTALL_RPATH "$ORIGIN/../../../pellucid/vtk;${CMAKE_INSTALL_FULL_LIBDIR}/pellucid/vtk")
target_include_directories(pellucid_vtk_python SYSTEM PRIVATE ${Python_INCLUDE_DIRS})
# Generated: not to our warnings.
target_compile_options(pellucid_vtk_python PRIVATE -w $<$<CONFIG:Release>:-O1>)
target_link_libraries(pellucid_vtk_python PRIVATE
  pellucid_vtk_plugin "${PELLUCID_VTK_PYTHON_CORE}")
