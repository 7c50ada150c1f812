// SPDX-License-Identifier: Apache-2.0
#include "vtk_files.h"

#include <string>
#include <system_error>

#include "files/input_file.h"
#include "vtk/xml/vtk_xml_end.h"

namespace pellucid {

std::uintmax_t bytes_of_vtk_files(const std::filesystem::path& path) {
  const std::uintmax_t own = check_input_file(path);
  std::uintmax_t bytes = 0;
  for (const std::filesystem::path& file : check_vtk_xml_end(path)) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error) bytes += size;
  }
  return std::max(own, bytes);
}

}  // namespace pellucid
