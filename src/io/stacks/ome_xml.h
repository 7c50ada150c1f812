// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "page_description.h"

namespace pellucid {

/// Returns whether a description of TIFF is OME's XML.
bool is_ome_xml(std::string_view description);

/// One of the images that a document describes.
struct OmeTiffImage {
  std::string name;
  std::int64_t columns = 0, rows = 0;  ///< of a plane; 0: not stated
  std::string type;                    ///< of its values, as OME names it; empty: not stated
  PageDescription pages;
};

struct OmeDocument {
  std::string uuid;           ///< of the file that the document stands in
  std::string metadata_file;  ///< that has the description in this one's place; empty: none
  std::string divided_axis;   ///< element that divides an axis further, "ModuloAlongZ"; empty: none
  std::vector<OmeTiffImage> images;
};

/// Reads OME-XML. `samples` is how many values a pixel of a page has. Throws Error that begins with
/// `name` for XML that is damaged and for sizes and planes that contradict each other.
OmeDocument read_ome_xml(std::string_view text, int samples, const std::string& name);

}  // namespace pellucid
