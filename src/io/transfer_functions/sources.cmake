# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    export_transfer_function.cpp
    import_color_path.cpp
    import_complete.cpp
    import_fit.cpp
    import_gaussians.cpp
    import_light.cpp
    import_paraview.cpp
    import_paths.cpp
    import_shaped.cpp
    import_slicer.cpp
    import_table.cpp
    import_text.cpp
    import_ways.cpp
    import_xml.cpp
    import_transfer_function.cpp)
