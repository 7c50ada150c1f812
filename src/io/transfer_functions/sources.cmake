# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    export_transfer_function.cpp
    foreign_color_path.cpp
    foreign_complete.cpp
    foreign_fit.cpp
    foreign_gaussians.cpp
    foreign_light.cpp
    foreign_paraview.cpp
    foreign_paths.cpp
    foreign_shaped.cpp
    foreign_slicer.cpp
    foreign_table.cpp
    foreign_text.cpp
    foreign_ways.cpp
    foreign_xml.cpp
    import_transfer_function.cpp)
