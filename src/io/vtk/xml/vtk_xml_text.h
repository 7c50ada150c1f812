// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

namespace pellucid {

/// VTK's name of a type: "UInt8" … "Float64".
template <class Value>
std::string vtk_type_name() {
  return (std::is_floating_point_v<Value> ? "Float"
          : std::is_signed_v<Value>       ? "Int"
                                          : "UInt") +
         std::to_string(8 * sizeof(Value));
}

/// Returns a text as an attribute of XML: UTF-8, which allows no control characters even where they
/// are escaped.
std::string xml_attribute(std::string_view text);

/// Returns the element VTKFile of a file with arrays appended as they lie in memory, to its end.
std::string vtk_file_element(std::string_view type);
/// An array that begins at `offset` of what is appended.
std::string vtk_appended_array(const std::string& type, std::string_view name,
                               std::size_t components, std::size_t offset);
inline constexpr std::string_view vtk_append_begin = "<AppendedData encoding=\"raw\">\n_";
inline constexpr std::string_view vtk_append_end = "\n</AppendedData>\n</VTKFile>\n";

}  // namespace pellucid
