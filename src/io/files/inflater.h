// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace pellucid {

/// Reads the next bytes of what is compressed, up to so many; how many there were, 0 at its end.
using NextBytes = std::function<std::size_t(std::span<std::byte>)>;

/// Bytes that a library decompresses, of one member of a file after the other.
class Inflater {
 public:
  virtual ~Inflater() = default;
  /// Reads the next bytes, one at least unless there are none any more. Throws Error that begins
  /// with `name` where they are damaged or end too early.
  virtual std::size_t read(std::span<std::byte> to, const NextBytes& next,
                           const std::string& name) = 0;
};

/// Makes one for zlib or gzip, whichever begins.
std::unique_ptr<Inflater> make_zlib_inflater();
/// Makes one for Deflate alone, without a header or a checksum, as zip archives have it.
std::unique_ptr<Inflater> make_deflate_inflater();
/// Makes one for bzip2; throws Error that begins with `name` where the build has none.
std::unique_ptr<Inflater> make_bzip2_inflater(const std::string& name);

}  // namespace pellucid
