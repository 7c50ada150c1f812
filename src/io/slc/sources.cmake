# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    slc.cpp
  LOOPS
    slc.cpp
  VOLUME_FORMATS slc_format)
