// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"
#include "scratch_folder.h"

// Files of every format written byte by byte from the formats' descriptions, by nothing that the
// library reads them with.
namespace pellucid::test {

/// 5 × 4 × 3 values 0, 1, …, 59, x fastest.
template <class Value = float>
std::vector<Value> counting() {
  std::vector<Value> values(60);
  for (std::size_t i = 0; i < 60; ++i) values[i] = static_cast<Value>(i);
  return values;
}

/// The same as IEEE 754 half floats: 0 … 59 need neither rounding nor small exponents.
inline std::vector<std::uint16_t> counting_halves() {
  std::vector<std::uint16_t> values;
  for (const float number : counting()) {
    const auto bits = std::bit_cast<std::uint32_t>(number);
    values.push_back(static_cast<std::uint16_t>(
        number == 0 ? 0U : ((bits >> 23) - 127 + 15) << 10 | (bits >> 13 & 1023)));
  }
  return values;
}

/// All of it compressed: window_bits 15 for zlib, 31 for gzip.
inline std::string deflated(const std::string& bytes, int window_bits) {
  z_stream state{};
  deflateInit2(&state, 9, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&state, bytes.size()) + 64, '\0');
  std::string in = bytes;
  state.next_in = reinterpret_cast<Bytef*>(in.data());
  state.avail_in = static_cast<uInt>(in.size());
  state.next_out = reinterpret_cast<Bytef*>(out.data());
  state.avail_out = static_cast<uInt>(out.size());
  deflate(&state, Z_FINISH);
  out.resize(state.total_out);
  deflateEnd(&state);
  return out;
}
inline std::string gzipped(const std::string& bytes) {
  return deflated(bytes, 31);
}

/// A NIfTI-1 header field by field; defaults are those of a plain float file.
struct NiftiFile {
  std::array<std::int16_t, 8> dim{3, 5, 4, 3, 1, 1, 1, 1};
  std::int16_t datatype = 16, bitpix = 32;
  std::array<float, 8> pixdim{1, 1, 2, 3, 1, 1, 1, 1};
  float vox_offset = 352, slope = 0, intercept = 0;
  char units = 2;  // millimetres
  std::int16_t qform_code = 0, sform_code = 0;
  std::array<float, 6> qform{};   // quaternion b, c, d, offset x, y, z
  std::array<float, 12> sform{};  // three rows
  std::string magic{"n+1\0", 4};
  std::int32_t size = 348;
  bool big_endian = false;

  template <class Value>
  void put(std::string& bytes, std::size_t offset, Value value) const {
    char raw[sizeof(Value)];
    std::memcpy(raw, &value, sizeof(Value));
    if (big_endian) std::reverse(raw, raw + sizeof(Value));
    bytes.replace(offset, sizeof(Value), raw, sizeof(Value));
  }

  std::string header() const {
    std::string bytes(348, '\0');
    put(bytes, 0, size);
    for (std::size_t i = 0; i < 8; ++i) put(bytes, 40 + 2 * i, dim[i]);
    put(bytes, 70, datatype);
    put(bytes, 72, bitpix);
    for (std::size_t i = 0; i < 8; ++i) put(bytes, 76 + 4 * i, pixdim[i]);
    put(bytes, 108, vox_offset);
    put(bytes, 112, slope);
    put(bytes, 116, intercept);
    bytes[123] = units;
    put(bytes, 252, qform_code);
    put(bytes, 254, sform_code);
    for (std::size_t i = 0; i < 6; ++i) put(bytes, 256 + 4 * i, qform[i]);
    for (std::size_t i = 0; i < 12; ++i) put(bytes, 280 + 4 * i, sform[i]);
    bytes.replace(344, 4, magic);
    return bytes;
  }
  /// Header, the four bytes of the extension flag, values.
  std::string with(const std::string& values) const {
    return header() + std::string(4, '\0') + values;
  }
};

/// A NIfTI-2 header field by field; defaults are those of a plain float file.
struct NiftiTwoFile {
  std::array<std::int64_t, 8> dim{3, 5, 4, 3, 1, 1, 1, 1};
  std::int16_t datatype = 16, bitpix = 32;
  std::array<double, 8> pixdim{1, 1, 2, 3, 1, 1, 1, 1};
  std::int64_t vox_offset = 544;
  double slope = 0, intercept = 0;
  std::int32_t units = 2, intent = 0;
  std::int32_t qform_code = 0, sform_code = 0;
  std::array<double, 6> qform{};
  std::array<double, 12> sform{};
  std::string magic{"n+2\0\r\n\x1a\n", 8};
  bool big_endian = false;

  template <class Value>
  void put(std::string& bytes, std::size_t offset, Value value) const {
    NiftiFile order;
    order.big_endian = big_endian;
    order.put(bytes, offset, value);
  }
  std::string header() const {
    std::string bytes(540, '\0');
    put(bytes, 0, std::int32_t{540});
    bytes.replace(4, 8, magic);
    put(bytes, 12, datatype);
    put(bytes, 14, bitpix);
    for (std::size_t i = 0; i < 8; ++i) put(bytes, 16 + 8 * i, dim[i]);
    for (std::size_t i = 0; i < 8; ++i) put(bytes, 104 + 8 * i, pixdim[i]);
    put(bytes, 168, vox_offset);
    put(bytes, 176, slope);
    put(bytes, 184, intercept);
    put(bytes, 344, qform_code);
    put(bytes, 348, sform_code);
    for (std::size_t i = 0; i < 6; ++i) put(bytes, 352 + 8 * i, qform[i]);
    for (std::size_t i = 0; i < 12; ++i) put(bytes, 400 + 8 * i, sform[i]);
    put(bytes, 500, units);
    put(bytes, 504, intent);
    return bytes;
  }
  std::string with(const std::string& values) const {
    return header() + std::string(4, '\0') + values;
  }
};

/// A header of FreeSurfer's MGH field by field; defaults are those of a plain float file.
struct MghFile {
  std::int32_t version = 1;
  std::array<std::int32_t, 4> dimensions{5, 4, 3, 1};  // and frames
  std::int32_t type = 3, dof = 0;
  std::int16_t good_ras = 1;
  std::array<float, 3> delta{1, 2, 3};
  std::array<float, 9> directions{1, 0, 0, 0, 1, 0, 0, 0, 1};  // of x, of y, of z, in RAS
  std::array<float, 3> center{10, 20, 30};

  /// The 284 bytes and the values, which must be big-endian.
  std::string with(const std::string& values) const {
    std::string bytes(284, '\0');
    NiftiFile order;
    order.big_endian = true;
    order.put(bytes, 0, version);
    for (std::size_t i = 0; i < 4; ++i) order.put(bytes, 4 + 4 * i, dimensions[i]);
    order.put(bytes, 20, type);
    order.put(bytes, 24, dof);
    order.put(bytes, 28, good_ras);
    for (std::size_t i = 0; i < 3; ++i) order.put(bytes, 30 + 4 * i, delta[i]);
    for (std::size_t i = 0; i < 9; ++i) order.put(bytes, 42 + 4 * i, directions[i]);
    for (std::size_t i = 0; i < 3; ++i) order.put(bytes, 78 + 4 * i, center[i]);
    return bytes + values;
  }
};

/// The world position of the data value at an index, by the description alone.
inline Vec3<double> world_of(const Volume& volume, int i, int j, int k) {
  const GridPlacement& p = volume.description().placement;
  return p.origin + p.direction.column[0] * (p.spacing.x * i) +
         p.direction.column[1] * (p.spacing.y * j) + p.direction.column[2] * (p.spacing.z * k);
}

inline double value_at(const Volume& volume, int i, int j, int k) {
  return volume.visit(
      [&](const auto& grid) { return static_cast<double>(grid.data[grid.offset(i, j, k)]); });
}

/// Expects the data to be 0 … 59 in this type.
inline void expect_counting(const Volume& volume, const std::string& type) {
  EXPECT_EQ(type_name(volume.data()), type);
  EXPECT_EQ(volume.description().dimensions, (std::array<int, 3>{5, 4, 3}));
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(value_at(volume, i % 5, i / 5 % 4, i / 20), i);
  }
}

inline void expect_near(const Vec3<double>& a, const Vec3<double>& b, double tolerance = 1e-5) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

}  // namespace pellucid::test
