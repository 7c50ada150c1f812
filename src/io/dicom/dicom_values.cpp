// SPDX-License-Identifier: Apache-2.0
#include "dicom_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "files/memory_limit.h"
#include "pellucid/scene/error.h"
#include "volumes/stored_numbers.h"

namespace pellucid {

namespace {

/// A stored number: the bits that hold it, without what else stands in its bytes.
class StoredValue {
 public:
  explicit StoredValue(const DicomFormat& format) : format_(format) {
    if (format.floating) return;
    shift_ = static_cast<unsigned>(format.high_bit + 1 - format.bits_stored);
    mask_ = (std::uint64_t{1} << format.bits_stored) - 1;
    sign_ = format.is_signed ? std::uint64_t{1} << (format.bits_stored - 1) : 0;
  }

  double of(std::uint64_t bits) const {
    if (format_.floating) {
      return format_.bits_allocated == 32
                 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                 : std::bit_cast<double>(bits);
    }
    const std::uint64_t value = (bits >> shift_) & mask_;
    const auto number = static_cast<std::int64_t>(value);
    return static_cast<double>((value & sign_) != 0 ? number - static_cast<std::int64_t>(mask_) - 1
                                                    : number);
  }

 private:
  const DicomFormat& format_;
  unsigned shift_ = 0;
  std::uint64_t mask_ = 0, sign_ = 0;
};

/// The bytes of one frame after the other, decompressed where they must be.
class FrameReader {
 public:
  /// Throws Error where the frame cannot be read, and of those that GDCM cannot decompress
  /// DamagedDicom with this one.
  std::span<const std::byte> frame(const DicomSlice& slice) {
    const DicomImage& image = *slice.image;
    const std::uintmax_t bytes = dicom_frame_bytes(image.format);
    const std::uintmax_t from = bytes * static_cast<std::uintmax_t>(slice.frame);
    if (image.encapsulated) {
      if (decoded_ != slice.image) {
        pixels_ = decode_dicom(image);
        decoded_ = slice.image;
      }
      if (pixels_ == nullptr) {
        throw DamagedDicom(
            {{image.file, image.file.string() +
                              ": GDCM cannot decompress its pixels to what its header says "
                              "(transfer syntax " +
                              image.transfer_syntax +
                              "); decompress the file with another program, or get it again"}});
      }
      return {pixels_.get() + from, static_cast<std::size_t>(bytes)};
    }
    const ByteSource source = file_source(image.file);
    const std::uintmax_t end = from + bytes;
    if (end > image.pixel_bytes || image.pixel_offset > source.size ||
        end > source.size - image.pixel_offset) {
      throw Error(source.name + ": has " + std::to_string(image.pixel_bytes) +
                  " bytes of pixels, but its header needs " + std::to_string(end) +
                  "; it is cut off or its header is wrong");
    }
    bytes_.resize(bytes);
    source.read(image.pixel_offset + from, bytes_);
    return bytes_;
  }

 private:
  std::vector<std::byte> bytes_;
  std::shared_ptr<const DicomImage> decoded_;
  std::shared_ptr<const std::byte> pixels_;  ///< of it
};

template <std::size_t size>
std::uint64_t bits_at(const std::byte* bytes, bool swapped) {
  std::array<std::byte, size> raw;
  std::memcpy(raw.data(), bytes, size);
  if (swapped) std::ranges::reverse(raw);
  using Bits = std::conditional_t<
      size == 1, std::uint8_t,
      std::conditional_t<size == 2, std::uint16_t,
                         std::conditional_t<size == 4, std::uint32_t, std::uint64_t>>>;
  return std::bit_cast<Bits>(raw);
}

/// Converts one component of a frame.
template <std::size_t size, class Value>
void convert(std::span<const std::byte> frame, const DicomSlice& slice, int component,
             std::span<Value> to) {
  const DicomImage& image = *slice.image;
  const StoredValue stored(image.format);
  // GDCM gives values in this machine's order.
  const bool swapped =
      !image.encapsulated && image.big_endian == (std::endian::native == std::endian::little);
  const bool planes = image.format.plane_by_plane && !image.encapsulated;
  const auto samples = static_cast<std::size_t>(image.format.samples);
  const auto c = static_cast<std::size_t>(component);
  const std::size_t first = planes ? c * to.size() : c, stride = planes ? 1 : samples;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const std::uint64_t bits = bits_at<size>(&frame[(first + i * stride) * size], swapped);
    to[i] = static_cast<Value>(slice.slope * stored.of(bits) + slice.intercept);
  }
}

template <class Value>
void convert(std::span<const std::byte> frame, const DicomSlice& slice, int component,
             std::span<Value> to) {
  switch (slice.image->format.bits_allocated) {
    case 8:
      return convert<1>(frame, slice, component, to);
    case 16:
      return convert<2>(frame, slice, component, to);
    case 32:
      return convert<4>(frame, slice, component, to);
    default:
      return convert<8>(frame, slice, component, to);
  }
}

}  // namespace

std::string dicom_value_type(const std::vector<DicomSlice>& slices, const std::string& name) {
  const DicomSlice& any = slices.front();
  const DicomFormat& format = any.image->format;
  bool same = true;
  for (const DicomSlice& slice : slices) {
    if (slice.slope == 0) {
      throw Error(name + ": the rescale slope of " + slice.name() + " is 0; mend its header");
    }
    same = same && slice.slope == any.slope && slice.intercept == any.intercept;
  }
  const bool as_stored = same && any.slope == 1 && any.intercept == std::floor(any.intercept);
  if (format.floating) {
    // What a float is scaled to is as good as the float.
    return format.bits_allocated == 32 ? "f32" : "f64";
  }
  if (as_stored) {
    const double values = std::exp2(format.bits_stored);
    const double lowest = (format.is_signed ? -values / 2 : 0) + any.intercept;
    const double highest = lowest + values - 1;
    const auto bytes = static_cast<std::size_t>(format.bits_allocated / 8);
    if (const auto type = whole_type_for(lowest, highest, bytes)) return *type;
  }
  return format.bits_allocated <= 16 ? "f32" : "f64";
}

std::vector<VolumeData> read_dicom_values(const std::vector<DicomSlice>& slices,
                                          ComponentRange range, const std::string& name) {
  const std::string type = dicom_value_type(slices, name);
  const DicomFormat& format = slices.front().image->format;
  const std::size_t per_slice =
      static_cast<std::size_t>(format.columns) * static_cast<std::size_t>(format.rows);
  const std::size_t points = per_slice * slices.size();
  const std::uintmax_t value_bytes =
      std::uintmax_t{points} * static_cast<std::uintmax_t>(range.number) * value_size(type, name);
  check_memory(value_bytes + dicom_frame_bytes(format), name + ": its values");
  std::vector<VolumeData> list;
  list.reserve(static_cast<std::size_t>(range.number));
  for (int c = 0; c < range.number; ++c) list.push_back(make_values(type, points, name));
  FrameReader reader;
  std::vector<DamagedDicomFile> damaged;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    std::span<const std::byte> frame;
    try {
      frame = reader.frame(slices[k]);
    } catch (const DamagedDicom& error) {
      // Found out for all files at once: they are left out, and the others are read again.
      if (damaged.empty() || damaged.back().file != error.files().front().file) {
        damaged.push_back(error.files().front());
      }
      continue;
    }
    for (int c = 0; c < range.number; ++c) {
      std::visit(
          [&](auto& values) {
            convert(frame, slices[k], range.first + c,
                    values.writable().subspan(k * per_slice, per_slice));
          },
          list[static_cast<std::size_t>(c)]);
    }
  }
  if (!damaged.empty()) throw DamagedDicom(std::move(damaged));
  return list;
}

}  // namespace pellucid
