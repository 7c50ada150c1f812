// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/color_map.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "color_map_table.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/srgb.h"

namespace pellucid {
namespace {

/// Returns a name without what does not matter.
std::string plain(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) text += static_cast<char>(std::tolower(byte));
  }
  if (const std::size_t at = text.find("gray"); at != std::string::npos) text[at + 2] = 'e';
  return text == "greyscale" ? "grey" : text;
}

bool is_reversed(std::string_view name) {
  return name.size() > 2 && (name.ends_with("_r") || name.ends_with("_R"));
}

const NamedColorMap* find(std::string_view name) {
  const std::string wanted = plain(name);
  for (const NamedColorMap& map : color_map_table()) {
    if (plain(map.name) == wanted) return &map;
  }
  return nullptr;
}

/// Returns the share of pairs of neighboring letters that two names have in common (Dice 1945).
double likeness(const std::string& a, const std::string& b) {
  if (a.size() < 2 || b.size() < 2) return a == b ? 1 : 0;
  std::vector<std::string> pairs;
  for (std::size_t i = 0; i + 1 < b.size(); ++i) pairs.push_back(b.substr(i, 2));
  std::size_t common = 0;
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    const auto found = std::find(pairs.begin(), pairs.end(), a.substr(i, 2));
    if (found == pairs.end()) continue;
    pairs.erase(found);
    ++common;
  }
  return 2 * static_cast<double>(common) / static_cast<double>(a.size() + b.size() - 2);
}

/// Returns what the message says of a name that no map has.
std::string known_names(std::string_view name) {
  constexpr double near = 0.4;
  constexpr std::size_t most = 4;
  const std::string wanted = plain(name);
  std::vector<std::pair<double, std::string>> found;
  for (const NamedColorMap& map : color_map_table()) {
    const double like = likeness(wanted, plain(map.name));
    if (like >= near) found.emplace_back(-like, map.name);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (found.size() > most) found.resize(most);
  std::string text;
  for (const auto& [like, near_name] : found) text += (text.empty() ? "" : ", ") + near_name;
  if (!text.empty()) return "; did you mean " + text + "?";
  for (const std::string& known : color_map_names()) text += (text.empty() ? "" : ", ") + known;
  return "; there are " + text + ", and each with _r behind it, reversed";
}

}  // namespace

std::vector<std::string> color_map_names() {
  std::vector<std::string> names;
  for (const NamedColorMap& map : color_map_table()) names.emplace_back(map.name);
  return names;
}

bool is_color_map(std::string_view name) noexcept {
  return find(is_reversed(name) ? name.substr(0, name.size() - 2) : name) != nullptr;
}

ColorMap color_map(std::string_view name) {
  constexpr double positions = 2040, signals = 2550;
  const bool backwards = is_reversed(name);
  const NamedColorMap* named = find(backwards ? name.substr(0, name.size() - 2) : name);
  if (named == nullptr) {
    throw Error("color map: there is none of the name \"" + std::string(name.substr(0, 64)) + "\"" +
                known_names(name.substr(0, 64)));
  }
  const auto& numbers = named->numbers;
  ColorMap map;
  for (std::size_t i = 0; i + 3 < numbers.size(); i += 4) {
    const Rgb<double> signal{numbers[i + 1] / signals, numbers[i + 2] / signals,
                             numbers[i + 3] / signals};
    map.push_back({numbers[i] / positions, srgb_to_linear(signal)});
  }
  return backwards ? reversed(map) : map;
}

ColorMap reversed(const ColorMap& map) {
  ColorMap made;
  for (auto point = map.rbegin(); point != map.rend(); ++point) {
    made.push_back({1 - point->position, point->color});
  }
  return made;
}

Rgb<double> color_at(const ColorMap& map, double position) noexcept {
  if (map.empty()) return {};
  if (!(position > map.front().position)) return map.front().color;
  const auto after = std::find_if(map.begin(), map.end(), [&](const ColorMapPoint& point) {
    return point.position > position;
  });
  if (after == map.end()) return map.back().color;
  const ColorMapPoint& a = *(after - 1);
  const double share = (position - a.position) / (after->position - a.position);
  return a.color + share * (after->color - a.color);
}

}  // namespace pellucid
