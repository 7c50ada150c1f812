# SPDX-License-Identifier: Apache-2.0
pellucid_io_sources(
  LATER
    netcdf_format.cpp
    net_cdf_size.cpp
  VOLUME_FORMATS netcdf_format)

include("${CMAKE_CURRENT_SOURCE_DIR}/grid_modules/grid_module.cmake")
set(netcdf_sources
  ${pellucid_axes_sources}
  netcdf/netcdf_read.cpp
  netcdf/netcdf_variables.cpp)
pellucid_grid_module(NETCDF pellucid_netcdf netcdf.h netcdf "" "${netcdf_sources}" NetCDF)
