# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    atomic_file.cpp
    bzip2_inflater.cpp
    data_stream.cpp
    gzip_source.cpp
    input_file.cpp
    mapped_file.cpp
    memory_check.cpp
    memory_limit.cpp
    zlib_inflater.cpp
  LATER
    deflater.cpp
    numbered_files.cpp
    temporary_folder.cpp
    zip_archive.cpp
    zip_files.cpp
    zip_writer.cpp
  LOOPS
    bzip2_inflater.cpp
    deflater.cpp
    gzip_source.cpp
    zlib_inflater.cpp
  NOT_WEB
    memory_limit.cpp
  WEB
    heap_limit.cpp)

find_package(BZip2)
if(BZip2_FOUND)
  set_property(SOURCE files/bzip2_inflater.cpp
    APPEND PROPERTY COMPILE_DEFINITIONS PELLUCID_HAVE_BZIP2)
  target_link_libraries(pellucid_io PRIVATE BZip2::BZip2)
  set_property(TARGET pellucid_io PROPERTY PELLUCID_BZIP2 ON)
else()
  message(STATUS "bzip2 was not found: NRRD compressed with it is not read")
endif()
