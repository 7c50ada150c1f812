// SPDX-License-Identifier: Apache-2.0
#include "inflater.h"
#include "pellucid/scene/error.h"

#ifndef PELLUCID_HAVE_BZIP2

namespace pellucid {

std::unique_ptr<Inflater> make_bzip2_inflater(const std::string& name) {
  throw Error(
      name + ": its values are compressed with bzip2, which this build has not; save it with gzip");
}

}  // namespace pellucid

#else

#include <bzlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <vector>

namespace pellucid {

namespace {

class Bzip2Inflater : public Inflater {
 public:
  Bzip2Inflater() { begin(); }
  ~Bzip2Inflater() override { BZ2_bzDecompressEnd(&state_); }
  Bzip2Inflater(const Bzip2Inflater&) = delete;
  Bzip2Inflater& operator=(const Bzip2Inflater&) = delete;

  std::size_t read(std::span<std::byte> to, const NextBytes& next,
                   const std::string& name) override {
    constexpr std::size_t largest = std::numeric_limits<unsigned>::max();
    const auto wanted = static_cast<unsigned>(std::min(to.size(), largest));
    state_.next_out = reinterpret_cast<char*>(to.data());
    state_.avail_out = wanted;
    while (state_.avail_out == wanted && !at_end_) {
      if (state_.avail_in == 0 && !fetch(next)) {
        throw Error(name + ": the compressed data ends too early; the file is cut off");
      }
      const int status = BZ2_bzDecompress(&state_);
      if (status == BZ_STREAM_END) {
        // As with gzip: another member may follow.
        if ((state_.avail_in > 0 || fetch(next)) && state_.next_in[0] == 'B') {
          begin_again();
        } else {
          at_end_ = true;
        }
      } else if (status == BZ_MEM_ERROR) {
        throw std::bad_alloc();
      } else if (status != BZ_OK) {
        throw Error(name + ": the compressed data is damaged (bzip2); get the file again");
      }
    }
    return wanted - state_.avail_out;
  }

 private:
  void begin() {
    if (BZ2_bzDecompressInit(&state_, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  void begin_again() {
    bz_stream kept = state_;
    BZ2_bzDecompressEnd(&state_);
    state_ = {};
    begin();
    state_.next_in = kept.next_in;
    state_.avail_in = kept.avail_in;
    state_.next_out = kept.next_out;
    state_.avail_out = kept.avail_out;
  }
  bool fetch(const NextBytes& next) {
    state_.avail_in = static_cast<unsigned>(next(std::as_writable_bytes(std::span(input_))));
    state_.next_in = input_.data();
    return state_.avail_in > 0;
  }

  bz_stream state_{};
  std::vector<char> input_ = std::vector<char>(std::size_t{1} << 18);
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<Inflater> make_bzip2_inflater(const std::string&) {
  return std::make_unique<Bzip2Inflater>();
}

}  // namespace pellucid

#endif
