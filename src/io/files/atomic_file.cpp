// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/internal/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <random>
#include <system_error>

#include "input_file.h"
#include "pellucid/io/image_files.h"
#include "pellucid/scene/error.h"
#include "text/latin_text.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

std::string reason(int error_number) {
  return std::generic_category().message(error_number);
}

std::string random_suffix() {
  static constexpr char digits[] = "0123456789abcdef";
  std::random_device device;
  std::string suffix(12, '0');
  for (char& c : suffix) c = digits[device() % 16];
  return suffix;
}

// Where a link leads: the file behind it is replaced, not the link.
fs::path behind_links(const fs::path& target) {
  std::error_code error;
  if (!fs::is_symlink(target, error)) return target;
  fs::path resolved = fs::weakly_canonical(target, error);
  return error ? target : resolved;
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : target_(behind_links(target)) {
  if (!target_.has_filename()) {
    throw Error(target.string() + ": not a file name; give the name of a file to write");
  }
  std::error_code error;
  const fs::file_status status = fs::status(target_, error);
  if (fs::is_directory(status)) {
    throw Error(target_.string() + ": is a folder; give the name of a file to write");
  }
  // A rename would put a file in the place of a device or pipe.
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(target_.string() + ": is not a regular file; give another name to write to");
  }
  fs::path folder = target_.parent_path();
  if (folder.empty()) folder = ".";
  if (!fs::is_directory(folder, error)) {
    throw Error(target_.string() + ": the folder " + folder.string() +
                " does not exist; make it first");
  }
  for (int attempt = 0; attempt < 8; ++attempt) {
    // The name is short whatever the target's, so that it fits where the target's does.
    temporary_ = folder / (".pellucid-" + random_suffix() + ".tmp");
    const int descriptor = open(temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      close(descriptor);
      return;
    }
    if (errno != EEXIST) break;
  }
  throw Error(target_.string() + ": cannot write in the folder " + folder.string() + ": " +
              reason(errno));
}

AtomicFile::~AtomicFile() {
  if (!committed_) unlink(temporary_.c_str());
}

void AtomicFile::commit() {
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) throw Error(target_.string() + ": cannot write: " + error.message());
  committed_ = true;
}

void write_text_file(const fs::path& path, std::string_view text) {
  AtomicFile file(path);
  std::ofstream stream(file.temporary_path(), std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) throw Error(path.string() + ": cannot write: is the disk full?");
  file.commit();
}

std::string read_text_file(const fs::path& path, std::size_t largest) {
  std::string text = read_bytes(path, largest);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    throw Error(path.string() + ": is text in UTF-16; save it as UTF-8");
  }
  drop_mark(text);
  return text;
}

std::string read_bytes(const fs::path& path, std::size_t largest) {
  const std::uintmax_t size = check_input_file(path);
  if (size > largest) {
    throw Error(path.string() + ": " + std::to_string(size) + " bytes; at most " +
                std::to_string(largest) + " are read of such a file");
  }
  std::ifstream stream(path, std::ios::binary);
  std::string text(static_cast<std::size_t>(size), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream) throw Error(path.string() + ": cannot read the file");
  return text;
}

void check_writable(const fs::path& path) {
  // The only test that holds for every file system and permission is to do it.
  const AtomicFile trial(path);
}

}  // namespace pellucid
