# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    cropping.cpp
    dependent_components.cpp
    fit_tables.cpp
    functions.cpp
    ghost_cells.cpp
    grid_layers.cpp
    hidden_places.cpp
    look.cpp
    mesh_layers.cpp
    nearest_values.cpp
    placement.cpp
    view.cpp)
