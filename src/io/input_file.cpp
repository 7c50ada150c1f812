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

void check_memory(std::uintmax_t bytes, const std::string& name) {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
  if (pages <= 0 || page <= 0) return;
  const std::uintmax_t memory =
      static_cast<std::uintmax_t>(pages) * static_cast<std::uintmax_t>(page);
  if (bytes <= memory) return;
  throw Error(name + ": the data would take " + std::to_string(bytes >> 20) +
              " MiB, more than this machine's memory of " + std::to_string(memory >> 20) +
              " MiB; crop or reduce the volume");
}

}  // namespace pellucid
