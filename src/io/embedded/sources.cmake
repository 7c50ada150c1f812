# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    embed_scene.cpp
    page_of.cpp)
