// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <vector>

#include "inflater.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

class ZlibInflater : public Inflater {
 public:
  /// Begins a stream. `window_bits` as of inflateInit2().
  explicit ZlibInflater(int window_bits) : has_header_(window_bits > 0) {
    if (inflateInit2(&state_, window_bits) != Z_OK) throw std::bad_alloc();
  }
  ~ZlibInflater() override { inflateEnd(&state_); }
  ZlibInflater(const ZlibInflater&) = delete;
  ZlibInflater& operator=(const ZlibInflater&) = delete;

  std::size_t read(std::span<std::byte> to, const NextBytes& next,
                   const std::string& name) override {
    const std::size_t largest = std::numeric_limits<uInt>::max();
    const uInt wanted = static_cast<uInt>(std::min(to.size(), largest));
    state_.next_out = reinterpret_cast<Bytef*>(to.data());
    state_.avail_out = wanted;
    while (state_.avail_out == wanted && !at_end_) {
      if (state_.avail_in == 0 && !fetch(next)) {
        throw Error(name + ": the compressed data ends too early; the file is cut off");
      }
      const int status = inflate(&state_, Z_NO_FLUSH);
      if (status == Z_STREAM_END) {
        // Another gzip member may follow; anything else after the end is not of the data.
        if (has_header_ && (state_.avail_in > 0 || fetch(next)) && state_.next_in[0] == 0x1f) {
          inflateReset(&state_);
        } else {
          at_end_ = true;
        }
      } else if (status != Z_OK && status != Z_BUF_ERROR) {
        throw Error(name + ": the compressed data is damaged" +
                    (state_.msg != nullptr ? " (" + std::string(state_.msg) + ")" : "") +
                    "; get the file again");
      }
    }
    return wanted - state_.avail_out;
  }

 private:
  bool fetch(const NextBytes& next) {
    state_.avail_in = static_cast<uInt>(next(std::as_writable_bytes(std::span(input_))));
    state_.next_in = input_.data();
    return state_.avail_in > 0;
  }

  z_stream state_{};
  std::vector<Bytef> input_ = std::vector<Bytef>(std::size_t{1} << 18);
  bool has_header_;
  bool at_end_ = false;  // of the last member
};

}  // namespace

std::unique_ptr<Inflater> make_zlib_inflater() {
  // 32 + 15: a zlib or a gzip header, whichever is there, and the largest window.
  return std::make_unique<ZlibInflater>(32 + 15);
}

std::unique_ptr<Inflater> make_deflate_inflater() {
  return std::make_unique<ZlibInflater>(-15);
}

}  // namespace pellucid
