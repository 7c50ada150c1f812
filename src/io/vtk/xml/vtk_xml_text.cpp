// SPDX-License-Identifier: Apache-2.0
#include "vtk_xml_text.h"

#include <bit>
#include <nlohmann/json.hpp>

namespace pellucid {

std::string xml_attribute(std::string_view text) {
  using nlohmann::json;
  const std::string utf8 =
      json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace));
  std::string escaped;
  for (const char c : utf8) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? '_' : c;
    }
  }
  return escaped;
}

std::string vtk_file_element(std::string_view type) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + std::string(type) +
         "\" version=\"1.0\" byte_order=\"" +
         (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian") +
         "\" header_type=\"UInt64\">\n";
}

std::string vtk_appended_array(const std::string& type, std::string_view name,
                               std::size_t components, std::size_t offset) {
  return "<DataArray type=\"" + type + "\" Name=\"" + xml_attribute(name) +
         "\" NumberOfComponents=\"" + std::to_string(components) +
         "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
}

}  // namespace pellucid
