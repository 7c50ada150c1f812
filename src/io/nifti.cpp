// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>

#include "data_stream.h"
#include "itk_header.h"
#include "medical_volumes.h"
#include "nifti_header.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

// Stored values of up to 16 bits fit float after scaling to its own rounding; wider ones do not.
template <class Value>
using Scaled =
    std::conditional_t<sizeof(Value) <= 2 || std::is_same_v<Value, float>, float, double>;

/// Fills a span with the bytes that come next.
using ReadOn = std::function<void(std::span<std::byte>)>;

/// slope · stored + intercept, a few stored values at a time.
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

VolumeData read_file_values(const std::filesystem::path& file, const NiftiHeader& header,
                            std::size_t count, const std::string& name) {
  const bool as_stored = header.slope == 1 && header.intercept == 0;
  if (is_gzip(file)) {
    DataStream stream(file, 0, DataStream::Compression::deflate);
    stream.skip(header.layout.offset);
    VolumeData data = as_stored ? read_values(stream, header.layout, count)
                                : read_scaled([&](std::span<std::byte> to) { stream.read(to); },
                                              header, count, name);
    stream.finish();
    return data;
  }
  const ByteSource source = file_source(file);
  check_size(source, header.layout, count);
  if (as_stored) return read_values(source, header.layout, count);
  std::uintmax_t from = header.layout.offset;
  return read_scaled(
      [&](std::span<std::byte> to) {
        source.read(from, to);
        from += to.size();
      },
      header, count, name);
}

Volume::Description describe(const NiftiFiles& files, const NiftiHeader& header,
                             const std::string& name) {
  bool sheared = false;
  Volume::Description description = read_nifti_description(files.header, sheared);
  if (sheared) {
    if (!header.sform) {
      throw Error(name +
                  ": the header's orientation is no usable map; give spacing and origin by "
                  "converting the file");
    }
    description.placement = *header.sform;
    description.placement.spacing = description.placement.spacing * header.unit;
    for (std::size_t a = 0; a < 3; ++a) {
      description.dimensions[a] = static_cast<int>(header.dimensions[a]);
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (description.dimensions[a] == header.dimensions[a]) continue;
    throw Error(name + ": the NIfTI header contradicts itself about the dimensions");
  }
  // ITK 5.2 turns the spacing to millimetres, but leaves the origin in the file's unit.
  description.placement.origin = description.placement.origin * header.unit;
  description.name = name;
  return description;
}

}  // namespace

Volume read_nifti(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const NiftiFiles files = find_nifti_files(path);
  const NiftiHeader header = read_nifti_header(files.header);
  const std::size_t count = value_count(header.dimensions, name);
  // ITK puts 1 in the place of 0.
  for (std::size_t a = 0; a < 3 && !options.spacing; ++a) {
    if (header.spacing[a] > 0) continue;
    throw Error(name + ": the spacing along " + std::string(1, "xyz"[a]) + " is " +
                std::to_string(header.spacing[a]) + "; give a positive one");
  }
  Volume::Description description = describe(files, header, name);

  const std::filesystem::path& file = header.single_file ? files.header : files.values;
  VolumeData data = read_file_values(file, header, count, name);
  apply_overrides(options, description);
  return Volume(std::move(description), std::move(data));
}

}  // namespace pellucid
