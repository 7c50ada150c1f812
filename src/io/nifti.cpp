// SPDX-License-Identifier: Apache-2.0
#include <type_traits>
#include <utility>

#include "data_stream.h"
#include "input_file.h"
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

VolumeData scale(VolumeData data, const NiftiHeader& header) {
  if (header.slope == 1 && header.intercept == 0) return data;
  return std::visit(
      [&](const auto& values) -> VolumeData {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        std::vector<Scaled<Value>> scaled(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
          scaled[i] = static_cast<Scaled<Value>>(header.slope * static_cast<double>(values[i]) +
                                                 header.intercept);
        }
        return scaled;
      },
      data);
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
  const std::uintmax_t bytes = std::uintmax_t{count} * value_size(header.layout.type, name);
  check_memory(bytes, name);
  Volume::Description description = describe(files, header, name);

  const std::filesystem::path& file = header.single_file ? files.header : files.values;
  VolumeData data = [&] {
    if (!is_gzip(file)) {
      const ByteSource source = file_source(file);
      check_size(source, header.layout, count);
      return read_values(source, header.layout, count);
    }
    DataStream stream(file, 0, DataStream::Compression::deflate);
    stream.skip(header.layout.offset);
    VolumeData values = read_values(stream, header.layout, count);
    stream.finish();
    return values;
  }();
  data = scale(std::move(data), header);
  apply_overrides(options, description);
  return Volume(std::move(description), std::move(data));
}

}  // namespace pellucid
