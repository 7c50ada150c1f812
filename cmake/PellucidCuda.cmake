# SPDX-License-Identifier: Apache-2.0

# Finds the compiler for cards of NVIDIA, nvcc 12 or later, where PELLUCID_CUDA asks for it: in
# PATH, in CUDA_PATH or where it is usually installed. Sets PELLUCID_CUDA_FOUND. No driver and no
# card is needed to build.
set(PELLUCID_CUDA_FOUND OFF)
if(NOT PELLUCID_CUDA)
  return()
endif()

find_program(PELLUCID_NVCC nvcc HINTS "$ENV{CUDA_PATH}/bin" PATHS /usr/local/cuda/bin)
set(trouble)
if(NOT PELLUCID_NVCC)
  set(trouble "nvcc was not found: put it into PATH, or set CUDA_PATH")
else()
  execute_process(COMMAND "${PELLUCID_NVCC}" --version OUTPUT_VARIABLE nvcc_version)
  string(REGEX MATCH "release ([0-9]+)" nvcc_version "${nvcc_version}")
  if(NOT CMAKE_MATCH_1 OR CMAKE_MATCH_1 LESS 12)
    set(trouble "${PELLUCID_NVCC} is older than CUDA 12")
  endif()
endif()
if(trouble AND PELLUCID_CUDA STREQUAL "AUTO")
  message(STATUS "Without CUDA: ${trouble}")
elseif(trouble)
  message(FATAL_ERROR "PELLUCID_CUDA=${PELLUCID_CUDA}: ${trouble}")
else()
  # Cards from compute capability 9.0 (H100) on; others compile for theirs: 80, 86, 89, native …
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES 90 CACHE STRING "Compute capabilities of the cards")
  endif()
  if(NOT DEFINED CMAKE_CUDA_COMPILER)
    set(CMAKE_CUDA_COMPILER "${PELLUCID_NVCC}")
  endif()
  if(NOT DEFINED CMAKE_CUDA_HOST_COMPILER AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set(CMAKE_CUDA_HOST_COMPILER "${CMAKE_CXX_COMPILER}")
  endif()
  enable_language(CUDA)
  # The runtime is linked into the program and loads the driver when it is first asked for a card.
  find_package(CUDAToolkit REQUIRED)
  set(PELLUCID_CUDA_FOUND ON)
endif()
