// SPDX-License-Identifier: Apache-2.0
#include "itk_header.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/input_file.h"
#include "files/memory_limit.h"
#include "pellucid/io/internal/module.h"
#include "pellucid/scene/error.h"
#include "volumes/stored_numbers.h"

namespace pellucid {

namespace {

constexpr Module itk{"pellucid_itk.so", "reads NRRD and MetaImage",
                     "ITK (Debian: libinsighttoolkit5-dev)"};

/// Calls a function of the module and throws what it says.
template <class Function, class... Arguments>
void call(const std::string& name, const char* function, Arguments&&... arguments) {
  std::string error;
  Function* entry = nullptr;
  try {
    entry = reinterpret_cast<Function*>(module_function(itk, function));
  } catch (const Error& e) {
    throw Error(name + ": " + e.what());
  }
  entry(std::forward<Arguments>(arguments)..., error);
  if (!error.empty()) throw Error(error);
}

/// Returns values whose components lie along an axis between others as if they lay one component
/// behind the other, from byte 0 on. `before` are the bytes along the axes in front of that one.
ByteSource with_components_last(ByteSource source, std::uintmax_t offset, std::uintmax_t before,
                                std::uintmax_t components, std::uintmax_t all) {
  ByteSource turned{source.name, all, {}, {}};
  const std::uintmax_t of_component = all / components;
  turned.read = [source = std::move(source), offset, before, components, of_component](
                    std::uintmax_t from, std::span<std::byte> to) {
    while (!to.empty()) {
      const std::uintmax_t component = from / of_component, within = from % of_component;
      const std::uintmax_t row = within / before, at = within % before;
      const std::size_t bytes = std::min<std::uintmax_t>(before - at, to.size());
      source.read(offset + (row * components + component) * before + at, to.first(bytes));
      to = to.subspan(bytes);
      from += bytes;
    }
  };
  return turned;
}

std::vector<VolumeData> read_raw_values(const NrrdValues& values, ValueLayout layout,
                                        std::size_t points, std::size_t values_before,
                                        ComponentRange range) {
  layout.big_endian = values.big_endian.value_or(false);
  const std::string name = values.file.string();
  const std::uintmax_t each = value_size(layout.type, name);
  const bool is_between =
      !layout.interleaved && layout.components > 1 && values_before > 1 && values_before < points;
  const auto components = static_cast<std::uintmax_t>(layout.components);
  if (values.compression && is_between) {
    const std::uintmax_t all = value_count(points, layout.components, name) * each;
    check_memory(all, name + ": its values");
    std::vector<std::byte> bytes(all);
    DataStream stream(values.file, values.offset, *values.compression);
    stream.skip(values.skip_inside);
    stream.read(bytes);
    stream.finish();
    return read_components(
        with_components_last(memory_source(bytes, name), 0, values_before * each, components, all),
        layout, points, range);
  }
  if (values.compression) {
    DataStream stream(values.file, values.offset, *values.compression);
    stream.skip(values.skip_inside);
    std::vector<VolumeData> list = read_components(stream, layout, points, range);
    stream.finish();
    return list;
  }
  const ByteSource source = file_source(values.file);
  layout.offset = values.offset;
  const std::size_t count = value_count(points, layout.components, source.name);
  const std::uintmax_t bytes = std::uintmax_t{count} * value_size(layout.type, source.name);
  if (values.offset == NrrdValues::last_bytes) {
    layout.offset = source.size > bytes ? source.size - bytes : 0;
  }
  check_size(source, layout, count);
  if (is_between) {
    const std::uintmax_t from = std::exchange(layout.offset, 0);
    return read_components(
        with_components_last(source, from, values_before * each, components, bytes), layout, points,
        range);
  }
  return read_components(source, layout, points, range);
}

std::vector<VolumeData> read_by_itk(const std::filesystem::path& path, ValueLayout layout,
                                    std::size_t points, ComponentRange range,
                                    const std::string& name) {
  const std::size_t count = value_count(points, layout.components, name);
  layout.big_endian = std::endian::native == std::endian::big;
  if (is_stored_only(layout.type)) {
    const std::size_t bytes = count * value_size(layout.type, name);
    check_memory(bytes, name + ": its values");
    std::vector<std::byte> stored(bytes);
    call<ReadNrrdValues>(name, read_nrrd_values_name, path, name, std::span(stored));
    return read_components(memory_source(stored, name), layout, points, range);
  }
  std::vector<VolumeData> list;
  list.push_back(make_values(layout.type, count, name));
  std::visit(
      [&](auto& values) {
        call<ReadNrrdValues>(name, read_nrrd_values_name, path, name,
                             std::as_writable_bytes(values.writable()));
      },
      list.front());
  if (layout.components == 1) return list;
  return std::visit(
      [&](const auto& values) {
        const auto bytes = std::as_bytes(std::span(values.data(), values.size()));
        return read_components(memory_source(bytes, name), layout, points, range);
      },
      list.front());
}

}  // namespace

Volume::Description describe(const ItkHeader& header, const std::string& name) {
  value_count(header.sides, name);
  Volume::Description description;
  description.name = name;
  description.placement = header.placement;
  for (std::size_t a = 0; a < 3; ++a) {
    description.dimensions[a] = static_cast<int>(header.sides[a]);
  }
  return description;
}

MetaImageHeader read_meta_image_header(const std::filesystem::path& path) {
  MetaImageHeader header;
  call<ReadMetaImageHeader>(path.string(), read_meta_image_header_name, path, header);
  return header;
}

VolumeFile open_nrrd_file(const std::filesystem::path& path, const std::string& name,
                          const NrrdText& text, const ReadOptions& options) {
  NrrdHeader header;
  try {
    call<ReadNrrdHeader>(name, read_nrrd_header_name, path, name, header);
  } catch (const Error& error) {
    // NrrdIO seeks to the first value while it reads the header.
    if (std::string_view(error.what()).find("fseek") == std::string_view::npos) throw;
    throw Error(name +
                ": the file of its values ends before the first of them; it is cut off, or "
                "the byte skip is wrong");
  }
  Volume::Description description = describe(header, name);
  const std::string& type = header.type;
  std::size_t points = 1;
  for (const int side : description.dimensions) points *= static_cast<std::size_t>(side);
  const std::size_t count = value_count(points, header.components, name);
  const std::uintmax_t bytes = std::uintmax_t{count} * value_size(type, name);
  if (text.count != count || header.bytes != bytes ||
      (header.interleaved && text.components_axis == 0)) {
    throw Error(name + ": the NRRD header's sizes make " + std::to_string(text.count) +
                " values, but ITK finds " + std::to_string(count) + " in " +
                std::to_string(header.bytes) + " bytes; mend the header");
  }
  const int cell_centred = text.cell_centred_axes;
  if (cell_centred != 0 && cell_centred != 3 && !options.centering) {
    throw Error(name + ": some axes are cell-centred and some are not; give the centering");
  }
  if (cell_centred == 3) description.centering = Centering::cell;

  if (text.left_anterior_superior) {
    // ITK has turned x; from anterior to posterior is y.
    GridPlacement& placement = description.placement;
    const auto mend = [](Vec3<double> v) { return Vec3<double>{-v.x, -v.y, v.z}; };
    placement.origin = mend(placement.origin);
    for (Vec3<double>& axis : placement.direction.column) axis = mend(axis);
  }

  VolumeFile file;
  file.description = std::move(description);
  apply_overrides(options, file.description);
  file.components = header.components;
  file.holds = header.holds;
  file.reads_parts = text.values && !text.values->compression &&
                     (text.values->big_endian || value_size(type, name) == 1) &&
                     reads_parts({type, false, 0, header.components, header.interleaved});
  file.read = [path, type, header, text, points, name, note = options.note](ComponentRange range) {
    ValueLayout layout{type, false, 0, header.components, header.interleaved, note};
    const bool order_is_known =
        text.values && (text.values->big_endian || value_size(type, name) == 1);
    if (text.values && text.values->compression && !order_is_known) {
      throw Error(name + ": the NRRD header does not say the byte order (endian); mend the header");
    }
    if (order_is_known) {
      if (text.components_axis > 1) layout.interleaved = false;
      return read_raw_values(*text.values, layout, points, text.values_before, range);
    }
    return read_by_itk(path, layout, points, range, name);
  };
  return file;
}

}  // namespace pellucid
