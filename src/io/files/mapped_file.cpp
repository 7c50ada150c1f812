// SPDX-License-Identifier: Apache-2.0
#include "mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pellucid/scene/error.h"

namespace pellucid {

std::shared_ptr<const std::byte> map_file(const std::filesystem::path& path, std::size_t bytes) {
  if (bytes == 0) return nullptr;
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  struct stat status {};
  const bool known = fstat(descriptor, &status) == 0;
  const bool whole = known && static_cast<std::uintmax_t>(status.st_size) >= bytes;
  void* start = MAP_FAILED;
  if (whole) start = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, descriptor, 0);
  close(descriptor);
  if (known && !whole) {
    throw Error(path.string() + ": the file has become shorter; is it being written?");
  }
  if (start == MAP_FAILED) return nullptr;
  return {static_cast<const std::byte*>(start),
          [bytes](const std::byte* first) { munmap(const_cast<std::byte*>(first), bytes); }};
}

}  // namespace pellucid
