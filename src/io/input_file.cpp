// SPDX-License-Identifier: Apache-2.0
#include "input_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

std::uintmax_t check_input_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    if (error && error != std::errc::no_such_file_or_directory) {
      throw Error(path.string() + ": cannot read the file: " + error.message());
    }
    throw Error(path.string() + ": no such file");
  }
  if (fs::is_directory(status)) throw Error(path.string() + ": is a folder; give a file");
  // Reading a pipe or a device might never end.
  if (!fs::is_regular_file(status)) {
    throw Error(path.string() + ": is not a regular file; copy its content to a file first");
  }
  if (faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) != 0) {
    throw Error(path.string() +
                ": cannot read the file: " + std::generic_category().message(errno));
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw Error(path.string() + ": cannot read the file: " + error.message());
  return size;
}

}  // namespace pellucid
