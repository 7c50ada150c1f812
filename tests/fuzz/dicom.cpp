// SPDX-License-Identifier: Apache-2.0

// The parser of DICOM's elements, and what places frames: any bytes give elements that stand in
// them, or an Error of one line.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "pellucid/scene/error.h"
#include "src/io/dicom/dicom_elements.h"
#include "src/io/dicom/dicom_frames.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

std::size_t bytes_in(const pellucid::DicomDataSet& set) {
  std::size_t bytes = 0;
  for (const auto& [tag, value] : set.values) {
    bytes += value.size();
    for (const char c : set.text(tag)) require(c >= ' ' && c <= '~');
    for (const double number : set.decimals(tag)) require(number - number == 0);
    set.number(tag);
  }
  for (const auto& [tag, items] : set.sequences) {
    for (const pellucid::DicomDataSet& item : items) bytes += bytes_in(item);
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  const pellucid::ByteSource source = pellucid::memory_source(bytes, "fuzz");
  try {
    pellucid::is_dicom(source);
    const pellucid::DicomFile file = pellucid::parse_dicom(source);
    require(bytes_in(file.data) <= size);
    constexpr int frames = 3;
    const auto places = pellucid::dicom_frame_offsets(file.data, frames, {0, 0, 1}, {});
    require(places.refused.empty() == (places.offset.size() == frames));
    if (file.has_pixels) {
      require(file.pixel_offset <= size && file.pixel_bytes <= size - file.pixel_offset);
    }
  } catch (const pellucid::Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz: ") && message.size() < 1000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
  return 0;
}
