// SPDX-License-Identifier: Apache-2.0

// The parsers of Zarr: the text of .zarray or zarr.json, then a byte 0 and the bytes of a chunk.
// Anything gives an array that could be, and a chunk as large as it says, or an Error of one line.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>
#include <utility>

#include "pellucid/scene/error.h"
#include "src/io/zarr/ome_zarr.h"
#include "src/io/zarr/zarr_codecs.h"
#include "src/io/zarr/zarr_metadata.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

template <class Work>
void attempt(const Work& work) {
  try {
    work();
  } catch (const pellucid::Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz"));
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
}

void decode(const pellucid::ZarrArray& array, std::string_view chunk) {
  require(array.shape.size() == array.chunk.size());
  const std::size_t values = pellucid::zarr_chunk_values(array.chunk, "fuzz");
  constexpr std::size_t most = std::size_t{1} << 16;
  if (values > most || array.chain.shards) return;
  const std::size_t bytes = values * array.type.bytes;
  pellucid::ZarrBytes stored(chunk.size());
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    stored.span()[i] = static_cast<std::byte>(chunk[i]);
  }
  require(pellucid::undo_codecs(array.chain.codecs, std::move(stored), bytes, "fuzz").size() ==
          bytes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  const std::string_view text = all.substr(0, all.find('\0'));
  const std::string_view chunk =
      text.size() == size ? std::string_view() : all.substr(text.size() + 1);
  attempt([&] {
    const pellucid::JsonFile file = pellucid::parse_data_json(text, "fuzz");
    attempt([&] { decode(pellucid::parse_zarr_2(file.root()), chunk); });
    attempt([&] { decode(pellucid::parse_zarr_3(file.root()), chunk); });
    attempt([&] {
      if (const auto image = pellucid::parse_ome_image(file.root())) {
        require(!image->levels.empty());
        for (const pellucid::OmeLevel& level : image->levels) {
          require(level.scale.size() == image->axes.size());
        }
      }
    });
  });
  return 0;
}
