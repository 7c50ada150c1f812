# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    color_volume.cpp
    components.cpp
    read_volume.cpp
    stored_numbers.cpp
    volume_format.cpp
    volume_source.cpp
  LATER
    unread_formats.cpp
    volume_axes.cpp
    write_volume.cpp
  LOOPS
    components.cpp
    stored_numbers.cpp
    volume_axes.cpp
    volume_source.cpp)
