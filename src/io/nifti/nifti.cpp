// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "files/data_stream.h"
#include "nifti_header.h"
#include "pellucid/scene/error.h"
#include "ras_affine.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"
#include "volumes/volume_steps.h"

namespace pellucid {

namespace {

// Stored values of up to 16 bits fit float after scaling to its own rounding; wider ones do not.
template <class Value>
using Scaled =
    std::conditional_t<sizeof(Value) <= 2 || std::is_same_v<Value, float>, float, double>;

/// Reads slope · stored + intercept, a few stored values at a time.
VolumeData read_scaled(const ReadOn& read, const NiftiHeader& header, std::size_t count,
                       const std::string& name) {
  return std::visit(
      [&](const auto& stored_type) -> VolumeData {
        using Stored = typename std::decay_t<decltype(stored_type)>::value_type;
        VolumeData data =
            make_values(std::is_same_v<Scaled<Stored>, float> ? "f32" : "f64", count, name);
        const std::span<Scaled<Stored>> scaled =
            std::get<DataArray<Scaled<Stored>>>(data).writable();
        constexpr std::size_t largest_part = std::size_t{1} << 16;
        VolumeData part;
        for (std::size_t first = 0; first < count; first += largest_part) {
          part = DataArray<Stored>(std::min(largest_part, count - first));
          const std::span<Stored> values = std::get<DataArray<Stored>>(part).writable();
          read(std::as_writable_bytes(values));
          to_native_order(part, header.layout.big_endian);
          std::ranges::transform(
              values, scaled.begin() + static_cast<std::ptrdiff_t>(first), [&](Stored value) {
                return static_cast<Scaled<Stored>>(header.slope * static_cast<double>(value) +
                                                   header.intercept);
              });
        }
        return data;
      },
      make_volume_data(header.layout.type, 0));
}

/// Returns the same of whole numbers of 64 bits.
template <class Stored>
VolumeData read_scaled_whole(const ReadOn& read, const NiftiHeader& header, std::size_t count,
                             const std::string& name) {
  VolumeData data = make_values("f64", count, name);
  const std::span<double> scaled = std::get<DataArray<double>>(data).writable();
  const bool swapped = header.layout.big_endian == (std::endian::native == std::endian::little);
  constexpr std::size_t largest_part = std::size_t{1} << 16;
  std::vector<Stored> part(std::min(largest_part, count));
  for (std::size_t first = 0; first < count; first += part.size()) {
    part.resize(std::min(part.size(), count - first));
    read(std::as_writable_bytes(std::span(part)));
    for (std::size_t i = 0; i < part.size(); ++i) {
      auto bytes = std::bit_cast<std::array<std::byte, sizeof(Stored)>>(part[i]);
      if (swapped) std::ranges::reverse(bytes);
      scaled[first + i] =
          header.slope * static_cast<double>(std::bit_cast<Stored>(bytes)) + header.intercept;
    }
  }
  return data;
}

VolumeData read_scaled_any(const ReadOn& read, const NiftiHeader& header, std::size_t count,
                           const std::string& name) {
  const std::string& type = header.layout.type;
  if (type == "i64") return read_scaled_whole<std::int64_t>(read, header, count, name);
  if (type == "u64") return read_scaled_whole<std::uint64_t>(read, header, count, name);
  return read_scaled(read, header, count, name);
}

/// Components that are scaled lie one behind the other.
std::vector<VolumeData> read_scaled(const ReadOn& read, const NiftiHeader& header,
                                    std::size_t count, ComponentRange range,
                                    const std::string& name) {
  std::vector<VolumeData> list;
  list.reserve(static_cast<std::size_t>(range.number));
  for (int c = 0; c < range.number; ++c) {
    list.push_back(read_scaled_any(read, header, count, name));
  }
  return list;
}

std::vector<VolumeData> read_file_values(const std::filesystem::path& file,
                                         const NiftiHeader& header, std::size_t count,
                                         ComponentRange range, const std::string& name) {
  const ValueLayout& layout = header.layout;
  const bool as_stored = header.slope == 1 && header.intercept == 0;
  const std::uintmax_t bytes = std::uintmax_t{count} * value_size(layout.type, name);
  const std::uintmax_t before = bytes * static_cast<std::uintmax_t>(range.first);
  if (is_gzip(file)) {
    DataStream stream(file, 0, DataStream::Compression::deflate);
    stream.skip(layout.offset);
    std::vector<VolumeData> list;
    if (as_stored) {
      list = read_components(stream, layout, count, range);
    } else {
      stream.skip(before);
      list = read_scaled([&](std::span<std::byte> to) { stream.read(to); }, header, count, range,
                         name);
      const int rest = layout.components - range.first - range.number;
      stream.skip(bytes * static_cast<std::uintmax_t>(rest));
    }
    stream.finish();
    return list;
  }
  const ByteSource source = file_source(file);
  const std::size_t all = value_count(count, layout.components, name);
  check_size(source, layout, all);
  note_bytes_left_over(source, layout.offset + all * value_size(layout.type, name), layout.note,
                       {});
  if (as_stored) return read_components(source, layout, count, range);
  return read_scaled(read_on(source, layout.offset + before), header, count, range, name);
}

/// Returns where a header puts the grid that states no orientation, as nibabel and SPM do: x runs
/// towards left, y towards anterior and z towards superior. The world's origin is the grid's
/// middle, or the voxel that Analyze's header names, if it is near the grid. Lengths are in the
/// file's unit.
GridPlacement base_placement(const NiftiHeader& header, const Vec3<double>& spacing) {
  bool has_origin = false, is_near = true;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t origin = header.origin[a], side = header.dimensions[a];
    has_origin = has_origin || origin != 0;
    is_near = is_near && origin > -side && origin < 2 * side;
  }
  RasRows rows{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double step = spacing[static_cast<int>(a)] * (a == 0 ? -1 : 1);
    const double middle = static_cast<double>(header.dimensions[a] - 1) / 2;
    rows[a][a] = step;
    rows[a][3] = -step * (has_origin && is_near ? header.origin[a] - 1 : middle);
  }
  return placement_from_ras(rows);
}

bool states_orientation(const NiftiHeader& header) {
  return header.sform || header.qform;
}

/// Returns whether each axis has a length.
bool is_usable(const GridPlacement& placement) {
  return std::ranges::all_of(std::array{0, 1, 2}, [&](int a) {
    return length(placement.direction.column[a]) > 0;  // not where it is NaN
  });
}

/// Chooses between the two maps as nibabel, FSL and SPM do: the sform where there is one, else the
/// qform. Lengths are in the file's unit.
GridPlacement placement_of(const NiftiHeader& header, const ReadOptions& options) {
  if (header.sform && (is_usable(*header.sform) || !header.qform)) return *header.sform;
  if (header.qform) return *header.qform;
  const Vec3<double> spacing{header.spacing[0], header.spacing[1], header.spacing[2]};
  return base_placement(header, options.spacing ? *options.spacing * (1 / header.unit) : spacing);
}

Volume::Description describe(const NiftiHeader& header, const std::string& name,
                             const ReadOptions& options) {
  Volume::Description description;
  description.placement = placement_of(header, options);
  for (int a = 0; a < 3; ++a) {
    const Vec3<double>& axis = description.placement.direction.column[a];
    if (length(axis) > 0) continue;  // not where the sform has no length along it
    throw Error(name + ": the sform gives axis " + std::string(1, "xyz"[a]) +
                " no length; mend the header");
  }
  for (std::size_t a = 0; a < 3; ++a) {
    description.dimensions[a] = static_cast<int>(header.dimensions[a]);
  }
  description.placement.spacing = description.placement.spacing * header.unit;
  description.placement.origin = description.placement.origin * header.unit;
  description.name = name;
  return description;
}

/// Returns the largest distance of the same corner in both, in voxels of the first.
double difference(const GridPlacement& one, const GridPlacement& other,
                  const std::array<std::int64_t, 3>& dimensions) {
  const double voxel = std::min({one.spacing.x, one.spacing.y, one.spacing.z});
  double largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3<double> apart = one.origin - other.origin;
    for (int a = 0; a < 3; ++a) {
      if ((corner >> a & 1) == 0) continue;
      const auto last = static_cast<double>(dimensions[static_cast<std::size_t>(a)] - 1);
      apart = apart + (one.direction.column[a] * one.spacing[a] -
                       other.direction.column[a] * other.spacing[a]) *
                          last;
    }
    largest = std::max(largest, length(apart) / voxel);
  }
  return largest;
}

/// Tells of two maps that differ which one is used.
void note_maps(const NiftiHeader& header, const Volume::Description& description,
               const ReadOptions& options) {
  if (!options.note || !header.sform || !header.qform) return;
  constexpr double alike = 1e-3;
  const double apart = difference(*header.sform, *header.qform, header.dimensions);
  if (apart <= alike) return;
  GridPlacement used = description.placement;
  used.origin = used.origin * (1 / header.unit);
  used.spacing = used.spacing * (1 / header.unit);
  const bool is_sform = difference(*header.sform, used, header.dimensions) <=
                        difference(*header.qform, used, header.dimensions);
  options.note(description.name + ": its qform and its sform place it differently; the " +
               (is_sform ? "sform" : "qform") + " is used");
}

/// Tells what the header leaves open.
void note_header(const NiftiHeader& header, const NiftiFiles& files, const std::string& name,
                 const ReadOptions& options) {
  if (!options.note) return;
  for (const std::string& text : header.notes) options.note(text);
  if (!states_orientation(header)) {
    options.note(
        name +
        (header.version == NiftiVersion::analyze
             ? ": Analyze 7.5 states no orientation"
             : ": states no orientation (qform_code and sform_code are 0)") +
        "; placed as nibabel and SPM do: x towards left, y anterior, z superior, about the "
        "origin");
  }
  std::filesystem::path matrix = files.header;
  std::error_code error;
  if (header.version == NiftiVersion::analyze &&
      std::filesystem::exists(matrix.replace_extension(".mat"), error)) {
    options.note(name + ": " + matrix.filename().string() +
                 " beside it, which may hold SPM's placement, is not read");
  }
}

/// Opens NIfTI-1 and NIfTI-2: .nii, or .hdr with .img, each also .gz; Analyze 7.5. The world is
/// LPS. The map is the sform where it is the scanner's or stands alone, else the qform (as ITK 5.2
/// chooses), else what nibabel and SPM take. Colors, and an axis behind the third, are components;
/// several such axes, complex numbers and CIFTI are refused.
VolumeFile open_nifti(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const NiftiFiles files = find_nifti_files(path);
  NiftiHeader header = read_nifti_header(files.header);
  if (!header.single_file && files.header == files.values) {
    throw Error(name +
                (header.version == NiftiVersion::analyze
                     ? ": lacks the mark of NIfTI (\"n+1\"); if it is Analyze 7.5, name its "
                       "two files .hdr and .img"
                     : ": says that its values are in a file of their own; name it .hdr, and "
                       "put the .img beside it"));
  }
  header.layout.note = options.note;
  const std::size_t count = value_count(header.dimensions, name);
  for (std::size_t a = 0; a < 3 && !options.spacing; ++a) {
    if (header.spacing[a] > 0) continue;
    throw Error(name + ": the spacing along " + std::string(1, "xyz"[a]) + " is " +
                std::to_string(header.spacing[a]) + "; give a positive one");
  }
  value_count(count, header.layout.components, name);
  VolumeFile file;
  file.description = describe(header, name, options);
  if (states_orientation(header)) file.space = patient_space;
  note_maps(header, file.description, options);
  note_header(header, files, name, options);
  apply_overrides(options, file.description);
  file.components = header.layout.components;
  file.holds = header.holds;
  if (header.holds.starts_with("colors")) file.largest_color = 255;
  file.reads_parts = header.slope == 1 && header.intercept == 0 && reads_parts(header.layout) &&
                     !is_gzip(header.single_file ? files.header : files.values);
  file.read = [header, count, name,
               values = header.single_file ? files.header : files.values](ComponentRange range) {
    return read_file_values(values, header, count, range, name);
  };
  if (options.time || !header.times.empty()) {
    take_steps({header.times, header.time_unit}, options, name + ": ", file);
  }
  return file;
}

}  // namespace

extern const VolumeFormat nifti_format{.name = "NIfTI",
                                       .extensions = ".nii .nii.gz .hdr .hdr.gz .img .img.gz",
                                       .open = open_nifti,
                                       .has_times = true,
                                       .is_of_patients = true};

}  // namespace pellucid
