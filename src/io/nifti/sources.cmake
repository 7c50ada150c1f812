# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    nifti.cpp
    nifti_fields.cpp
    nifti_header.cpp
  LATER
    mgh.cpp
    write_nifti.cpp
  LOOPS
    nifti.cpp
    write_nifti.cpp
  FIRST_VOLUME_FORMATS nifti_format
  VOLUME_FORMATS mgh_format
  VOLUME_WRITERS nifti_writer nifti_gzip_writer)
