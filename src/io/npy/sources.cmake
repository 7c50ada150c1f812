# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    npy.cpp
  LATER
    npz.cpp
  LOOPS
    npy.cpp
  FIRST_VOLUME_FORMATS npy_format
  VOLUME_FORMATS npz_format)
