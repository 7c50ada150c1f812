# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    ome_zarr.cpp
    zarr.cpp
    zarr_axes.cpp
    zarr_chunks.cpp
    zarr_codecs.cpp
    zarr_image.cpp
    zarr_metadata.cpp
    zarr_node.cpp
    zarr_store.cpp
    zarr_values.cpp
    zarr_variable.cpp
  LOOPS
    zarr_chunks.cpp
    zarr_codecs.cpp
    zarr_values.cpp
  VOLUME_FORMATS zarr_format)

# What chunks of Zarr are compressed with. Without one of them such chunks are refused.
function(pellucid_chunk_codec option header library package)
  find_path(PELLUCID_${option}_INCLUDE_DIR ${header})
  find_library(PELLUCID_${option}_LIBRARY NAMES ${library})
  mark_as_advanced(PELLUCID_${option}_INCLUDE_DIR PELLUCID_${option}_LIBRARY)
  if(PELLUCID_${option}_INCLUDE_DIR AND PELLUCID_${option}_LIBRARY)
    set_property(SOURCE zarr/zarr_codecs.cpp
      APPEND PROPERTY COMPILE_DEFINITIONS PELLUCID_HAVE_${option})
    target_include_directories(pellucid_io SYSTEM PRIVATE "${PELLUCID_${option}_INCLUDE_DIR}")
    target_link_libraries(pellucid_io PRIVATE "${PELLUCID_${option}_LIBRARY}")
    set_property(TARGET pellucid_io PROPERTY PELLUCID_${option} ON)
  else()
    message(STATUS "${package} was not found: Zarr compressed with it is not read")
  endif()
endfunction()
pellucid_chunk_codec(BLOSC blosc.h blosc libblosc-dev)
pellucid_chunk_codec(ZSTD zstd.h zstd libzstd-dev)
pellucid_chunk_codec(LZ4 lz4.h lz4 liblz4-dev)
