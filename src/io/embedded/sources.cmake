# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    coarser_scene.cpp
    coarser_volume.cpp
    embed_scene.cpp
    page_of.cpp)
