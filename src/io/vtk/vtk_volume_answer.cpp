// SPDX-License-Identifier: Apache-2.0
//
// The bytes: the length of a head (8), the head in CBOR, and from the next multiple of 64 on
// values.
#include "vtk_volume_answer.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "pellucid/scene/error.h"
#include "process/answer_json.h"
#include "process/child_values.h"

namespace pellucid {

namespace {

using namespace answer_json;

std::size_t values_begin(std::size_t head) {
  constexpr std::size_t alignment = 64;
  return (sizeof(std::uint64_t) + head + alignment - 1) / alignment * alignment;
}

void write(const json& head, std::span<const std::byte> values, const MakeAnswer& make) {
  const std::vector<std::uint8_t> bytes = json::to_cbor(head);
  const std::uint64_t size = bytes.size();
  const std::span<std::byte> to = make(values_begin(size) + values.size());
  std::memcpy(to.data(), &size, sizeof(size));
  std::memcpy(to.data() + sizeof(size), bytes.data(), size);
  std::ranges::copy(values, to.subspan(values_begin(size)).begin());
}

/// Throws json::exception where no head stands there.
json head_of(std::span<const std::byte> bytes) {
  std::uint64_t size = 0;
  if (bytes.size() >= sizeof(size)) std::memcpy(&size, bytes.data(), sizeof(size));
  if (size > bytes.size() || values_begin(size) > bytes.size()) size = 0;
  const auto* const from = reinterpret_cast<const std::uint8_t*>(bytes.data()) + sizeof(size);
  return json::from_cbor(from, from + size);
}

json of_statistics(const VolumeStatistics& s) {
  return {s.minimum, s.maximum, s.finite, s.nan, s.infinite};
}

VolumeStatistics statistics_of(const json& j) {
  return {j.at(0), j.at(1), j.at(2), j.at(3), j.at(4)};
}

Centering centering_of(const json& is_cell) {
  return is_cell.get<bool>() ? Centering::cell : Centering::point;
}

/// Returns whether nothing is read outside of the values.
bool agrees_with_itself(const OpenedVtkVolume& opened, std::size_t count) {
  const Volume::Description& d = opened.description;
  std::size_t places = static_cast<std::size_t>(std::max(opened.components, 1));
  for (std::size_t a = 0; a < 3; ++a) {
    if (d.dimensions[a] < 1) return false;
    const auto side = static_cast<std::size_t>(d.dimensions[a]);
    if (places > std::numeric_limits<std::size_t>::max() / side) return false;
    places *= side;
    const std::size_t positions = side + (d.centering == Centering::cell ? 1 : 0);
    if (!d.coordinates[a].empty() && d.coordinates[a].size() != positions) return false;
  }
  return opened.components > 0 && (opened.reads_parts || places == count);
}

}  // namespace

void write_opened(const OpenedVtkVolume& opened, const MakeAnswer& make) {
  const Volume::Description& d = opened.description;
  std::visit(
      [&](const auto& values) {
        write({{"dimensions", d.dimensions},
               {"cell", d.centering == Centering::cell},
               {"placement", of_placement(d.placement)},
               {"coordinates", d.coordinates},
               {"components", opened.components},
               {"array", of_text(opened.array)},
               {"times", opened.times},
               {"notes", opened.notes},
               {"type", opened.type},
               {"reads_parts", opened.reads_parts},
               {"count", values.size()}},
              std::as_bytes(std::span(values.data(), values.size())), make);
      },
      opened.values);
}

std::optional<OpenedVtkVolume> read_opened(const ChildBytes& bytes, const std::string& name) {
  try {
    const json head = head_of(bytes.span());
    OpenedVtkVolume opened;
    opened.description.name = name;
    head.at("dimensions").get_to(opened.description.dimensions);
    opened.description.centering = centering_of(head.at("cell"));
    opened.description.placement = placement_of(head.at("placement"));
    head.at("coordinates").get_to(opened.description.coordinates);
    head.at("components").get_to(opened.components);
    opened.array = text_of(head.at("array"));
    head.at("times").get_to(opened.times);
    head.at("notes").get_to(opened.notes);
    head.at("type").get_to(opened.type);
    head.at("reads_parts").get_to(opened.reads_parts);
    const std::size_t count = head.at("count");
    if (!agrees_with_itself(opened, count)) return std::nullopt;
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data.get(), sizeof(size));
    const std::size_t begin = values_begin(size);
    if (begin > bytes.size || count > (bytes.size - begin) / value_size(opened.type, name)) {
      return std::nullopt;
    }
    opened.values = child_values(bytes.data, begin, count, opened.type);
    return opened;
  } catch (const json::exception&) {
    return std::nullopt;
  } catch (const Error&) {  // no type of that name
    return std::nullopt;
  }
}

void write_arrays(const std::vector<VolumeArray>& arrays, const MakeAnswer& make) {
  json list = json::array();
  for (const VolumeArray& array : arrays) {
    json components = json::array();
    for (const VolumeStatistics& s : array.components) components.push_back(of_statistics(s));
    list.push_back({{"name", of_text(array.name)},
                    {"cell", array.centering == Centering::cell},
                    {"type", array.type},
                    {"dimensions", array.dimensions},
                    {"components", components},
                    {"default", array.is_default}});
  }
  write(list, {}, make);
}

std::optional<std::vector<VolumeArray>> read_arrays(const ChildBytes& bytes) {
  try {
    std::vector<VolumeArray> arrays;
    for (const json& j : head_of(bytes.span())) {
      VolumeArray array;
      array.name = text_of(j.at("name"));
      array.centering = centering_of(j.at("cell"));
      j.at("type").get_to(array.type);
      j.at("dimensions").get_to(array.dimensions);
      for (const json& s : j.at("components")) array.components.push_back(statistics_of(s));
      j.at("default").get_to(array.is_default);
      arrays.push_back(std::move(array));
    }
    return arrays;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

}  // namespace pellucid
