// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/internal/zip_files.h"

#include <array>
#include <cstddef>
#include <fstream>
#include <span>

#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "zip_writer.h"

namespace pellucid {

void write_zip(const std::filesystem::path& path, const std::vector<std::filesystem::path>& files) {
  AtomicFile target(path);
  std::ofstream out(target.temporary_path(), std::ios::binary);
  ZipWriter archive([&](std::span<const std::byte> bytes) {
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    if (!out) throw Error(path.string() + ": cannot write: the disk is full, or has failed");
  });
  std::array<char, 65536> part{};
  for (const std::filesystem::path& file : files) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in) throw Error(file.string() + ": cannot read");
    archive.begin(file.filename().string(), static_cast<std::uint64_t>(in.tellg()));
    in.seekg(0);
    while (in.read(part.data(), part.size()) || in.gcount() > 0) {
      archive.put(std::as_bytes(std::span(part.data(), static_cast<std::size_t>(in.gcount()))));
    }
  }
  archive.finish();
  out.close();
  if (!out) throw Error(path.string() + ": cannot write: the disk is full, or has failed");
  target.commit();
}

}  // namespace pellucid
