# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    raw.cpp
  LATER
    write_raw.cpp
  LOOPS
    write_raw.cpp
  FIRST_VOLUME_FORMATS raw_format raw_gzip_format
  VOLUME_WRITERS raw_writer)
