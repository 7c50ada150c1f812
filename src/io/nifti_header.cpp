// SPDX-License-Identifier: Apache-2.0
#include "nifti_header.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

#include "data_stream.h"
#include "input_file.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

constexpr std::size_t header_size = 348;
using HeaderBytes = std::array<std::byte, header_size>;

template <class T>
T number_at(const HeaderBytes& bytes, std::size_t offset, bool big_endian) {
  std::array<std::byte, sizeof(T)> part;
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(T), part.begin());
  if (big_endian == (std::endian::native == std::endian::little)) std::ranges::reverse(part);
  return std::bit_cast<T>(part);
}

// Colors of three and four bytes.
constexpr int rgb_code = 128, rgba_code = 2304;

std::string type_of(int code, const std::string& name) {
  switch (code) {
    case 2:
    case rgb_code:
    case rgba_code:
      return "u8";
    case 4:
      return "i16";
    case 8:
      return "i32";
    case 16:
      return "f32";
    case 64:
      return "f64";
    case 256:
      return "i8";
    case 512:
      return "u16";
    case 768:
      return "u32";
    case 1024:
      return "i64";
    case 1280:
      return "u64";
    case 32:
    case 1792:
    case 2048:
      throw Error(name + ": complex numbers are not read; save their magnitude or one part");
    default:
      throw Error(name + ": NIfTI data type " + std::to_string(code) +
                  " is not read; convert the file to float");
  }
}

std::array<std::int64_t, 3> dimensions_of(const HeaderBytes& bytes, bool big_endian,
                                          const std::string& name) {
  const auto dim = [&](std::size_t i) -> std::int64_t {
    return number_at<std::int16_t>(bytes, 40 + 2 * i, big_endian);
  };
  if (dim(0) < 1 || dim(0) > 7) {
    throw Error(name + ": the NIfTI header says " + std::to_string(dim(0)) +
                " axes; it is damaged");
  }
  if (dim(0) < 3) {
    throw Error(name + ": an image of " + std::to_string(dim(0)) +
                " axes is not read; a volume has three");
  }
  return {dim(1), dim(2), dim(3)};
}

// Colors, or one of the axes behind the third.
void find_components(const HeaderBytes& bytes, bool big_endian, const std::string& name,
                     NiftiHeader& header) {
  const int code = number_at<std::int16_t>(bytes, 70, big_endian);
  if (code == rgb_code || code == rgba_code) {
    header.layout.components = code == rgb_code ? 3 : 4;
    header.layout.interleaved = true;
    header.holds = code == rgb_code ? "colors (RGB)" : "colors (RGBA)";
  }
  const int axes = number_at<std::int16_t>(bytes, 40, big_endian);
  // nifti1.h: matrices, vectors and the like, but for the series among them.
  const int intent = number_at<std::int16_t>(bytes, 68, big_endian);
  const bool vectors = intent > 1003 && intent != 2001;
  for (int a = 4; a <= axes; ++a) {
    const int n = number_at<std::int16_t>(bytes, 40 + 2 * static_cast<std::size_t>(a), big_endian);
    if (n == 1) continue;
    const std::string holds = std::to_string(n) +
                              (a == 4 && !vectors ? " time steps" : " components") + " (axis " +
                              std::to_string(a) + ")";
    if (n < 1) throw Error(name + ": the NIfTI header says " + holds + "; it is damaged");
    if (header.layout.components > 1) {
      throw Error(name + ": holds " + header.holds + " and " + holds +
                  "; save one of these as a file of its own");
    }
    header.layout.components = n;
    header.holds = holds;
  }
}

std::uintmax_t offset_of(float offset, bool single_file, const std::string& name) {
  // nifti1.h: in one file the values begin after the header and its four bytes of extension flag.
  const float smallest = single_file ? 352 : 0;
  if (single_file && offset == 0) return 352;
  if (!(offset >= smallest) || !(offset < 0x1p53F) || offset != std::floor(offset)) {
    throw Error(name + ": the NIfTI header says that the values begin at byte " +
                std::to_string(offset) + "; it is damaged");
  }
  return static_cast<std::uintmax_t>(offset);
}

std::optional<GridPlacement> sform_of(const HeaderBytes& bytes, bool big_endian) {
  if (number_at<std::int16_t>(bytes, 254, big_endian) <= 0) return std::nullopt;
  double m[3][4];
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const double sign = row < 2 ? -1 : 1;  // left and posterior instead of right and anterior
      m[row][column] = sign * static_cast<double>(
                                  number_at<float>(bytes, 280 + 16 * row + 4 * column, big_endian));
    }
  }
  GridPlacement placement;
  placement.origin = {m[0][3], m[1][3], m[2][3]};
  for (int a = 0; a < 3; ++a) {
    const Vec3<double> axis{m[0][a], m[1][a], m[2][a]};
    placement.spacing[a] = length(axis);
    placement.direction.column[a] = axis * (1 / placement.spacing[a]);
  }
  return placement;
}

// nifti1.h, method 2: a rotation as a quaternion of positive a, and a flip of z.
std::optional<GridPlacement> qform_of(const HeaderBytes& bytes, bool big_endian) {
  if (number_at<std::int16_t>(bytes, 252, big_endian) <= 0) return std::nullopt;
  const auto number = [&](std::size_t offset) {
    return static_cast<double>(number_at<float>(bytes, offset, big_endian));
  };
  double b = number(256), c = number(260), d = number(264);
  // Rounding may leave (b, c, d) longer than 1: half a turn then, as nifti1_io.c has it.
  const double length = std::sqrt(b * b + c * c + d * d);
  const double a = std::sqrt(std::max(0.0, 1 - length * length));
  if (length > 1) {
    b /= length;
    c /= length;
    d /= length;
  }
  const double flip = number(76) < 0 ? -1 : 1;
  GridPlacement placement;
  // Left and posterior instead of right and anterior.
  placement.origin = {-number(268), -number(272), number(276)};
  placement.spacing = {number(80), number(84), number(88)};
  placement.direction.column[0] = {-(a * a + b * b - c * c - d * d), -2 * (b * c + a * d),
                                   2 * (b * d - a * c)};
  placement.direction.column[1] = {-2 * (b * c - a * d), -(a * a + c * c - b * b - d * d),
                                   2 * (c * d + a * b)};
  placement.direction.column[2] =
      Vec3<double>{-2 * (b * d + a * c), -2 * (c * d - a * b), a * a + d * d - b * b - c * c} *
      flip;
  return placement;
}

void check_orientation(const HeaderBytes& bytes, bool big_endian, const std::string& name) {
  const auto check = [&](std::size_t offset, std::size_t count, const char* what) {
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isfinite(number_at<float>(bytes, offset + 4 * i, big_endian))) continue;
      throw Error(name + ": the " + what + " of the NIfTI header is not finite; mend the header");
    }
  };
  check(76, 4, "spacing (pixdim)");
  if (number_at<std::int16_t>(bytes, 252, big_endian) > 0) check(256, 6, "qform");
  if (number_at<std::int16_t>(bytes, 254, big_endian) > 0) check(280, 12, "sform");
}

}  // namespace

NiftiHeader read_nifti_header(const std::filesystem::path& path) {
  const std::string name = path.string();
  HeaderBytes bytes;
  DataStream(path, 0,
             is_gzip(path) ? DataStream::Compression::deflate : DataStream::Compression::none)
      .read(bytes);
  const bool big_endian = number_at<std::int32_t>(bytes, 0, true) == header_size;
  if (!big_endian && number_at<std::int32_t>(bytes, 0, false) != header_size) {
    for (const bool order : {false, true}) {
      if (number_at<std::int32_t>(bytes, 0, order) != 540) continue;
      throw Error(name + ": NIfTI-2 is not read; convert the file to NIfTI-1");
    }
    throw Error(name + ": does not begin like a NIfTI file");
  }
  const std::string_view magic(reinterpret_cast<const char*>(bytes.data()) + 344, 3);
  if (magic != "n+1" && magic != "ni1") {
    throw Error(name +
                ": an Analyze 7.5 file, which does not say how it lies in space; convert it "
                "to NIfTI");
  }
  check_orientation(bytes, big_endian, name);
  NiftiHeader header;
  header.single_file = magic == "n+1";
  header.dimensions = dimensions_of(bytes, big_endian, name);
  header.layout = {type_of(number_at<std::int16_t>(bytes, 70, big_endian), name), big_endian,
                   offset_of(number_at<float>(bytes, 108, big_endian), header.single_file, name)};
  find_components(bytes, big_endian, name, header);
  const double slope = static_cast<double>(number_at<float>(bytes, 112, big_endian));
  const double intercept = static_cast<double>(number_at<float>(bytes, 116, big_endian));
  // nifti1.h: a slope of 0 means none, and colors have none; writers leave NaN where they mean
  // none, too.
  if (!header.layout.interleaved && std::isfinite(slope) && slope != 0 &&
      std::isfinite(intercept)) {
    header.slope = slope;
    header.intercept = intercept;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    header.spacing[a] = static_cast<double>(number_at<float>(bytes, 80 + 4 * a, big_endian));
  }
  const int unit_code = std::to_integer<int>(bytes[123]) & 7;
  header.unit = unit_code == 1 ? 1e3 : unit_code == 3 ? 1e-3 : 1;
  header.sform = sform_of(bytes, big_endian);
  header.sform_code = number_at<std::int16_t>(bytes, 254, big_endian);
  header.qform = qform_of(bytes, big_endian);
  return header;
}

NiftiFiles find_nifti_files(const std::filesystem::path& path) {
  std::string name = path.string();
  const auto ends_with = [&](std::string_view extension) {
    if (name.size() < extension.size()) return false;
    return std::ranges::equal(name.substr(name.size() - extension.size()), extension,
                              [](char a, char b) { return (a | 0x20) == (b | 0x20); });
  };
  std::string packed;
  if (ends_with(".gz")) {
    packed = name.substr(name.size() - 3);
    name.resize(name.size() - 3);
  }
  const bool is_header = ends_with(".hdr"), is_values = ends_with(".img");
  if (!is_header && !is_values) return {path, path};

  const bool upper = name.back() == 'R' || name.back() == 'G';
  const std::string_view extension =
      is_header ? (upper ? ".IMG" : ".img") : (upper ? ".HDR" : ".hdr");
  const std::string other = name.substr(0, name.size() - 4) + std::string(extension);
  for (const std::string& candidate : {other + packed, other, other + ".gz"}) {
    if (!std::filesystem::exists(candidate)) continue;
    return is_header ? NiftiFiles{path, candidate} : NiftiFiles{candidate, path};
  }
  throw Error(path.string() + ": its other half " + other + " is missing; NIfTI pairs need both");
}

}  // namespace pellucid
