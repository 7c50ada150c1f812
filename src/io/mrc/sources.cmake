# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    mrc.cpp
  LOOPS
    mrc.cpp
  VOLUME_FORMATS mrc_format)
