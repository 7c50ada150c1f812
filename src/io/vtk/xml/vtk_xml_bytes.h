// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace pellucid {

/// Coding of binary arrays in a file of VTK's XML.
struct VtkXmlCoding {
  bool big_endian = false, compressed = false;
  std::uint64_t header_size = 4;  ///< bytes of each number of a header: header_type
};

/// The bytes of one array in binary, as they lie or in base64: a header with their number, and they
/// themselves; if compressed, a header with the number of blocks, the size of a block, that of the
/// last one if it is smaller, and what each takes.
class VtkXmlBytes {
 public:
  /// `text` lasts up to where something else begins; there may be blanks in front of that.
  VtkXmlBytes(std::string_view text, bool base64);

  /// Returns how many bytes of values the header says; nothing where it says no number that can be.
  std::optional<std::uint64_t> said(const VtkXmlCoding& coding) const;

  /// Returns how many bytes of values there can be at most, where they are not compressed.
  std::uint64_t available(const VtkXmlCoding& coding) const;

  /// Returns whether the header and the values that it tells of take all of the text but blanks.
  bool is_filled(const VtkXmlCoding& coding) const;

 private:
  std::optional<std::uint64_t> byte(std::uint64_t at) const;
  std::optional<std::uint64_t> number(std::uint64_t index, const VtkXmlCoding& coding) const;
  std::optional<std::uint64_t> stored_bytes(const VtkXmlCoding& coding) const;

  std::string_view text_;
  bool base64_;
  std::uint64_t size_;  ///< bytes, as they are in memory
};

}  // namespace pellucid
