// SPDX-License-Identifier: Apache-2.0

// What VTK's XML files hold, read without VTK: any bytes give counts of arrays, or an Error of one
// line; and so does the check of an image's pieces.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "pellucid/scene/error.h"
#include "src/io/vtk/xml/vtk_xml_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const pellucid::VtkXmlFile file = pellucid::parse_vtk_xml(text);
    for (const pellucid::VtkXmlPiece& piece : file.pieces) {
      for (const pellucid::VtkXmlArray& array : piece.arrays) {
        if (array.components < 1) std::abort();
      }
    }
    if (file.whole) pellucid::check_vtk_pieces(file, *file.whole, {});
  } catch (const pellucid::Error& error) {
    for (const char c : std::string_view(error.what())) {
      if (static_cast<unsigned char>(c) < ' ') std::abort();
    }
  }
  return 0;
}
