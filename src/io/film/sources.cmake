# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  SOURCES
    animation.cpp
    scene_times.cpp
  LATER
    choose_for_steps.cpp
    film.cpp
    film_files.cpp
    video.cpp
  NOT_WEB
    choose_for_steps.cpp
    film_files.cpp
    video.cpp)
