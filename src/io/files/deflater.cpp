// SPDX-License-Identifier: Apache-2.0
#include "deflater.h"

#include <zlib.h>

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

namespace pellucid {

struct Deflater::State {
  z_stream stream{};
  std::vector<std::byte> out = std::vector<std::byte>(std::size_t{1} << 16);
};

Deflater::Deflater(Wrapping wrapping, std::function<void(std::span<const std::byte>)> to)
    : to_(std::move(to)), state_(std::make_unique<State>()) {
  constexpr int largest_window = 15, memory_level = 8;
  const int window_bits = wrapping == Wrapping::none   ? -largest_window
                          : wrapping == Wrapping::zlib ? largest_window
                                                       : 16 + largest_window;
  if (deflateInit2(&state_->stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, window_bits, memory_level,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
}

Deflater::~Deflater() {
  deflateEnd(&state_->stream);
}

void Deflater::put(std::span<const std::byte> bytes) {
  // zlib counts with 32 bits.
  constexpr std::size_t most = std::size_t{1} << 30;
  for (std::size_t begin = 0; begin < bytes.size(); begin += most) {
    run(bytes.subspan(begin, std::min(most, bytes.size() - begin)), false);
  }
}

void Deflater::finish() {
  run({}, true);
}

void Deflater::run(std::span<const std::byte> bytes, bool last) {
  z_stream& stream = state_->stream;
  // zlib does not write to what it reads; its interface is older than const.
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  do {
    stream.next_out = reinterpret_cast<Bytef*>(state_->out.data());
    stream.avail_out = static_cast<uInt>(state_->out.size());
    deflate(&stream, last ? Z_FINISH : Z_NO_FLUSH);
    to_(std::span(state_->out).first(state_->out.size() - stream.avail_out));
  } while (stream.avail_out == 0);
}

}  // namespace pellucid
