// SPDX-License-Identifier: Apache-2.0
#include "data_stream.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>

#include "input_file.h"
#include "pellucid/scene/error.h"

namespace pellucid {

bool is_gzip(const std::filesystem::path& path) {
  check_input_file(path);
  std::ifstream file(path, std::ios::binary);
  std::array<char, 2> start{};
  file.read(start.data(), 2);
  return file && start[0] == '\x1f' && start[1] == '\x8b';
}

struct DataStream::Inflater {
  Inflater() {
    // 32 + 15: a zlib or a gzip header, whichever is there, and the largest window.
    if (inflateInit2(&state, 32 + 15) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&state); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  z_stream state{};
  std::vector<char> input = std::vector<char>(std::size_t{1} << 18);
  bool at_end = false;  // of the last member
};

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
  if (compression == Compression::deflate) inflater_ = std::make_unique<Inflater>();
}

DataStream::~DataStream() = default;

std::size_t DataStream::inflate_some(std::span<std::byte> to) {
  Inflater& in = *inflater_;
  z_stream& state = in.state;
  const std::size_t largest = std::numeric_limits<uInt>::max();
  const uInt wanted = static_cast<uInt>(std::min(to.size(), largest));
  state.next_out = reinterpret_cast<Bytef*>(to.data());
  state.avail_out = wanted;
  while (state.avail_out == wanted && !in.at_end) {
    if (state.avail_in == 0) {
      file_.read(in.input.data(), static_cast<std::streamsize>(in.input.size()));
      state.next_in = reinterpret_cast<Bytef*>(in.input.data());
      state.avail_in = static_cast<uInt>(file_.gcount());
      if (state.avail_in == 0) {
        throw Error(name_ + ": the compressed data ends too early; the file is cut off");
      }
    }
    const int status = inflate(&state, Z_NO_FLUSH);
    if (status == Z_STREAM_END) {
      if (state.avail_in == 0) {
        file_.read(in.input.data(), static_cast<std::streamsize>(in.input.size()));
        state.next_in = reinterpret_cast<Bytef*>(in.input.data());
        state.avail_in = static_cast<uInt>(file_.gcount());
      }
      // Another gzip member may follow; anything else after the end is not of the data.
      if (state.avail_in > 0 && state.next_in[0] == 0x1f) {
        inflateReset(&state);
      } else {
        in.at_end = true;
      }
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      throw Error(name_ + ": the compressed data is damaged" +
                  (state.msg != nullptr ? " (" + std::string(state.msg) + ")" : "") +
                  "; get the file again");
    }
  }
  return wanted - state.avail_out;
}

std::size_t DataStream::read_some(std::span<std::byte> to) {
  if (inflater_) return inflate_some(to);
  file_.read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
  return static_cast<std::size_t>(file_.gcount());
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
    if (inflate_some(scratch) == 0) return;
  }
}

}  // namespace pellucid
