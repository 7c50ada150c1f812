// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "image_pages.h"
#include "page_layout.h"
#include "volumes/components.h"

namespace pellucid {

/// A volume of pages: where its planes are, and how their values are to be read.
struct PageVolume {
  std::vector<FilePages> files;
  PageLayout layout;
  PageFormat format;               ///< of every page
  std::int64_t shared_planes = 0;  ///< that lie behind the first page of the one file; 0: none do
  std::optional<ValueCalibration> calibration;
};

/// Opens a file of pages, which stands at its first plane then. Throws Error.
std::unique_ptr<PageReader> open_planes(const PageVolume& volume, std::size_t file);

/// Reads components, of which each sample of a page is one. Throws Error, also where the files have
/// changed.
std::vector<VolumeData> read_page_values(const PageVolume& volume, ComponentRange range,
                                         const std::string& name);

}  // namespace pellucid
