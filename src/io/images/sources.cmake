# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    display_bytes.cpp
    image_checks.cpp
    png_file.cpp
    values_npy.cpp
  LATER
    box_axes.cpp
    color_bar.cpp
    exr_file.cpp
    figure.cpp
    picture_text.cpp
  LOOPS
    display_bytes.cpp
    exr_file.cpp
    png_file.cpp
  NOT_WEB
    box_axes.cpp
    exr_file.cpp
    figure.cpp
    picture_text.cpp
    png_file.cpp
  WEB
    no_exr_file.cpp
    png_by_zlib.cpp)

# Text over pictures.
if(PELLUCID_WITH_CAIRO)
  find_path(PELLUCID_CAIRO_INCLUDE_DIR cairo.h PATH_SUFFIXES cairo)
  find_library(PELLUCID_CAIRO_LIBRARY cairo)
  mark_as_advanced(PELLUCID_CAIRO_INCLUDE_DIR PELLUCID_CAIRO_LIBRARY)
  if(PELLUCID_CAIRO_INCLUDE_DIR AND PELLUCID_CAIRO_LIBRARY)
    message(STATUS "Color bars and figures are drawn by Cairo")
    pellucid_module(pellucid_cairo
      SOURCES images/cairo_draw.cpp images/cairo_figure.cpp images/figure_composer.cpp
      LIBRARIES "${PELLUCID_CAIRO_LIBRARY}")
    # Legends and figures have lengths of the same names.
    set_target_properties(pellucid_cairo PROPERTIES UNITY_BUILD OFF)
    target_include_directories(pellucid_cairo SYSTEM PRIVATE "${PELLUCID_CAIRO_INCLUDE_DIR}")
  elseif(NOT PELLUCID_WITH_CAIRO STREQUAL "AUTO")
    message(FATAL_ERROR "Cairo was not found; set PELLUCID_WITH_CAIRO=OFF to build without")
  else()
    message(STATUS "Cairo was not found: no color bars and figures (Debian: libcairo2-dev)")
  endif()
endif()
