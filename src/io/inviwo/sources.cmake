# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    dat_header.cpp
    inviwo_values.cpp
    ivf_header.cpp
    vvd_header.cpp
  VOLUME_FORMATS dat_format ivf_format vvd_format)
