// SPDX-License-Identifier: Apache-2.0
#include "gzip_source.h"

#include <cstddef>
#include <memory>
#include <span>

#include "data_stream.h"

namespace pellucid {

ByteSource gzip_source(const std::filesystem::path& path) {
  static constexpr auto deflate = DataStream::Compression::deflate;
  ByteSource source{path.string(), DataStream(path, 0, deflate).skip_all(), {}, {}};
  struct Place {
    std::unique_ptr<DataStream> stream;
    std::uintmax_t at = 0;
  };
  source.read = [path, place = std::make_shared<Place>()](std::uintmax_t from,
                                                          std::span<std::byte> to) {
    if (!place->stream || from < place->at) {
      place->stream = std::make_unique<DataStream>(path, 0, deflate);
      place->at = 0;
    }
    place->stream->skip(from - place->at);
    place->stream->read(to);
    place->at = from + to.size();
  };
  return source;
}

ByteSource plain_or_gzip_source(const std::filesystem::path& path) {
  return is_gzip(path) ? gzip_source(path) : file_source(path);
}

}  // namespace pellucid
