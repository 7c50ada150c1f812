# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    itk_header.cpp
    meta_image.cpp
    nrrd.cpp
    nrrd_axes.cpp
    nrrd_fields.cpp
    nrrd_space.cpp
    nrrd_steps.cpp
    write_nrrd.cpp
  LOOPS
    write_nrrd.cpp
  VOLUME_FORMATS nrrd_format meta_image_format
  VOLUME_WRITERS nrrd_writer)

if(PELLUCID_WITH_ITK)
  # ITK's package file looks for all that ITK was built with, at length, and asks a C compiler.
  enable_language(C)
  include(CheckCXXSourceCompiles)
  set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
  set(itk_required "")
  if(NOT PELLUCID_WITH_ITK STREQUAL "AUTO")
    set(itk_required REQUIRED)
  endif()
  find_package(ITK 5.2 ${itk_required} QUIET
    COMPONENTS ITKCommon ITKIOImageBase ITKIONIFTI ITKIONRRD ITKIOMeta)
  unset(CMAKE_MESSAGE_LOG_LEVEL)
  set(itk_problem "was not found")
  if(ITK_FOUND)
    # Debian's headers of ITK are for the compiler that built it alone, GCC.
    set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
    set(CMAKE_REQUIRED_INCLUDES ${ITK_INCLUDE_DIRS})
    check_cxx_source_compiles("#include <itkMacro.h>" PELLUCID_ITK_COMPILES)
    unset(CMAKE_REQUIRED_INCLUDES)
    unset(CMAKE_TRY_COMPILE_TARGET_TYPE)
    set(itk_problem "does not compile with ${CMAKE_CXX_COMPILER_ID}")
  endif()
  if(ITK_FOUND AND PELLUCID_ITK_COMPILES)
    message(STATUS "NRRD and MetaImage are read through ITK ${ITK_VERSION}")
    pellucid_module(pellucid_itk SOURCES nrrd/itk_read.cpp LIBRARIES ${ITK_LIBRARIES})
    target_include_directories(pellucid_itk SYSTEM PRIVATE ${ITK_INCLUDE_DIRS})
    # Tests read with ITK what is written here.
    set_target_properties(pellucid_io PROPERTIES
      PELLUCID_ITK_INCLUDE_DIRS "${ITK_INCLUDE_DIRS}" PELLUCID_ITK_LIBRARIES "${ITK_LIBRARIES}")
  elseif(itk_required)
    message(FATAL_ERROR "ITK ${itk_problem}; set PELLUCID_WITH_ITK=OFF to build without")
  else()
    message(STATUS "ITK ${itk_problem}: NRRD and MetaImage are not read")
  endif()
endif()
