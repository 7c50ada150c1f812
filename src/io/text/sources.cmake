# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    json_document.cpp
    printable.cpp
  LATER
    header_keys.cpp
    json_file.cpp
    xml_scanner.cpp)
