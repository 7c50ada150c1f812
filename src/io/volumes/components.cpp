// SPDX-License-Identifier: Apache-2.0
#include "components.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "color_volume.h"
#include "files/memory_limit.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"

namespace pellucid {

namespace {

std::size_t size_of(const VolumeData& data) {
  return std::visit([](const auto& values) { return values.size(); }, data);
}

/// Returns the part of the file that the options want, if it is not all.
std::optional<GridPart> wanted_part(const VolumeFile& file, const ReadOptions& options) {
  if (!options.part) return std::nullopt;
  const GridPart part{file.description.dimensions, options.part(file.description)};
  static_cast<void>(sub_description(file.description, part.box));  // throws if it is not inside
  return part.box.count == part.dimensions ? std::nullopt : std::optional(part);
}

Volume make_volume(const VolumeFile& file, int component, VolumeData data,
                   const std::optional<GridPart>& part) {
  Volume::Description description = file.description;
  if (part) {
    description = sub_description(description, part->box);
    if (size_of(data) != value_count(part->box)) {
      data = sub_values(data, part->dimensions, part->box);
    }
  }
  if (file.components > 1) description.name += ", component " + std::to_string(component);
  return Volume(std::move(description), std::move(data));
}

std::string choices(const VolumeFile& file) {
  return "0 to " + std::to_string(file.components - 1);
}

/// Returns the component that the options call by its name. Throws Error where there is not one.
int named_component(const VolumeFile& file, const std::string& wanted) {
  const std::vector<std::string>& names = file.component_names;
  if (std::ranges::count(names, wanted) == 1) {
    return static_cast<int>(std::ranges::find(names, wanted) - names.begin());
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw Error(file.description.name + ": " +
              (std::ranges::count(names, wanted) > 1 ? "more than one" : "no") +
              " component is called \"" + printable(wanted) + "\"" +
              (names.empty()
                   ? "; its components have no names, give a number, " + choices(file)
                   : "; their names are " + printable(list) + ", their numbers " + choices(file)));
}

/// Returns the component that the options name, or their time; nothing where they name none. Throws
/// Error.
std::optional<int> chosen_component(const VolumeFile& file, const ReadOptions& options) {
  if (!options.component && options.component_name) {
    return named_component(file, *options.component_name);
  }
  if (!options.component) return file.step;
  const int component = *options.component;
  if (component >= 0 && component < file.components) return component;
  throw Error(file.description.name + ": there is no component " + std::to_string(component) +
              (file.components == 1
                   ? "; the file has one number at each point, component 0"
                   : "; the file holds " + file.holds + ", components " + choices(file)));
}

/// Components that lie side by side, some points at a time.
std::vector<VolumeData> read_interleaved(const ReadOn& read, const ValueLayout& layout,
                                         std::size_t points, ComponentRange range,
                                         const std::string& name) {
  const auto number = static_cast<std::size_t>(range.number);
  const auto stride = static_cast<std::size_t>(layout.components);
  constexpr std::size_t values_at_once = std::size_t{1} << 16;
  const std::size_t largest_part =
      std::min(std::max<std::size_t>(values_at_once / stride, 1), points);
  // A header may name any number of components, and a compressed file need not hold them.
  check_memory(
      (std::uintmax_t{points} * number + largest_part * stride) * value_size(layout.type, name) +
          number * sizeof(VolumeData),
      name + ": its values");
  std::vector<VolumeData> list;
  list.reserve(number);
  for (std::size_t c = 0; c < number; ++c) list.push_back(make_values(layout.type, points, name));
  std::visit(
      [&](const auto& of_type) {
        using Value = typename std::decay_t<decltype(of_type)>::value_type;
        std::vector<std::span<Value>> to;
        to.reserve(number);
        for (VolumeData& data : list) to.push_back(std::get<DataArray<Value>>(data).writable());
        const auto begin = static_cast<std::size_t>(range.first);
        for (std::size_t done = 0; done < points; done += largest_part) {
          const std::size_t part = std::min(largest_part, points - done);
          VolumeData side_by_side = DataArray<Value>(part * stride);
          const std::span<Value> values = std::get<DataArray<Value>>(side_by_side).writable();
          read(std::as_writable_bytes(values));
          to_native_order(side_by_side, layout.big_endian);
          for (std::size_t c = 0; c < number; ++c) {
            for (std::size_t i = 0; i < part; ++i) to[c][done + i] = values[i * stride + begin + c];
          }
        }
      },
      make_volume_data(layout.type, 0));
  return list;
}

/// Half floats of one component, as floats.
class Halves {
 public:
  using Stored = std::uint16_t;
  explicit Halves(const MakeValues& make) : values_(make("f32")) {}

  void add(std::span<const Stored> numbers) {
    const std::span<float> to = std::get<DataArray<float>>(values_).writable();
    for (const Stored number : numbers) to[done_++] = half_to_float(number);
  }
  VolumeData take() { return std::move(values_); }

 private:
  VolumeData values_;
  std::size_t done_ = 0;
};

/// Reads what the layout says lies side by side, or of one component, into the collectors of some
/// components, those from `first` on.
template <class Stored, class Collector>
void collect(const ReadOn& read, bool big_endian, std::size_t points, std::size_t stride,
             std::size_t first, std::span<Collector> collectors) {
  constexpr std::size_t values_at_once = std::size_t{1} << 16;
  const std::size_t at_once = std::min(std::max<std::size_t>(values_at_once / stride, 1), points);
  const bool swapped = big_endian == (std::endian::native == std::endian::little);
  std::vector<Stored> part(at_once * stride), component(at_once);
  for (std::size_t done = 0; done < points; done += at_once) {
    const std::size_t count = std::min(at_once, points - done);
    const std::span<Stored> numbers = std::span(part).first(count * stride);
    read(std::as_writable_bytes(numbers));
    if (swapped) {
      for (Stored& number : numbers) {
        auto bytes = std::bit_cast<std::array<std::byte, sizeof(Stored)>>(number);
        std::ranges::reverse(bytes);
        number = std::bit_cast<Stored>(bytes);
      }
    }
    for (std::size_t c = 0; c < collectors.size(); ++c) {
      for (std::size_t i = 0; i < count; ++i) component[i] = numbers[i * stride + first + c];
      collectors[c].add(std::span<const Stored>(component).first(count));
    }
  }
}

/// Reads values of a type that volumes do not have.
template <class Stored, class Collector>
std::vector<Collector> collect_components(const ReadOn& read, const ValueLayout& layout,
                                          std::size_t points, ComponentRange range,
                                          const MakeValues& make, const std::string& name) {
  const auto number = static_cast<std::size_t>(range.number);
  const auto stride = static_cast<std::size_t>(layout.interleaved ? layout.components : 1);
  // One byte of each is the least that is kept.
  check_memory(std::uintmax_t{points} * number + number * sizeof(Collector) +
                   std::uintmax_t{stride} * sizeof(Stored),
               name + ": its values");
  std::vector<Collector> collectors;
  collectors.reserve(number);
  for (std::size_t c = 0; c < number; ++c) collectors.emplace_back(make);
  if (stride > 1) {
    collect<Stored>(read, layout.big_endian, points, stride, static_cast<std::size_t>(range.first),
                    std::span(collectors));
  } else {
    for (Collector& collector : collectors) {
      collect<Stored>(read, layout.big_endian, points, 1, 0, std::span(&collector, 1));
    }
  }
  return collectors;
}

template <class Collector>
std::vector<VolumeData> take_each(std::vector<Collector>& components) {
  std::vector<VolumeData> list;
  list.reserve(components.size());
  for (Collector& component : components) list.push_back(component.take());
  return list;
}

/// Halves are of one type as they are.
std::vector<VolumeData> take_components(std::vector<Halves>& components, std::size_t,
                                        const std::string&,
                                        const std::function<void(const std::string&)>&) {
  return take_each(components);
}

template <class Stored, class Collector>
std::vector<VolumeData> read_as(const ReadOn& read, const ValueLayout& layout, std::size_t points,
                                ComponentRange range, const std::string& name) {
  const auto make = [&](const std::string& type) { return make_values(type, points, name); };
  auto components = collect_components<Stored, Collector>(read, layout, points, range, make, name);
  return take_components(components, points, name, layout.note);
}

/// Reads components of types that files alone have. `read` stands at the first value of all, or of
/// the first component of the range where they lie one behind the other.
std::vector<VolumeData> read_stored_only(const ReadOn& read, const ValueLayout& layout,
                                         std::size_t points, ComponentRange range,
                                         const std::string& name) {
  if (layout.type == "f16")
    return read_as<std::uint16_t, Halves>(read, layout, points, range, name);
  if (layout.type == "i64") {
    return read_as<std::int64_t, WholeNumbers>(read, layout, points, range, name);
  }
  return read_as<std::uint64_t, WholeNumbers>(read, layout, points, range, name);
}

}  // namespace

Volume read_chosen(const VolumeFile& file, const ReadOptions& options) {
  if (asks_for_color_opacity(file, options)) {
    const std::optional<GridPart> part = wanted_part(file, options);
    return make_volume(file, 0, color_opacity_of(file, part ? &*part : nullptr), part);
  }
  const std::optional<int> chosen = chosen_component(file, options);
  if (!chosen && file.components > 1) {
    throw Error(file.description.name + ": holds " + file.holds +
                ", but one number at each point is needed; choose a " +
                (file.times.empty() ? "" : "time, or a ") + "component, " + choices(file) +
                ", or save one of them as a file of its own");
  }
  const int component = chosen.value_or(0);
  const std::optional<GridPart> part = wanted_part(file, options);
  std::vector<VolumeData> data = file.read({component, 1, part ? &*part : nullptr});
  return make_volume(file, component, std::move(data.front()), part);
}

std::vector<Volume> read_all(const VolumeFile& file, const ReadOptions& options) {
  const std::optional<GridPart> part = wanted_part(file, options);
  ComponentRange range{0, file.components, part ? &*part : nullptr};
  if (const std::optional<int> chosen = chosen_component(file, options)) {
    range.first = *chosen;
    range.number = 1;
  }
  std::vector<Volume> volumes;
  int component = range.first;
  for (VolumeData& data : file.read(range)) {
    volumes.push_back(make_volume(file, component++, std::move(data), part));
  }
  return volumes;
}

std::vector<VolumeData> take_components(std::vector<WholeNumbers>& components, std::size_t points,
                                        const std::string& name,
                                        const std::function<void(const std::string&)>& note) {
  Rounding rounding;
  for (const WholeNumbers& component : components) rounding.merge(component.rounding());
  unify(components);
  if (rounding.count > 0 && note) {
    note(name + ": " + rounding.text(points * components.size()));
  }
  return take_each(components);
}

ReadOn read_on(const ByteSource& source, std::uintmax_t from) {
  return [&source, from](std::span<std::byte> to) mutable {
    source.read(from, to);
    from += to.size();
  };
}

std::size_t value_count(std::size_t points, int components, const std::string& name) {
  // So many values of 8 bytes are still a number of bytes.
  constexpr std::size_t largest = std::numeric_limits<std::size_t>::max() / 16 + 1;
  if (points > largest / static_cast<std::size_t>(components)) {
    throw Error(name + ": a volume of " + std::to_string(points) + " points with " +
                std::to_string(components) + " components each is too large");
  }
  return points * static_cast<std::size_t>(components);
}

std::vector<VolumeData> split_components(const VolumeData& values, int components,
                                         ComponentRange range, const std::string& name) {
  if (components == 1) return {values};
  return std::visit(
      [&](const auto& all) {
        using Value = typename std::decay_t<decltype(all)>::value_type;
        const auto stride = static_cast<std::size_t>(components);
        const std::size_t points = all.size() / stride;
        check_memory(
            std::uintmax_t{points} * sizeof(Value) * static_cast<std::uintmax_t>(range.number),
            name + ": its values");
        std::vector<VolumeData> list;
        list.reserve(static_cast<std::size_t>(range.number));
        for (int c = range.first; c < range.first + range.number; ++c) {
          DataArray<Value> component(points);
          const std::span<Value> to = component.writable();
          for (std::size_t i = 0; i < points; ++i) {
            to[i] = all[i * stride + static_cast<std::size_t>(c)];
          }
          list.emplace_back(std::move(component));
        }
        return list;
      },
      values);
}

bool reads_parts(const ValueLayout& layout) {
  return !is_stored_only(layout.type) && !(layout.interleaved && layout.components > 1);
}

std::vector<VolumeData> read_components(const ByteSource& source, const ValueLayout& layout,
                                        std::size_t points, ComponentRange range) {
  const bool interleaved = layout.interleaved && layout.components > 1;
  const std::uintmax_t bytes = std::uintmax_t{points} * value_size(layout.type, source.name);
  if (is_stored_only(layout.type)) {
    const std::uintmax_t before =
        interleaved ? 0 : bytes * static_cast<std::uintmax_t>(range.first);
    return read_stored_only(read_on(source, layout.offset + before), layout, points, range,
                            source.name);
  }
  if (interleaved) {
    return read_interleaved(read_on(source, layout.offset), layout, points, range, source.name);
  }
  std::vector<VolumeData> list;
  for (int c = range.first; c < range.first + range.number; ++c) {
    const std::uintmax_t offset = layout.offset + bytes * static_cast<std::uintmax_t>(c);
    const ValueLayout own{layout.type, layout.big_endian, offset};
    list.push_back(range.part != nullptr ? read_part(source, own, *range.part)
                                         : read_values(source, own, points));
  }
  return list;
}

std::vector<VolumeData> read_components(DataStream& stream, const ValueLayout& layout,
                                        std::size_t points, ComponentRange range) {
  const ReadOn read = [&](std::span<std::byte> to) { stream.read(to); };
  if (layout.interleaved && layout.components > 1) {
    return is_stored_only(layout.type)
               ? read_stored_only(read, layout, points, range, stream.name())
               : read_interleaved(read, layout, points, range, stream.name());
  }
  const std::uintmax_t bytes = std::uintmax_t{points} * value_size(layout.type, stream.name());
  std::vector<VolumeData> list;
  stream.skip(bytes * static_cast<std::uintmax_t>(range.first));
  if (is_stored_only(layout.type)) {
    list = read_stored_only(read, layout, points, range, stream.name());
  } else {
    list.reserve(static_cast<std::size_t>(range.number));
    for (int c = 0; c < range.number; ++c) list.push_back(read_values(stream, layout, points));
  }
  const int rest = layout.components - range.first - range.number;
  stream.skip(bytes * static_cast<std::uintmax_t>(rest));
  return list;
}

}  // namespace pellucid
