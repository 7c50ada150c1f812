// SPDX-License-Identifier: Apache-2.0
#include "nifti_fields.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "files/data_stream.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

constexpr std::int32_t size_of_one = 348, size_of_two = 540;

/// The bytes of a header, and the numbers in them.
class Bytes {
 public:
  Bytes(std::span<const std::byte> bytes, bool big_endian)
      : bytes_(bytes), big_endian_(big_endian) {}

  template <class T>
  T at(std::size_t offset) const {
    std::array<std::byte, sizeof(T)> part;
    std::ranges::copy(bytes_.subspan(offset, sizeof(T)), part.begin());
    if (big_endian_ == (std::endian::native == std::endian::little)) std::ranges::reverse(part);
    return std::bit_cast<T>(part);
  }
  /// Fills an array with numbers of a type, one behind the other.
  template <class T, class To, std::size_t count>
  void fill(std::array<To, count>& to, std::size_t offset) const {
    for (std::size_t i = 0; i < count; ++i) {
      to[i] = static_cast<To>(at<T>(offset + i * sizeof(T)));
    }
  }
  std::string_view text(std::size_t offset, std::size_t length) const {
    return {reinterpret_cast<const char*>(bytes_.data()) + offset, length};
  }

 private:
  std::span<const std::byte> bytes_;
  bool big_endian_;
};

void read_one(const Bytes& bytes, NiftiFields& fields) {
  const std::string_view magic = bytes.text(344, 3);
  fields.single_file = magic == "n+1";
  fields.version = fields.single_file || magic == "ni1" ? NiftiVersion::one : NiftiVersion::analyze;
  bytes.fill<std::int16_t>(fields.dim, 40);
  bytes.fill<float>(fields.pixdim, 76);
  fields.datatype = bytes.at<std::int16_t>(70);
  fields.vox_offset = static_cast<double>(bytes.at<float>(108));
  fields.slope = static_cast<double>(bytes.at<float>(112));
  fields.intercept = static_cast<double>(bytes.at<float>(116));
  if (fields.version == NiftiVersion::analyze) {
    const auto differ = [&](auto type, std::size_t offset) {
      using T = decltype(type);
      return bytes.at<T>(offset) != bytes.at<T>(offset + sizeof(T));
    };
    fields.has_ranges = differ(std::int32_t{}, 140) && differ(float{}, 124);
    fields.orient = bytes.at<std::int8_t>(252);
    bytes.fill<std::int16_t>(fields.origin, 253);
    return;
  }
  fields.intent = bytes.at<std::int16_t>(68);
  fields.time_offset = static_cast<double>(bytes.at<float>(136));
  fields.units = bytes.at<std::uint8_t>(123);
  fields.qform_code = bytes.at<std::int16_t>(252);
  fields.sform_code = bytes.at<std::int16_t>(254);
  bytes.fill<float>(fields.qform, 256);
  bytes.fill<float>(fields.sform, 280);
}

void read_two(const Bytes& bytes, const std::string& name, NiftiFields& fields) {
  const std::string_view magic = bytes.text(4, 8);
  fields.version = NiftiVersion::two;
  fields.single_file = magic.starts_with("n+2");
  if (!fields.single_file && !magic.starts_with("ni2")) {
    throw Error(name + ": does not begin like a NIfTI-2 file; its mark \"n+2\" is missing");
  }
  // Bytes that a transfer as text would have changed, as in PNG.
  if (magic.substr(3) != std::string_view("\0\r\n\x1a\n", 5)) {
    throw Error(name + ": the mark of NIfTI-2 is damaged; the file was sent as text");
  }
  fields.datatype = bytes.at<std::int16_t>(12);
  bytes.fill<std::int64_t>(fields.dim, 16);
  bytes.fill<double>(fields.pixdim, 104);
  fields.vox_offset = static_cast<double>(bytes.at<std::int64_t>(168));
  fields.time_offset = bytes.at<double>(216);
  fields.slope = bytes.at<double>(176);
  fields.intercept = bytes.at<double>(184);
  fields.qform_code = bytes.at<std::int32_t>(344);
  fields.sform_code = bytes.at<std::int32_t>(348);
  bytes.fill<double>(fields.qform, 352);
  bytes.fill<double>(fields.sform, 400);
  fields.units = bytes.at<std::int32_t>(500);
  fields.intent = bytes.at<std::int32_t>(504);
}

}  // namespace

NiftiFields read_nifti_fields(const std::filesystem::path& path) {
  const std::string name = path.string();
  DataStream stream(
      path, 0, is_gzip(path) ? DataStream::Compression::deflate : DataStream::Compression::none);
  std::vector<std::byte> bytes(size_of_one);
  stream.read(bytes);
  for (const bool big_endian : {false, true}) {
    const std::int32_t size = Bytes(bytes, big_endian).at<std::int32_t>(0);
    if (size != size_of_one && size != size_of_two) continue;
    if (size == size_of_two) {
      bytes.resize(size_of_two);
      stream.read(std::span(bytes).subspan(size_of_one));
    }
    NiftiFields fields;
    fields.big_endian = big_endian;
    if (size == size_of_two) {
      read_two(Bytes(bytes, big_endian), name, fields);
    } else {
      read_one(Bytes(bytes, big_endian), fields);
    }
    return fields;
  }
  throw Error(name + ": does not begin like a NIfTI file");
}

}  // namespace pellucid
