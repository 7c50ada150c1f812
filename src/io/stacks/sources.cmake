# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    acquisition_text.cpp
    image_stack.cpp
    imagej_text.cpp
    name_series.cpp
    ome_xml.cpp
    page_layout.cpp
    page_marks.cpp
    page_placement.cpp
    page_values.cpp
    png_pages.cpp
    shaped_text.cpp
    tiff_chain.cpp
    tiff_description.cpp
    tiff_pages.cpp
  LOOPS
    page_values.cpp
    png_pages.cpp
    tiff_pages.cpp
  VOLUME_FORMATS stack_format)
