# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    dicom.cpp
    dicom_data_set.cpp
    dicom_decode.cpp
    dicom_elements.cpp
    dicom_folder.cpp
    dicom_frames.cpp
    dicom_grid.cpp
    dicom_marks.cpp
    dicom_slices.cpp
    dicom_times.cpp
    dicom_values.cpp
    dicom_volumes.cpp
  LOOPS
    dicom_decode.cpp
    dicom_values.cpp
  VOLUME_FORMATS dicom_format)

# GDCM decompresses DICOM's pixels. Its package wants its tools too, which need not be installed.
find_path(PELLUCID_GDCM_INCLUDE gdcmImageReader.h PATH_SUFFIXES gdcm-3.0)
find_library(PELLUCID_GDCM_MSFF gdcmMSFF)
find_library(PELLUCID_GDCM_DSED gdcmDSED)
find_library(PELLUCID_GDCM_COMMON gdcmCommon)
mark_as_advanced(PELLUCID_GDCM_INCLUDE PELLUCID_GDCM_MSFF PELLUCID_GDCM_DSED PELLUCID_GDCM_COMMON)
if(PELLUCID_GDCM_INCLUDE AND PELLUCID_GDCM_MSFF AND PELLUCID_GDCM_DSED AND PELLUCID_GDCM_COMMON)
  set_property(SOURCE dicom/dicom_decode.cpp APPEND PROPERTY COMPILE_DEFINITIONS PELLUCID_HAVE_GDCM)
  set_property(SOURCE dicom/dicom_decode.cpp APPEND PROPERTY COMPILE_OPTIONS
    -isystem ${PELLUCID_GDCM_INCLUDE})
  target_link_libraries(pellucid_io
    PRIVATE ${PELLUCID_GDCM_MSFF} ${PELLUCID_GDCM_DSED} ${PELLUCID_GDCM_COMMON})
  set_property(TARGET pellucid_io PROPERTY PELLUCID_GDCM ON)
  message(STATUS "Compressed DICOM is read through GDCM")
else()
  message(STATUS "GDCM was not found: compressed DICOM is not read")
endif()
