# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    grid_answer.cpp
    grid_files.cpp
  LOOPS
    grid_files.cpp)
