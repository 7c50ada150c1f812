# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    array_axes.cpp
    time_steps.cpp
  LATER
    axis_meaning.cpp
    axis_role.cpp
    grid_axes.cpp
    length_units.cpp
    position_names.cpp
    positions_beside.cpp
    value_meaning.cpp
    variable_notes.cpp
  LOOPS
    array_axes.cpp
    value_meaning.cpp)
