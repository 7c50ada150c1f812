// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "page_description.h"

namespace pellucid {

/// Returns whether a text of TIFF is lines of settings that ScanImage wrote.
bool is_scanimage_text(std::string_view text);
/// Reads channels, slices and frames from ScanImage's settings. Throws Error that begins with
/// `name` for several frames of each slice in several volumes.
PageDescription read_scanimage_text(std::string_view text, const std::string& name);

/// Reads LSM's record of a file (tag 34412), in little endian; nothing where it is too short.
std::optional<PageDescription> read_lsm_record(std::span<const std::byte> record, int samples);

/// Reads what Micro-Manager and NDTiff say of each page (tag 51123, JSON), the pages in order.
/// Nothing where a page lacks it. Throws Error that begins with `name` for several positions.
std::optional<PageDescription> read_page_metadata(const std::vector<std::string>& pages,
                                                  const std::string& name);

}  // namespace pellucid
