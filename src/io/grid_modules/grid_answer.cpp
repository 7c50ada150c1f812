// SPDX-License-Identifier: Apache-2.0
#include "grid_answer.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "process/answer_json.h"

namespace pellucid {

namespace {

using namespace answer_json;

json of_positions(const AxisPositions& along) {
  return {{"numbers", along.numbers},    {"rounding", along.rounding},
          {"name", of_text(along.name)}, {"units", of_text(along.units)},
          {"down", along.down},          {"may_be_down", along.may_be_down}};
}

AxisPositions positions_of(const json& j) {
  AxisPositions along;
  j.at("numbers").get_to(along.numbers);
  j.at("rounding").get_to(along.rounding);
  along.name = text_of(j.at("name"));
  along.units = text_of(j.at("units"));
  j.at("down").get_to(along.down);
  j.at("may_be_down").get_to(along.may_be_down);
  return along;
}

json of_array(const GridArray& array) {
  json j{{"name", of_text(array.name)},
         {"type", array.type},
         {"type_with_missing", array.type_with_missing},
         {"sides", array.sides},
         {"components", array.components},
         {"holds", of_text(array.holds)},
         {"times", array.times},
         {"times_unit", of_text(array.times_unit)},
         {"components_of_a_step", array.components_of_a_step},
         {"positions", json::array()},
         {"notes", json::array()},
         {"reads_parts", array.reads_parts}};
  for (const AxisPositions& along : array.positions) j["positions"].push_back(of_positions(along));
  for (const std::string& note : array.notes) j["notes"].push_back(of_text(note));
  if (array.placement) j["placement"] = of_placement(*array.placement);
  return j;
}

GridArray array_of(const json& j) {
  GridArray array;
  array.name = text_of(j.at("name"));
  j.at("type").get_to(array.type);
  j.at("type_with_missing").get_to(array.type_with_missing);
  j.at("sides").get_to(array.sides);
  j.at("components").get_to(array.components);
  array.holds = text_of(j.at("holds"));
  j.at("times").get_to(array.times);
  array.times_unit = text_of(j.at("times_unit"));
  j.at("components_of_a_step").get_to(array.components_of_a_step);
  for (std::size_t a = 0; a < 3; ++a) array.positions[a] = positions_of(j.at("positions").at(a));
  for (const json& note : j.at("notes")) array.notes.push_back(text_of(note));
  j.at("reads_parts").get_to(array.reads_parts);
  if (j.contains("placement")) array.placement = placement_of(j.at("placement"));
  return array;
}

}  // namespace

bool write_grid_contents(const GridContents& contents, std::span<std::byte> to) {
  json j{{"arrays", json::array()}, {"others", json::array()}, {"error", of_text(contents.error)}};
  for (const GridArray& array : contents.arrays) j["arrays"].push_back(of_array(array));
  for (const GridOther& other : contents.others) {
    j["others"].push_back({of_text(other.name), of_text(other.is)});
  }
  return write_answer(j, to);
}

std::optional<GridContents> read_grid_contents(std::span<const std::byte> from) {
  std::uint64_t size = 0;
  if (from.size() < sizeof(size)) return std::nullopt;
  std::memcpy(&size, from.data(), sizeof(size));
  if (size > from.size() - sizeof(size)) return std::nullopt;
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(from.data() + sizeof(size));
  try {
    const json j = json::from_cbor(bytes, bytes + size);
    GridContents contents;
    for (const json& array : j.at("arrays")) contents.arrays.push_back(array_of(array));
    for (const json& other : j.at("others")) {
      contents.others.push_back({text_of(other.at(0)), text_of(other.at(1))});
    }
    contents.error = text_of(j.at("error"));
    return contents;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

}  // namespace pellucid
