// SPDX-License-Identifier: Apache-2.0
//
// The format: A. Cheng et al., MRC2014: Extensions to the MRC format header for electron
// cryo-microscopy and tomography, J. Struct. Biol. 192 (2015); CCP4's maps are the same. 256 words
// of 4 bytes, an extended header of NSYMBT bytes, the values.

#include "mrc.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string_view>

#include "files/gzip_source.h"
#include "pellucid/scene/error.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace {

constexpr std::size_t header_bytes = 1024;

class MrcHeader {
 public:
  MrcHeader(const ByteSource& source) : name_(source.name) {
    if (source.size < header_bytes) {
      throw Error(name_ + ": has " + std::to_string(source.size) +
                  " bytes, less than the header of an MRC file; it is cut off");
    }
    source.read(0, bytes_);
    big_endian_ = find_order();
  }

  bool big_endian() const noexcept { return big_endian_; }

  /// Return words by their numbers in the format's description, from 1.
  std::int32_t whole(std::size_t word) const { return at<std::int32_t>(word, big_endian_); }
  double real(std::size_t word) const { return static_cast<double>(at<float>(word, big_endian_)); }
  bool says(std::size_t word, std::string_view text) const {
    return std::ranges::equal(text, std::span(bytes_).subspan(4 * (word - 1), text.size()), {}, {},
                              [](std::byte b) { return std::to_integer<char>(b); });
  }

 private:
  template <class T>
  T at(std::size_t word, bool big_endian) const {
    std::array<std::byte, 4> raw;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(4 * (word - 1)), 4, raw.begin());
    if (big_endian == (std::endian::native == std::endian::little)) std::ranges::reverse(raw);
    return std::bit_cast<T>(raw);
  }

  /// Finds the byte order. Word 54, the machine stamp, says it; where it does not, sizes and the
  /// mode do.
  bool find_order() const {
    const int stamp = std::to_integer<int>(bytes_[4 * 53]);
    if (stamp == 0x11 || stamp == 0x44) return stamp == 0x11;
    for (const bool big_endian : {false, true}) {
      bool plausible = true;
      for (std::size_t word = 1; word <= 3; ++word) {
        const std::int32_t side = at<std::int32_t>(word, big_endian);
        plausible = plausible && side >= 1 && side < (1 << 24);
      }
      const std::int32_t mode = at<std::int32_t>(4, big_endian);
      if (plausible && mode >= 0 && mode <= 101) return big_endian;
    }
    throw Error(name_ + ": does not begin like an MRC file");
  }

  const std::string& name_;
  std::array<std::byte, header_bytes> bytes_;
  bool big_endian_ = false;
};

/// Returns whether bytes have no sign. IMOD's files say so; others hold signed bytes since MRC2014,
/// and unsigned ones before. Those show in the range that the header gives.
bool has_unsigned_bytes(const MrcHeader& header) {
  constexpr std::int32_t imod_stamp = 1146047817;
  if (header.whole(39) == imod_stamp) return (header.whole(40) & 1) == 0;
  return header.real(20) >= 0 && header.real(21) > 127;
}

std::string type_of(const MrcHeader& header, const std::string& name) {
  switch (const std::int32_t mode = header.whole(4)) {
    case 0:
      return has_unsigned_bytes(header) ? "u8" : "i8";
    case 1:
      return "i16";
    case 2:
      return "f32";
    case 6:
      return "u16";
    case 3:
    case 4:
      throw Error(name + ": complex numbers (MRC mode " + std::to_string(mode) +
                  ") are not read; save their magnitude or one part");
    case 12:
      return "f16";
    default:
      throw Error(name + ": MRC mode " + std::to_string(mode) +
                  " is not read; convert the file to mode 2");
  }
}

/// Returns unit vectors along the cell's edges a, b and c: a along x, b in the plane of x and y.
Mat3<double> cell_axes(const MrcHeader& header, const std::string& name) {
  std::array<double, 3> cosine{};
  for (std::size_t i = 0; i < 3; ++i) {
    // Programs of microscopy leave them 0.
    const double angle = header.real(14 + i);
    if (angle == 0 || angle == 90) continue;
    if (!(angle > 0 && angle < 180)) {
      throw Error(name + ": the MRC header says that an angle of the cell is " +
                  std::to_string(angle) + " degrees; mend the header");
    }
    cosine[i] = std::cos(angle * std::numbers::pi / 180);
  }
  const auto [alpha, beta, gamma] = cosine;
  const double sine = std::sqrt(1 - gamma * gamma);
  const double y = (alpha - beta * gamma) / sine;
  const double height = 1 - beta * beta - y * y;
  if (!(height > 0)) {
    throw Error(name + ": the MRC header has angles that no cell has; mend the header");
  }
  Mat3<double> axes;
  axes.column[0] = {1, 0, 0};
  axes.column[1] = {gamma, sine, 0};
  axes.column[2] = {beta, y, std::sqrt(height)};
  return axes;
}

/// Returns which of the cell's edges columns, rows and sections are counted along, from 0.
std::array<int, 3> axis_order(const MrcHeader& header, const ReadOptions& options,
                              const std::string& name) {
  const std::array<int, 3> counted{header.whole(17), header.whole(18), header.whole(19)};
  if (counted == std::array{0, 0, 0}) {
    if (options.note) {
      options.note(name +
                   ": the MRC header does not say which axes its columns, rows and sections are "
                   "(MAPC, MAPR, MAPS are 0); taken to be x, y and z");
    }
    return {0, 1, 2};
  }
  std::array<int, 3> sorted = counted;
  std::ranges::sort(sorted);
  if (sorted != std::array{1, 2, 3}) {
    throw Error(name + ": the MRC header says that columns, rows and sections are axes " +
                std::to_string(counted[0]) + ", " + std::to_string(counted[1]) + " and " +
                std::to_string(counted[2]) +
                ", which must be 1, 2 and 3 in some order; mend the header");
  }
  return {counted[0] - 1, counted[1] - 1, counted[2] - 1};
}

GridPlacement placement_of(const MrcHeader& header, const ReadOptions& options,
                           const std::string& name) {
  const Mat3<double> cell = cell_axes(header, name);
  const std::array<int, 3> order = axis_order(header, options, name);
  GridPlacement placement;
  Vec3<double> first{0, 0, 0};
  for (std::size_t a = 0; a < 3; ++a) {
    const int i = static_cast<int>(a);
    const auto edge = static_cast<std::size_t>(order[a]);
    const double size = header.real(11 + edge);
    const std::int32_t intervals = header.whole(8 + edge);
    placement.direction.column[i] = cell.column[order[a]];
    if (size > 0 && std::isfinite(size) && intervals > 0) {
      placement.spacing[i] = size / intervals;
    } else if (!options.spacing && options.note) {
      options.note(name + ": the MRC header does not know the size of its cell along " +
                   std::string(1, "xyz"[edge]) + "; the spacing is taken to be 1");
    }
    first = first + placement.direction.column[i] * (placement.spacing[i] * header.whole(5 + a));
  }
  // Words 50 to 52 are an origin where "MAP " stands behind them: in its place (MRC2014, note 10).
  const Vec3<double> origin{header.real(50), header.real(51), header.real(52)};
  const bool has_origin = header.says(53, "MAP") && !(origin == Vec3<double>{0, 0, 0});
  placement.origin = has_origin ? origin : first;
  return placement;
}

}  // namespace

VolumeFile open_mrc(const ByteSource& source, const ReadOptions& options) {
  const std::string& name = source.name;
  refuse_raw_options(options, name);
  const MrcHeader header(source);
  std::array<std::int64_t, 3> sides{header.whole(1), header.whole(2), header.whole(3)};
  ValueLayout layout{type_of(header, name), header.big_endian(), 0};
  // Space group 401: a stack of volumes of MZ sections each.
  const std::int64_t sections = header.whole(10);
  if (header.whole(23) >= 401 && sections > 0 && sides[2] > sections) {
    if (sides[2] % sections != 0) {
      throw Error(name + ": the MRC header says that " + std::to_string(sides[2]) +
                  " sections are volumes of " + std::to_string(sections) + "; mend the header");
    }
    layout.components = static_cast<int>(sides[2] / sections);
    sides[2] = sections;
  }
  // Volumes of old programs have space group 0, too, but MZ sections.
  if (header.whole(23) == 0 && sections == 1 && sides[2] > 1 && options.note) {
    options.note(name +
                 ": the MRC header says that its sections are a stack of images (ISPG 0, MZ 1), no "
                 "volume; they are shown as slices along z");
  }
  const std::size_t points = value_count(sides, name);
  const std::int32_t extended = header.whole(24);
  if (extended < 0) {
    throw Error(name + ": the MRC header says that an extended header has " +
                std::to_string(extended) + " bytes; mend the header");
  }
  layout.offset = header_bytes + static_cast<std::uintmax_t>(extended);
  const std::size_t count = value_count(points, layout.components, name);
  check_size(source, layout, count);
  note_bytes_left_over(source, layout.offset + count * value_size(layout.type, name), options.note,
                       {});

  VolumeFile file;
  file.description.name = name;
  for (std::size_t a = 0; a < 3; ++a) file.description.dimensions[a] = static_cast<int>(sides[a]);
  file.description.placement = placement_of(header, options, name);
  apply_overrides(options, file.description);
  file.components = layout.components;
  file.holds = std::to_string(layout.components) + " volumes (space group 401)";
  file.reads_parts = source.map && reads_parts(layout);  // not of gzip
  file.read = [source, layout, points](ComponentRange range) {
    return read_components(source, layout, points, range);
  };
  return file;
}

extern const VolumeFormat mrc_format{
    .name = "MRC",
    .extensions = ".mrc .map .rec .st .ccp4 .mrc.gz .map.gz .rec.gz .st.gz .ccp4.gz",
    .open = [](const std::filesystem::path& path, const ReadOptions& options) {
      return open_mrc(plain_or_gzip_source(path), options);
    }};

}  // namespace pellucid
