# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    vtk_xml_arrays.cpp
    vtk_xml_bytes.cpp
    vtk_xml_check.cpp
    vtk_xml_end.cpp
    vtk_xml_numbers.cpp
    vtk_xml_text.cpp
  LOOPS
    vtk_xml_arrays.cpp
    vtk_xml_bytes.cpp
    vtk_xml_numbers.cpp)
