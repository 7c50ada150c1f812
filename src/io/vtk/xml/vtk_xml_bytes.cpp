// SPDX-License-Identifier: Apache-2.0
#include "vtk_xml_bytes.h"

#include <algorithm>

#include "vtk_xml_numbers.h"

namespace pellucid {

namespace {

/// Nothing of a file is larger, and sums of it hold.
constexpr std::uint64_t most = std::uint64_t{1} << 40;

int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Returns the bytes that are in base64 at the beginning of a text; a header may be padded by
/// itself.
std::uint64_t decoded_size(std::string_view text) {
  std::uint64_t characters = 0, padding = 0;
  for (const char c : text) {
    if (sextet(c) < 0 && c != '=') break;
    ++characters;
    padding += c == '=' ? 1 : 0;
  }
  return characters / 4 * 3 - std::min(padding, characters / 4 * 3);
}

}  // namespace

VtkXmlBytes::VtkXmlBytes(std::string_view text, bool base64)
    : text_(base64 ? without_blanks(text) : text),
      base64_(base64),
      size_(base64 ? decoded_size(text_) : text_.size()) {}

std::uint64_t VtkXmlBytes::available(const VtkXmlCoding& coding) const {
  return size_ - std::min(size_, coding.header_size);
}

std::optional<std::uint64_t> VtkXmlBytes::said(const VtkXmlCoding& coding) const {
  if (!coding.compressed) return number(0, coding);
  const auto blocks = number(0, coding), block = number(1, coding), last = number(2, coding);
  if (blocks == 0) return 0;
  if (!blocks || !block || !last || *block > most || *last > most) return std::nullopt;
  if (*blocks > most / std::max(*block, std::uint64_t{1})) return std::nullopt;
  return *last == 0 ? *blocks * *block : (*blocks - 1) * *block + *last;
}

bool VtkXmlBytes::is_filled(const VtkXmlCoding& coding) const {
  const auto stored = stored_bytes(coding);
  if (!stored) return false;
  if (base64_) return *stored == size_;
  return *stored <= size_ && without_blanks(text_.substr(*stored)).empty();
}

std::optional<std::uint64_t> VtkXmlBytes::stored_bytes(const VtkXmlCoding& coding) const {
  const auto first = number(0, coding);
  if (!first || *first > size_) return std::nullopt;
  if (!coding.compressed) return coding.header_size + *first;
  constexpr std::uint64_t others = 3;
  std::uint64_t stored = (others + *first) * coding.header_size;
  for (std::uint64_t i = 0; i < *first; ++i) {
    const auto bytes = number(others + i, coding);
    if (!bytes || *bytes > size_) return std::nullopt;
    stored += *bytes;
  }
  return stored;
}

std::optional<std::uint64_t> VtkXmlBytes::number(std::uint64_t index,
                                                 const VtkXmlCoding& coding) const {
  std::uint64_t value = 0;
  for (std::uint64_t i = 0; i < coding.header_size; ++i) {
    const std::uint64_t place = coding.big_endian ? i : coding.header_size - 1 - i;
    const auto byte = this->byte(index * coding.header_size + place);
    if (!byte) return std::nullopt;
    value = value << 8 | *byte;
  }
  return value;
}

std::optional<std::uint64_t> VtkXmlBytes::byte(std::uint64_t at) const {
  if (!base64_) {
    if (at >= text_.size()) return std::nullopt;
    return static_cast<unsigned char>(text_[at]);
  }
  const std::uint64_t first = at / 3 * 4;
  if (first + 4 > text_.size()) return std::nullopt;
  std::uint64_t bits = 0;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const int six = text_[first + i] == '=' && i > at % 3 + 1 ? 0 : sextet(text_[first + i]);
    if (six < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint64_t>(six);
  }
  return bits >> 8 * (2 - at % 3) & 0xff;
}

}  // namespace pellucid
