// SPDX-License-Identifier: Apache-2.0

// The numbers in the text of VTK's legacy files: any bytes pass, or give an Error of one line.

#include "src/io/vtk/legacy_vtk_numbers.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "pellucid/scene/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    pellucid::check_legacy_vtk_numbers({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const pellucid::Error& error) {
    const std::string_view message = error.what();
    if (!message.starts_with("fuzz: ") || message.size() > 1000) std::abort();
    for (const char c : message) {
      if (static_cast<unsigned char>(c) < ' ') std::abort();
    }
  }
  return 0;
}
