// SPDX-License-Identifier: Apache-2.0
//
// FreeSurfer's MGH, https://surfer.nmr.mgh.harvard.edu/fswiki/FsTutorial/MghFormat: a big-endian
// header of 284 bytes, the values frame by frame, and tags behind them that say nothing of a
// volume.

#include "mgh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "files/gzip_source.h"
#include "pellucid/scene/error.h"
#include "ras_affine.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace {

constexpr std::size_t header_size = 284;
using HeaderBytes = std::array<std::byte, header_size>;

template <class T>
T number_at(const HeaderBytes& bytes, std::size_t offset) {
  std::array<std::byte, sizeof(T)> part;
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(T), part.begin());
  if (std::endian::native == std::endian::little) std::ranges::reverse(part);
  return std::bit_cast<T>(part);
}

const char* mgh_type_of(std::int32_t code, const std::string& name) {
  switch (code) {
    case 0:
      return "u8";
    case 1:
      return "i32";
    case 3:
      return "f32";
    case 4:
      return "i16";
    case 10:
      return "u16";
    default:
      throw Error(name + ": MGH data type " + std::to_string(code) +
                  " is not read; convert the file to float (mri_convert -odt float)");
  }
}

/// Returns the map from indices to RAS: the columns of the directions times the spacing, and the
/// middle of the grid, dimensions / 2, at the center.
RasRows rows_of(const std::array<double, 3>& spacing, const std::array<double, 9>& columns,
                const std::array<double, 3>& center,
                const std::array<std::int64_t, 3>& dimensions) {
  RasRows rows{};
  for (std::size_t row = 0; row < 3; ++row) {
    rows[row][3] = center[row];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rows[row][axis] = columns[3 * axis + row] * spacing[axis];
      rows[row][3] -= rows[row][axis] * static_cast<double>(dimensions[axis]) / 2;
    }
  }
  return rows;
}

/// Returns the placement of the grid: as the header says, or as FreeSurfer takes it where it does
/// not.
GridPlacement placement_of(const HeaderBytes& bytes, const std::array<std::int64_t, 3>& dimensions,
                           const ReadOptions& options, bool is_stated, const std::string& name) {
  std::array<double, 3> spacing{1, 1, 1}, center{};
  // Slices from the front to the back, as FreeSurfer's own volumes lie.
  std::array<double, 9> columns{-1, 0, 0, 0, 0, -1, 0, 1, 0};
  if (is_stated) {
    const auto fill = [&](auto& to, std::size_t offset, const char* what) {
      for (std::size_t i = 0; i < to.size(); ++i) {
        to[i] = static_cast<double>(number_at<float>(bytes, offset + 4 * i));
        if (std::isfinite(to[i])) continue;
        throw Error(name + ": the " + what + " of the MGH header is not finite; mend the header");
      }
    };
    fill(spacing, 30, "spacing (delta)");
    fill(columns, 42, "direction (Mdc)");
    fill(center, 78, "center (Pxyz_c)");
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (spacing[a] > 0) continue;
    if (options.spacing) {
      spacing[a] = (*options.spacing)[static_cast<int>(a)];
      continue;
    }
    throw Error(name + ": the spacing along " + std::string(1, "xyz"[a]) + " is " +
                std::to_string(spacing[a]) + "; give a positive one");
  }
  const GridPlacement placement = placement_from_ras(rows_of(spacing, columns, center, dimensions));
  for (int a = 0; a < 3; ++a) {
    if (placement.spacing[a] > 0) continue;
    throw Error(name + ": the MGH header gives axis " + std::string(1, "xyz"[a]) +
                " no direction; mend the header");
  }
  return placement;
}

}  // namespace

VolumeFile open_mgh_bytes(const ByteSource& source, const ReadOptions& options) {
  const std::string& name = source.name;
  refuse_raw_options(options, name);
  if (source.size < header_size) {
    throw Error(name + ": is too short for an MGH file, whose header has 284 bytes");
  }
  HeaderBytes bytes;
  source.read(0, bytes);
  const auto version = number_at<std::int32_t>(bytes, 0);
  // Newer files tell what they are for (a warp) in the bits above.
  if (version < 0 || (version & 0xff) != 1) {
    throw Error(name + ": does not begin like an MGH file of version 1");
  }
  std::array<std::int64_t, 3> dimensions{};
  for (std::size_t a = 0; a < 3; ++a) dimensions[a] = number_at<std::int32_t>(bytes, 4 + 4 * a);
  const auto frames = number_at<std::int32_t>(bytes, 16);
  const std::size_t points = value_count(dimensions, name);
  if (frames < 1) {
    throw Error(name + ": the MGH header says " + std::to_string(frames) +
                " frames; it is damaged");
  }
  const ValueLayout layout{mgh_type_of(number_at<std::int32_t>(bytes, 20), name),
                           true,
                           header_size,
                           frames,
                           false,
                           options.note};
  check_size(source, layout, value_count(points, frames, name));
  const bool is_stated = number_at<std::int16_t>(bytes, 28) > 0;
  VolumeFile file;
  file.description.name = name;
  for (std::size_t a = 0; a < 3; ++a) {
    file.description.dimensions[a] = static_cast<int>(dimensions[a]);
  }
  file.description.placement = placement_of(bytes, dimensions, options, is_stated, name);
  if (is_stated) {
    file.space = patient_space;
  } else if (options.note) {
    options.note(name +
                 ": states no orientation (goodRASFlag is 0); placed as FreeSurfer does: 1 mm, x "
                 "towards left, y inferior, z anterior, about the origin");
  }
  if (options.note && version > 0xff) {
    options.note(name + ": is meant for another use than a volume (intent " +
                 std::to_string(version >> 8) + "), as a warp; its values are read as they are");
  }
  apply_overrides(options, file.description);
  file.components = frames;
  file.holds = std::to_string(frames) + " frames";
  file.reads_parts = source.map && reads_parts(layout);  // not of gzip
  file.read = [source, layout, points](ComponentRange range) {
    return read_components(source, layout, points, range);
  };
  return file;
}

extern const VolumeFormat mgh_format{
    .name = "MGH",
    .extensions = ".mgz .mgh .mgh.gz",
    .open =
        [](const std::filesystem::path& path, const ReadOptions& options) {
          return open_mgh_bytes(plain_or_gzip_source(path), options);
        },
    .is_of_patients = true};

}  // namespace pellucid
