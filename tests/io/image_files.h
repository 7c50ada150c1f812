// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "volume_files.h"

// Images written byte by byte from TIFF 6.0 and the PNG specification, by nothing that reads them.
namespace pellucid::test {

/// By default 5 × 4 values of u16 in one strip.
struct TiffPage {
  std::map<std::uint16_t, std::vector<std::uint32_t>> fields{
      {256, {5}}, {257, {4}}, {258, {16}}, {259, {1}}, {262, {1}}, {277, {1}}, {278, {4}}};
  std::map<std::uint16_t, double> rationals;
  std::string description;
  std::map<std::uint16_t, std::string> texts;    // ASCII
  std::map<std::uint16_t, std::string> records;  // bytes without a meaning
  std::vector<std::string> strips;               // as they are to stand in the file
  bool tiled = false;
};

class TiffFile {
 public:
  explicit TiffFile(bool big_endian) : big_endian_(big_endian) {
    bytes_ = big_endian ? "MM" : "II";
    bytes_ += number(42, 2) + number(0, 4);
  }

  void add(const TiffPage& page) {
    std::map<std::uint16_t, Entry> entries;
    for (const auto& [tag, values] : page.fields) {
      Entry entry{4, static_cast<std::uint32_t>(values.size()), ""};
      for (const std::uint32_t value : values) entry.bytes += number(value, 4);
      entries[tag] = entry;
    }
    for (const auto& [tag, value] : page.rationals) {
      const auto millionths = static_cast<std::uint64_t>(value * 1e6 + 0.5);
      entries[tag] = {5, 1, number(millionths, 4) + number(1000000, 4)};
    }
    if (!page.description.empty()) {
      const auto size = static_cast<std::uint32_t>(page.description.size() + 1);
      entries[270] = {2, size, page.description + '\0'};
    }
    for (const auto& [tag, text] : page.texts) {
      entries[tag] = {2, static_cast<std::uint32_t>(text.size() + 1), text + '\0'};
    }
    for (const auto& [tag, bytes] : page.records) {
      entries[tag] = {7, static_cast<std::uint32_t>(bytes.size()), bytes};
    }
    Entry offsets{4, 0, ""}, sizes{4, 0, ""};
    for (const std::string& strip : page.strips) {
      offsets.bytes += number(bytes_.size(), 4);
      sizes.bytes += number(strip.size(), 4);
      ++offsets.count, ++sizes.count;
      bytes_ += strip;
      if (bytes_.size() % 2 != 0) bytes_ += '\0';
    }
    entries[page.tiled ? 324 : 273] = offsets;
    entries[page.tiled ? 325 : 279] = sizes;
    std::string directory = number(entries.size(), 2);
    for (auto& [tag, entry] : entries) {
      if (entry.bytes.size() > 4) {
        const std::size_t at = bytes_.size();
        bytes_ += entry.bytes;
        if (bytes_.size() % 2 != 0) bytes_ += '\0';
        entry.bytes = number(at, 4);
      }
      entry.bytes.resize(4, '\0');
      directory += number(tag, 2) + number(entry.type, 2) + number(entry.count, 4) + entry.bytes;
    }
    bytes_.replace(link_, 4, number(bytes_.size(), 4));
    link_ = bytes_.size() + directory.size();
    bytes_ += directory + number(0, 4);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  struct Entry {
    std::uint16_t type = 4;
    std::uint32_t count = 1;
    std::string bytes;
  };
  std::string number(std::uint64_t value, std::size_t size) const {
    std::string bytes;
    for (std::size_t i = 0; i < size; ++i) {
      bytes += static_cast<char>(value >> 8 * (big_endian_ ? size - 1 - i : i));
    }
    return bytes;
  }

  bool big_endian_;
  std::string bytes_;
  std::size_t link_ = 4;  // where the offset of the next directory goes
};

/// Values 20 k … 20 k + 19 of `counting`, as they are to stand in the file.
template <class Value>
std::string page_values(int k, bool big_endian = false) {
  std::vector<Value> values(20);
  for (std::size_t i = 0; i < 20; ++i) {
    values[i] = static_cast<Value>(static_cast<std::size_t>(20 * k) + i);
  }
  return big_endian ? swapped_bytes_of(values) : bytes_of(values);
}

inline std::string tiff(const TiffPage& page, bool big_endian = false) {
  TiffFile file(big_endian);
  file.add(page);
  return file.bytes();
}

/// A page of `counting`.
template <class Value>
TiffPage counting_page(int k, std::uint32_t sample_format, bool big_endian = false) {
  TiffPage page;
  page.fields[258] = {8 * sizeof(Value)};
  page.fields[339] = {sample_format};
  page.strips = {page_values<Value>(k, big_endian)};
  return page;
}

/// A PNG of rows without a filter, `values` as they are to stand in the file.
inline std::string png(std::uint32_t columns, std::uint32_t rows, int bits, int color,
                       const std::string& values, int interlaced = 0,
                       const std::string& physical = "", const std::string& transparent = "",
                       const std::vector<std::pair<std::string, std::string>>& chunks = {}) {
  const auto word = [](std::uint64_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
    return bytes;
  };
  const auto chunk = [&](const std::string& type, const std::string& content) {
    const std::string both = type + content;
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(both.data()), static_cast<uInt>(both.size()));
    return word(content.size()) + both + word(crc);
  };
  const std::size_t row = rows == 0 ? 0 : values.size() / rows;
  std::string filtered;
  for (std::size_t y = 0; y < rows && row > 0; ++y) filtered += '\0' + values.substr(y * row, row);
  const std::string header = word(columns) + word(rows) + static_cast<char>(bits) +
                             static_cast<char>(color) + '\0' + '\0' + static_cast<char>(interlaced);
  std::string more;
  for (const auto& [type, content] : chunks) more += chunk(type, content);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) +
         (physical.empty() ? "" : chunk("pHYs", physical)) +
         (transparent.empty() ? "" : chunk("tRNS", transparent)) + more +
         chunk("IDAT", deflated(filtered, 15)) + chunk("IEND", "");
}

/// A file of so many pages of `counting`, page k from 20 k on, whose first is described so.
inline std::string described_tiff(int pages, const std::string& description,
                                  const std::vector<int>& order = {}) {
  TiffFile file(false);
  for (int k = 0; k < pages; ++k) {
    TiffPage page =
        counting_page<std::uint16_t>(order.empty() ? k : order[static_cast<std::size_t>(k)], 1);
    if (k == 0) page.description = description;
    file.add(page);
  }
  return file.bytes();
}

/// OME-XML of one image of 5 × 4 pixels. `sizes` are SizeZ, SizeC and SizeT.
inline std::string ome_xml(const std::array<int, 3>& sizes, const std::string& inside,
                           const std::string& attributes = "", const std::string& order = "XYZCT") {
  const auto size = [&](char letter, std::size_t i) {
    return std::string(" Size") + letter + "=\"" + std::to_string(sizes[i]) + "\"";
  };
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?><OME xmlns=\"http://www.openmicroscopy.org/"
         "Schemas/OME/2016-06\" UUID=\"urn:uuid:own\"><Image ID=\"Image:0\" Name=\"first\"><Pixels "
         "ID=\"Pixels:0\" Type=\"uint16\" DimensionOrder=\"" +
         order + "\" SizeX=\"5\" SizeY=\"4\"" + size('Z', 0) + size('C', 1) + size('T', 2) + " " +
         attributes + ">" + inside + "</Pixels></Image></OME>";
}

/// Which page of `described_tiff` stands at each slice, component by component: "0 1 2, 3 4 5".
inline std::string page_order(const std::vector<Volume>& components) {
  std::string text;
  for (const Volume& volume : components) {
    text += text.empty() ? "" : ", ";
    for (int z = 0; z < volume.description().dimensions[2]; ++z) {
      // The last value tells whether the page is whole.
      const double first = value_at(volume, 0, 0, z), last = value_at(volume, 4, 3, z);
      EXPECT_EQ(first + 19, last);
      text += (z == 0 ? "" : " ") + std::to_string(static_cast<int>(first) / 20);
    }
  }
  return text;
}

}  // namespace pellucid::test
