// SPDX-License-Identifier: Apache-2.0
//
// The formats of numcodecs, which Zarr 3 has taken over: a block of LZ4 behind its length in 4
// bytes, checksums in 4 bytes, all little-endian.

#include "zarr_codecs.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#ifdef PELLUCID_HAVE_BLOSC
#include <blosc.h>
#endif
#ifdef PELLUCID_HAVE_ZSTD
#include <zstd.h>
#endif
#ifdef PELLUCID_HAVE_LZ4
#include <lz4.h>
#endif

#include "files/inflater.h"
#include "pellucid/scene/error.h"
#include "text/text.h"
#include "volumes/stored_numbers.h"

namespace pellucid {

namespace {

using Kind = ZarrCodec::Kind;

[[noreturn]] void fail_damaged(const ZarrCodec& codec, const std::string& name) {
  throw Error(name + ": the chunk's " + codec.name + " data is damaged; get the store again");
}

[[noreturn, maybe_unused]] void fail_without(const ZarrCodec& codec, const char* package,
                                             const std::string& name) {
  throw Error(name + ": is compressed by " + codec.name +
              ", which this build cannot read; build it with " + package);
}

std::uint32_t little_32(std::span<const std::byte> bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 4; i-- > 0;) {
    number = number << 8 | std::to_integer<std::uint32_t>(bytes[i]);
  }
  return number;
}

/// Returns the size that a codec makes of so many bytes; nothing if that depends on them.
std::optional<std::size_t> encoded_size(const ZarrCodec& codec, std::size_t bytes) {
  constexpr std::size_t checksum = 4;
  switch (codec.kind) {
    case Kind::same:
    case Kind::shuffle:
      return bytes;
    case Kind::check_behind:
    case Kind::check_crc32:
    case Kind::check_adler32:
    case Kind::check_crc32c:
      return bytes + checksum;
    case Kind::packbits:
      return 1 + (bytes + 7) / 8;
    case Kind::convert:
    case Kind::delta:
      return bytes / codec.decoded.bytes * codec.encoded.bytes;
    default:
      return std::nullopt;
  }
}

ZarrBytes inflate(const ZarrCodec& codec, const ZarrBytes& stored, std::size_t bytes,
                  const std::string& name) {
  std::span<const std::byte> rest = stored.span();
  const NextBytes next = [&](std::span<std::byte> to) {
    const std::size_t part = std::min(to.size(), rest.size());
    std::ranges::copy(rest.first(part), to.begin());
    rest = rest.subspan(part);
    return part;
  };
  ZarrInflation inflation(codec, next, name);
  ZarrBytes result(bytes);
  inflation.read(result.span());
  inflation.expect_end();
  return result;
}

ZarrBytes undo_zstd(const ZarrCodec& codec, [[maybe_unused]] const ZarrBytes& stored,
                    [[maybe_unused]] std::size_t bytes, const std::string& name) {
#ifdef PELLUCID_HAVE_ZSTD
  ZarrBytes result(bytes);
  const std::size_t size =
      ZSTD_decompress(result.span().data(), bytes, stored.span().data(), stored.size());
  if (ZSTD_isError(size) != 0 || size != bytes) fail_damaged(codec, name);
  return result;
#else
  fail_without(codec, "zstd (Debian: libzstd-dev)", name);
#endif
}

ZarrBytes undo_blosc(const ZarrCodec& codec, [[maybe_unused]] const ZarrBytes& stored,
                     [[maybe_unused]] std::size_t bytes, const std::string& name) {
#ifdef PELLUCID_HAVE_BLOSC
  std::size_t size = 0;
  if (stored.size() < BLOSC_MIN_HEADER_LENGTH ||
      blosc_cbuffer_validate(stored.span().data(), stored.size(), &size) != 0 || size != bytes) {
    fail_damaged(codec, name);
  }
  ZarrBytes result(bytes);
  const int done = blosc_decompress_ctx(stored.span().data(), result.span().data(), bytes, 1);
  if (done >= 0 && static_cast<std::size_t>(done) == bytes) return result;
  const char* const library = blosc_cbuffer_complib(stored.span().data());
  const std::string inside = library == nullptr ? "something" : in_small_letters(library);
  if (std::string(blosc_list_compressors()).find(inside) == std::string::npos) {
    throw Error(name + ": is compressed by " + inside +
                " within blosc, which the blosc of this build cannot read; save it with lz4");
  }
  fail_damaged(codec, name);
#else
  fail_without(codec, "blosc (Debian: libblosc-dev)", name);
#endif
}

ZarrBytes undo_lz4(const ZarrCodec& codec, [[maybe_unused]] const ZarrBytes& stored,
                   [[maybe_unused]] std::size_t bytes, const std::string& name) {
#ifdef PELLUCID_HAVE_LZ4
  constexpr std::size_t head = 4;
  constexpr std::size_t largest = std::numeric_limits<int>::max();
  if (stored.size() < head || stored.size() > largest || bytes > largest ||
      little_32(stored.span()) != bytes) {
    fail_damaged(codec, name);
  }
  ZarrBytes result(bytes);
  const int done =
      LZ4_decompress_safe(reinterpret_cast<const char*>(stored.span().data() + head),
                          reinterpret_cast<char*>(result.span().data()),
                          static_cast<int>(stored.size() - head), static_cast<int>(bytes));
  if (done < 0 || static_cast<std::size_t>(done) != bytes) fail_damaged(codec, name);
  return result;
#else
  fail_without(codec, "LZ4 (Debian: liblz4-dev)", name);
#endif
}

ZarrBytes part_of(const ZarrBytes& from, std::size_t first, std::size_t count) {
  ZarrBytes part(count);
  std::ranges::copy(from.span().subspan(first, count), part.span().begin());
  return part;
}

/// Takes 4 bytes away that stand behind the others or in front.
ZarrBytes undo_checksum(const ZarrCodec& codec, const ZarrBytes& stored, const std::string& name) {
  constexpr std::size_t size = 4;
  if (stored.size() < size) fail_damaged(codec, name);
  const bool in_front = codec.kind == Kind::check_crc32 || codec.kind == Kind::check_adler32;
  const std::size_t rest = stored.size() - size;
  const std::uint32_t said = little_32(stored.span().subspan(in_front ? 0 : rest, size));
  ZarrBytes result = part_of(stored, in_front ? size : 0, rest);
  const auto* const bytes = reinterpret_cast<const Bytef*>(result.span().data());
  std::uintmax_t counted = said;
  if (codec.kind == Kind::check_crc32) counted = crc32_z(crc32_z(0, nullptr, 0), bytes, rest);
  if (codec.kind == Kind::check_adler32) {
    counted = adler32_z(adler32_z(0, nullptr, 0), bytes, rest);
  }
  if (codec.kind == Kind::check_crc32c) counted = crc32c(result.span());
  if (counted != said) {
    throw Error(name + ": the chunk's checksum (" + codec.name +
                ") is wrong; the file is damaged, get it again");
  }
  return result;
}

ZarrBytes undo_shuffle(const ZarrCodec& codec, const ZarrBytes& stored) {
  const std::size_t count = stored.size() / codec.element;
  ZarrBytes result(stored.size());
  const std::span<const std::byte> from = stored.span();
  const std::span<std::byte> to = result.span();
  for (std::size_t b = 0; b < codec.element; ++b) {
    for (std::size_t i = 0; i < count; ++i) to[i * codec.element + b] = from[b * count + i];
  }
  std::ranges::copy(from.subspan(count * codec.element), to.subspan(count * codec.element).begin());
  return result;
}

ZarrBytes undo_packbits(const ZarrCodec& codec, const ZarrBytes& stored, std::size_t bytes,
                        const std::string& name) {
  if (stored.size() != *encoded_size(codec, bytes)) fail_damaged(codec, name);
  ZarrBytes result(bytes);
  for (std::size_t i = 0; i < bytes; ++i) {
    const auto eight = std::to_integer<unsigned>(stored.span()[1 + i / 8]);
    result.span()[i] = static_cast<std::byte>(eight >> (7 - i % 8) & 1U);
  }
  return result;
}

std::array<std::byte, 8> native_bytes(std::span<const std::byte> from, bool big_endian) {
  std::array<std::byte, 8> bytes{};
  std::ranges::copy(from, bytes.begin());
  if (big_endian != (std::endian::native == std::endian::big)) {
    std::ranges::reverse(std::span(bytes).first(from.size()));
  }
  return bytes;
}

template <class Number>
Number number_at(const std::array<std::byte, 8>& bytes) {
  Number number;
  std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

/// Sign-extended, so that sums in 64 bits are right in fewer.
std::uint64_t whole_at(const std::array<std::byte, 8>& bytes, const ZarrType& type) {
  const auto signed_bits = [](auto number) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
  };
  if (type.name == "i8") return signed_bits(number_at<std::int8_t>(bytes));
  if (type.name == "i16") return signed_bits(number_at<std::int16_t>(bytes));
  if (type.name == "i32") return signed_bits(number_at<std::int32_t>(bytes));
  if (type.bytes == 1) return number_at<std::uint8_t>(bytes);
  if (type.bytes == 2) return number_at<std::uint16_t>(bytes);
  if (type.bytes == 4) return number_at<std::uint32_t>(bytes);
  return number_at<std::uint64_t>(bytes);
}

double real_at(const std::array<std::byte, 8>& bytes, const ZarrType& type) {
  if (type.name == "f64") return number_at<double>(bytes);
  if (type.name == "f32") return static_cast<double>(number_at<float>(bytes));
  if (type.name == "f16")
    return static_cast<double>(half_to_float(number_at<std::uint16_t>(bytes)));
  const std::uint64_t whole = whole_at(bytes, type);
  return type.name[0] == 'i' ? static_cast<double>(static_cast<std::int64_t>(whole))
                             : static_cast<double>(whole);
}

void put_bytes(std::array<std::byte, 8> bytes, const ZarrType& type, std::span<std::byte> to) {
  if (type.big_endian != (std::endian::native == std::endian::big)) {
    std::ranges::reverse(std::span(bytes).first(type.bytes));
  }
  std::ranges::copy(std::span(bytes).first(type.bytes), to.begin());
}

template <class Number>
std::array<std::byte, 8> bytes_of(Number number) {
  std::array<std::byte, 8> bytes{};
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

/// Returns the lowest bytes of a whole number.
std::array<std::byte, 8> bytes_of_whole(std::uint64_t number, const ZarrType& type) {
  if (type.bytes == 1) return bytes_of(static_cast<std::uint8_t>(number));
  if (type.bytes == 2) return bytes_of(static_cast<std::uint16_t>(number));
  if (type.bytes == 4) return bytes_of(static_cast<std::uint32_t>(number));
  return bytes_of(number);
}

std::array<std::byte, 8> bytes_of_real(double number, const ZarrType& type, const ZarrCodec& codec,
                                       const std::string& name) {
  if (type.name == "f64") return bytes_of(number);
  if (type.name == "f32") return bytes_of(static_cast<float>(number));
  if (type.name == "f16") {
    throw Error(name + ": a " + codec.name + " filter of half floats is not read");
  }
  // As numpy's astype: towards zero. What fits no type is damage.
  const double whole = std::trunc(number);
  if (!(std::abs(whole) < 0x1p63)) fail_damaged(codec, name);
  return bytes_of_whole(static_cast<std::uint64_t>(static_cast<std::int64_t>(whole)), type);
}

/// Calls visit(bytes of the next number, where the decoded one goes).
template <class Visit>
ZarrBytes each_number(const ZarrCodec& codec, const ZarrBytes& stored, std::size_t bytes,
                      const std::string& name, const Visit& visit) {
  const std::size_t count = bytes / codec.decoded.bytes;
  if (stored.size() != count * codec.encoded.bytes || count * codec.decoded.bytes != bytes) {
    fail_damaged(codec, name);
  }
  ZarrBytes result(bytes);
  for (std::size_t i = 0; i < count; ++i) {
    visit(native_bytes(stored.span().subspan(i * codec.encoded.bytes, codec.encoded.bytes),
                       codec.encoded.big_endian),
          result.span().subspan(i * codec.decoded.bytes, codec.decoded.bytes));
  }
  return result;
}

ZarrBytes undo_delta(const ZarrCodec& codec, const ZarrBytes& stored, std::size_t bytes,
                     const std::string& name) {
  const ZarrType& type = codec.decoded;
  if (type.name == "f16" || type.name == "b1" ||
      (type.name[0] != 'f' && codec.encoded.name[0] == 'f')) {
    throw Error(name + ": a delta filter from " + codec.encoded.name + " to " + type.name +
                " is not read");
  }
  if (type.name[0] != 'f') {
    std::uint64_t sum = 0;
    return each_number(codec, stored, bytes, name, [&](const auto& number, auto to) {
      sum += whole_at(number, codec.encoded);
      put_bytes(bytes_of_whole(sum, type), type, to);
    });
  }
  double sum = 0;
  return each_number(codec, stored, bytes, name, [&](const auto& number, auto to) {
    sum += real_at(number, codec.encoded);
    if (type.name == "f32") sum = static_cast<double>(static_cast<float>(sum));
    put_bytes(bytes_of_real(sum, type, codec, name), type, to);
  });
}

ZarrBytes undo_convert(const ZarrCodec& codec, const ZarrBytes& stored, std::size_t bytes,
                       const std::string& name) {
  const bool scales = codec.scale != 1 || codec.offset != 0;
  const bool is_whole = codec.encoded.name[0] != 'f' && codec.decoded.name[0] != 'f';
  const bool is_alike = codec.encoded.name == codec.decoded.name;
  return each_number(codec, stored, bytes, name, [&](const auto& number, auto to) {
    if (!scales && (is_whole || is_alike)) {
      put_bytes(is_alike ? number : bytes_of_whole(whole_at(number, codec.encoded), codec.decoded),
                codec.decoded, to);
      return;
    }
    const double value = real_at(number, codec.encoded) / codec.scale + codec.offset;
    put_bytes(bytes_of_real(value, codec.decoded, codec, name), codec.decoded, to);
  });
}

ZarrBytes undo(const ZarrCodec& codec, ZarrBytes stored, std::size_t bytes,
               const std::string& name) {
  switch (codec.kind) {
    case Kind::blosc:
      return undo_blosc(codec, stored, bytes, name);
    case Kind::zstd:
      return undo_zstd(codec, stored, bytes, name);
    case Kind::lz4:
      return undo_lz4(codec, stored, bytes, name);
    case Kind::deflate:
    case Kind::bzip2:
      return inflate(codec, stored, bytes, name);
    case Kind::check_behind:
    case Kind::check_crc32:
    case Kind::check_adler32:
    case Kind::check_crc32c:
      return undo_checksum(codec, stored, name);
    case Kind::shuffle:
      return undo_shuffle(codec, stored);
    case Kind::packbits:
      return undo_packbits(codec, stored, bytes, name);
    case Kind::delta:
      return undo_delta(codec, stored, bytes, name);
    case Kind::convert:
      return undo_convert(codec, stored, bytes, name);
    case Kind::same:
      break;
  }
  return stored;
}

std::array<std::uint32_t, 256> crc32c_table() {
  constexpr std::uint32_t polynomial = 0x82F63B78;
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t remainder = i;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder & 1U) != 0 ? remainder >> 1 ^ polynomial : remainder >> 1;
    }
    table[i] = remainder;
  }
  return table;
}

}  // namespace

bool ZarrInflation::takes(const std::vector<ZarrCodec>& codecs) noexcept {
  return codecs.size() == 1 &&
         (codecs.front().kind == Kind::deflate || codecs.front().kind == Kind::bzip2);
}

ZarrInflation::ZarrInflation(const ZarrCodec& codec, NextBytes next, std::string name)
    : codec_(codec),
      next_(std::move(next)),
      name_(std::move(name)),
      inflater_(codec.kind == Kind::bzip2 ? make_bzip2_inflater(name_) : make_zlib_inflater()) {}

void ZarrInflation::read(std::span<std::byte> to) {
  while (!to.empty()) {
    const std::size_t part = inflater_->read(to, next_, name_);
    if (part == 0) fail_damaged(codec_, name_);
    to = to.subspan(part);
  }
}

void ZarrInflation::expect_end() {
  std::array<std::byte, 1> more{};
  if (inflater_->read(more, next_, name_) > 0) fail_damaged(codec_, name_);
}

ZarrBytes undo_codecs(const std::vector<ZarrCodec>& codecs, ZarrBytes stored, std::size_t bytes,
                      const std::string& name) {
  // What each codec was given when the chunk was written.
  std::vector<std::size_t> sizes{bytes};
  for (const ZarrCodec& codec : codecs) {
    const std::optional<std::size_t> size = encoded_size(codec, sizes.back());
    if (!size && &codec != &codecs.back() && !encoded_size((&codec)[1], 0)) {
      throw Error(name + ": " + (&codec)[1].name + " behind " + codec.name + " is not read");
    }
    // Behind a compressor come checksums alone, which say their own size.
    sizes.push_back(size.value_or(0));
  }
  for (std::size_t i = codecs.size(); i-- > 0;) {
    stored = undo(codecs[i], std::move(stored), sizes[i], name);
  }
  if (stored.size() != bytes) {
    throw Error(name + ": holds " + std::to_string(stored.size()) +
                " bytes of a chunk, but its sides and type need " + std::to_string(bytes) +
                "; it is cut off or the array's header is wrong");
  }
  return stored;
}

std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept {
  static const std::array<std::uint32_t, 256> table = crc32c_table();
  std::uint32_t remainder = 0xFFFFFFFF;
  for (const std::byte byte : bytes) {
    remainder = remainder >> 8 ^ table[(remainder ^ std::to_integer<std::uint32_t>(byte)) & 255U];
  }
  return ~remainder;
}

}  // namespace pellucid
