// SPDX-License-Identifier: Apache-2.0
#include "data_stream.h"

#include <algorithm>
#include <array>

#include "input_file.h"
#include "pellucid/scene/error.h"

namespace pellucid {

bool is_gzip(const std::filesystem::path& path) {
  check_input_file(path);
  return first_bytes(path, 2) == "\x1f\x8b";
}

DataStream::DataStream(const std::filesystem::path& path, std::uintmax_t offset,
                       Compression compression)
    : name_(path.string()) {
  const std::uintmax_t size = check_input_file(path);
  if (offset > size) {
    throw Error(name_ + ": the file has " + std::to_string(size) +
                " bytes, but its data should begin at byte " + std::to_string(offset) +
                "; it is cut off");
  }
  file_.open(path, std::ios::binary);
  file_.seekg(static_cast<std::streamoff>(offset));
  if (!file_) throw Error(name_ + ": cannot read the file");
  if (compression == Compression::deflate) inflater_ = make_zlib_inflater();
  if (compression == Compression::bzip2) inflater_ = make_bzip2_inflater(name_);
}

std::size_t DataStream::read_some(std::span<std::byte> to) {
  const auto read_file = [&](std::span<std::byte> part) {
    file_.read(reinterpret_cast<char*>(part.data()), static_cast<std::streamsize>(part.size()));
    return static_cast<std::size_t>(file_.gcount());
  };
  return inflater_ ? inflater_->read(to, read_file, name_) : read_file(to);
}

void DataStream::read(std::span<std::byte> to) {
  std::size_t done = 0;
  while (done < to.size()) {
    const std::size_t got = read_some(to.subspan(done));
    if (got == 0) {
      throw Error(name_ + ": the data ends too early: " + std::to_string(to.size()) +
                  " bytes are expected, but there are " + std::to_string(done) +
                  "; the file is cut off or its header is wrong");
    }
    done += got;
  }
}

void DataStream::skip(std::uintmax_t bytes) {
  std::array<std::byte, 4096> scratch;
  while (bytes > 0) {
    const std::size_t part =
        static_cast<std::size_t>(std::min<std::uintmax_t>(bytes, scratch.size()));
    read(std::span(scratch).first(part));
    bytes -= part;
  }
}

std::uintmax_t DataStream::skip_all() {
  std::vector<std::byte> scratch(std::size_t{1} << 18);
  std::uintmax_t bytes = 0;
  for (std::size_t got = 1; got > 0; bytes += got) got = read_some(scratch);
  return bytes;
}

bool DataStream::at_end() {
  std::byte next{};
  return read_some(std::span(&next, 1)) == 0;
}

void DataStream::finish() {
  if (!inflater_) return;
  // Far beyond any padding; a longer rest is not worth inflating for its checksum.
  constexpr int largest_rest = 256;
  std::array<std::byte, 4096> scratch;
  for (int part = 0; part < largest_rest; ++part) {
    if (read_some(scratch) == 0) return;
  }
}

}  // namespace pellucid
