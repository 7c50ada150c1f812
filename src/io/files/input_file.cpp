// SPDX-License-Identifier: Apache-2.0
#include "input_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

const char* kind_of(const fs::file_status& status) {
  switch (status.type()) {
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::character:
    case fs::file_type::block:
      return "a device";
    default:
      return "something else";
  }
}

}  // namespace

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
    throw Error(path.string() + ": is " + kind_of(status) +
                ", not a regular file; copy its content to a file first");
  }
  if (faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) != 0) {
    throw Error(path.string() +
                ": cannot read the file: " + std::generic_category().message(errno));
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw Error(path.string() + ": cannot read the file: " + error.message());
  return size;
}

std::string first_bytes(const fs::path& path, std::size_t most) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  std::ifstream stream(path, std::ios::binary);
  std::string bytes(most, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace pellucid
