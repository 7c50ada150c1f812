// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid::answer_json {

/// Parts of answers that go from process to process as CBOR. Readers throw json::exception.

using nlohmann::json;

inline json of_vector(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}

inline Vec3<double> vector_of(const json& v) {
  return {v.at(0), v.at(1), v.at(2)};
}

// Names need not be UTF-8, which CBOR's bytes do not mind and its text does.
inline json of_text(const std::string& text) {
  return json::binary(std::vector<std::uint8_t>(text.begin(), text.end()));
}

inline std::string text_of(const json& text) {
  const auto& bytes = text.get_binary();
  return {bytes.begin(), bytes.end()};
}

/// Writes an answer with its size in front. Returns false if there is too little room.
inline bool write_answer(const json& answer, std::span<std::byte> to) {
  const std::vector<std::uint8_t> bytes = json::to_cbor(answer);
  const std::uint64_t size = bytes.size();
  if (to.size() < sizeof(size) || to.size() - sizeof(size) < size) return false;
  std::memcpy(to.data(), &size, sizeof(size));
  std::memcpy(to.data() + sizeof(size), bytes.data(), size);
  return true;
}

inline json of_placement(const GridPlacement& p) {
  return {of_vector(p.origin), of_vector(p.spacing), of_vector(p.direction.column[0]),
          of_vector(p.direction.column[1]), of_vector(p.direction.column[2])};
}

inline GridPlacement placement_of(const json& p) {
  GridPlacement placement{vector_of(p.at(0)), vector_of(p.at(1)), {}};
  for (int a = 0; a < 3; ++a) {
    placement.direction.column[a] = vector_of(p.at(static_cast<std::size_t>(a) + 2));
  }
  return placement;
}

}  // namespace pellucid::answer_json
