# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    file_steps.cpp
  VOLUME_FORMATS file_steps_format)
