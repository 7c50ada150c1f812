// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

// DICOM files written element by element from PS3.5 and PS3.10, by nothing that reads them.
namespace pellucid::test {

struct DicomWriter {
  bool explicit_types = true, big_endian = false, undefined_lengths = false;

  std::string number(std::uint64_t value, std::size_t size) const {
    std::string bytes;
    for (std::size_t i = 0; i < size; ++i) {
      bytes += static_cast<char>(value >> 8 * (big_endian ? size - 1 - i : i));
    }
    return bytes;
  }
  std::string tag(std::uint32_t tag) const {
    return number(tag >> 16, 2) + number(tag & 0xffff, 2);
  }

  std::string element(std::uint32_t tag_, const std::string& type, std::string value,
                      std::uint32_t length = 0) const {
    if (value.size() % 2 != 0) value += type == "UI" || type == "OB" ? '\0' : ' ';
    if (length == 0) length = static_cast<std::uint32_t>(value.size());
    const bool is_long = type == "OB" || type == "OW" || type == "SQ" || type == "UN" ||
                         type == "OF" || type == "OD" || type == "UT";
    std::string bytes = tag(tag_);
    if (explicit_types) bytes += type + (is_long ? std::string(2, '\0') : "");
    return bytes + number(length, explicit_types && !is_long ? 2 : 4) + value;
  }

  std::string item(const std::string& content) const {
    if (!undefined_lengths) return tag(0xfffee000) + number(content.size(), 4) + content;
    return tag(0xfffee000) + number(0xffffffff, 4) + content + tag(0xfffee00d) + number(0, 4);
  }
  std::string sequence(std::uint32_t tag_, const std::vector<std::string>& items) const {
    std::string content;
    for (const std::string& one : items) content += item(one);
    if (!undefined_lengths) return element(tag_, "SQ", content);
    content += tag(0xfffee0dd) + number(0, 4);
    std::string whole = element(tag_, "SQ", content, 0xffffffff);
    return whole;
  }
};

/// One file: its elements by tag, which may be changed, and what is written of them. By default an
/// axial MR slice of 5 × 4 u16 values of 12 bits.
struct DicomSliceFile {
  std::string syntax = "1.2.840.10008.1.2.1";  // explicit, little-endian
  bool preamble = true, undefined_lengths = false;
  std::map<std::uint32_t, std::pair<std::string, std::string>> text{
      {0x00080016, {"UI", "1.2.840.10008.5.1.4.1.1.4"}},
      {0x00080060, {"CS", "MR"}},
      {0x0008103e, {"LO", "by hand"}},
      {0x00180050, {"DS", "8"}},
      {0x0020000d, {"UI", "1.2.3"}},
      {0x0020000e, {"UI", "1.2.3.4"}},
      {0x00200011, {"IS", "1"}},
      {0x00200013, {"IS", "1"}},
      {0x00200032, {"DS", "10\\20\\30"}},
      {0x00200037, {"DS", "1\\0\\0\\0\\1\\0"}},
      {0x00280004, {"CS", "MONOCHROME2"}},
      {0x00280030, {"DS", "2\\1"}},  // from row to row, from column to column
  };
  std::map<std::uint32_t, std::uint16_t> numbers{
      {0x00280002, 1},  {0x00280010, 4},  {0x00280011, 5}, {0x00280100, 16},
      {0x00280101, 12}, {0x00280102, 11}, {0x00280103, 0}};
  std::map<std::uint32_t, std::vector<std::string>> sequences;  // of items
  std::string pixels;                                           // as they are to stand in the file
  std::string pixel_type = "OW";
  std::uint32_t pixel_tag = 0x7fe00010;
  bool encapsulated = false;

  DicomWriter writer() const {
    DicomWriter w;
    w.explicit_types = syntax != "1.2.840.10008.1.2";
    w.big_endian = syntax == "1.2.840.10008.1.2.2";
    w.undefined_lengths = undefined_lengths;
    return w;
  }

  DicomSliceFile& set(std::uint32_t tag, const std::string& value) {
    if (!text.contains(tag)) text[tag].first = "DS";
    text[tag].second = value;
    return *this;
  }
  DicomSliceFile& set(std::uint32_t tag, int value) {
    numbers[tag] = static_cast<std::uint16_t>(value);
    return *this;
  }
  DicomSliceFile& without(std::uint32_t tag) {
    text.erase(tag);
    numbers.erase(tag);
    return *this;
  }
  DicomSliceFile& at(const std::string& position) { return set(0x00200032, position); }

  std::string header() const {
    const DicomWriter w = writer();
    std::map<std::uint32_t, std::string> elements;
    for (const auto& [tag, value] : text) elements[tag] = w.element(tag, value.first, value.second);
    for (const auto& [tag, value] : numbers) {
      elements[tag] = w.element(tag, "US", w.number(value, 2));
    }
    for (const auto& [tag, items] : sequences) elements[tag] = w.sequence(tag, items);
    std::string bytes;
    for (const auto& [tag, element] : elements) bytes += element;
    return bytes;
  }

  std::string bytes() const {
    const DicomWriter meta;
    const std::string group = meta.element(0x00020010, "UI", syntax);
    std::string whole;
    if (preamble) {
      whole = std::string(128, '\0') + "DICM" +
              meta.element(0x00020000, "UL", meta.number(group.size(), 4)) + group;
    }
    const DicomWriter w = writer();
    whole += header();
    if (encapsulated) {
      return whole + w.element(pixel_tag, "OB", pixels, 0xffffffff);
    }
    return whole + w.element(pixel_tag, pixel_type, pixels);
  }
};

/// Fragments behind an empty table of offsets, as compressed pixels stand in a file.
inline std::string fragments(const std::vector<std::string>& list) {
  const DicomWriter w;
  std::string bytes = w.item("");
  for (std::string one : list) {
    if (one.size() % 2 != 0) one += '\0';
    bytes += w.item(one);
  }
  return bytes + w.tag(0xfffee0dd) + w.number(0, 4);
}

/// PS3.5, annex G: values of 16 bits as two segments of bytes, high ones first, each run-length
/// encoded here by literal runs alone.
inline std::string run_length_encoded(const std::vector<std::uint16_t>& values) {
  std::string segments;
  std::vector<std::size_t> offsets;
  for (const int shift : {8, 0}) {
    offsets.push_back(64 + segments.size());
    for (std::size_t i = 0; i < values.size(); i += 100) {
      const std::size_t count = std::min<std::size_t>(100, values.size() - i);
      segments += static_cast<char>(count - 1);
      for (std::size_t k = i; k < i + count; ++k) {
        segments += static_cast<char>(values[k] >> shift);
      }
    }
    if (segments.size() % 2 != 0) segments += '\0';
  }
  const DicomWriter w;
  std::string header = w.number(2, 4);
  for (const std::size_t offset : offsets) header += w.number(offset, 4);
  header.resize(64, '\0');
  return header + segments;
}

}  // namespace pellucid::test
