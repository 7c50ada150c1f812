// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "volumes/volume_source.h"

namespace pellucid {

/// Group and element: 0xggggeeee.
using DicomTag = std::uint32_t;

/// The elements of a data set that matter for volumes (DICOM PS3.6), and no others.
struct DicomDataSet {
  bool big_endian = false;
  std::map<DicomTag, std::string> values;  ///< as they stand in the file
  std::map<DicomTag, std::vector<DicomDataSet>> sequences;

  /// Returns the text without the blanks around it, and with ? in the place of what is not ASCII;
  /// empty where there is none.
  std::string text(DicomTag tag) const;
  /// Numbers written as text (DS, IS), between backslashes; empty where there is none or one of
  /// them is no finite number.
  std::vector<double> decimals(DicomTag tag) const;
  /// Returns numbers of eight bytes (FD); empty where there is none or one is not finite.
  std::vector<double> reals(DicomTag tag) const;
  /// Returns a number of two bytes (US).
  std::optional<int> number(DicomTag tag) const;
  /// Returns all numbers of two bytes (US) of an element; empty where there is none.
  std::vector<int> whole_numbers(DicomTag tag) const;
  /// Returns the tags that an element names (AT); empty where there is none.
  std::vector<DicomTag> tags(DicomTag tag) const;
  /// Returns the first item of a sequence; null where there is none.
  const DicomDataSet* item(DicomTag tag) const;
};

struct DicomFile {
  DicomDataSet data;
  std::string transfer_syntax;
  bool has_pixels = false;
  DicomTag pixel_tag = 0;
  std::uintmax_t pixel_offset = 0, pixel_bytes = 0;
  bool encapsulated = false;  ///< pixels are in fragments, compressed
};

/// Returns whether a file is DICOM by its first bytes: "DICM" behind a preamble of 128 bytes; or,
/// as old devices write, elements of group 2 or 8 at the start, with or without "DICM", or behind a
/// preamble without it.
bool is_dicom(const ByteSource& source);

/// Reads up to the pixels: files of PS3.10, explicit and implicit, of either byte order. Throws
/// Error where a length leads out of what is around it, where compressed pixels are cut off, and
/// for deflated files.
DicomFile parse_dicom(const ByteSource& source);

}  // namespace pellucid
