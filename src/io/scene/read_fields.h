// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "scene_fields.h"
#include "scene_json_parts.h"

namespace pellucid::scene_json {

/// Returns the names of all fields of a part.
template <class Part>
std::vector<std::string_view> keys_of(const Part& part) {
  std::vector<std::string_view> names;
  scene_fields::visit_fields(part, [&](const scene_fields::Key& key, const auto&, const auto&) {
    names.emplace_back(key.name);
  });
  return names;
}

/// Reads fields from a JSON object. Throws Error with the pointer of the key.
class FieldReader {
 public:
  explicit FieldReader(const Node& node) : node_(&node) {}

  template <class Member, class Kind>
  void operator()(const scene_fields::Key& key, Member& member, const Kind& kind) const {
    if (!key.applies) return;
    const auto node = key.hint != nullptr ? node_->at(key.name, key.hint) : node_->find(key.name);
    if (!node) return;
    if constexpr (std::is_same_v<Kind, scene_fields::Number>) {
      member = kind.ends == Ends::open          ? node->number_between(kind.least, kind.most)
               : kind.ends == Ends::above_least ? node->positive_number(kind.most)
                                                : node->number(kind.least, kind.most);
    } else if constexpr (std::is_same_v<Kind, scene_fields::InPlace>) {
      if (node_->has(kind.other)) {
        node->fail(std::string("stands beside \"") + kind.other + "\"; give one of the two");
      }
      member = node->positive_number(kind.most);
    } else if constexpr (std::is_same_v<Kind, scene_fields::Vector>) {
      member = kind.is_direction ? direction(*node) : vector(*node);
    } else if constexpr (std::is_same_v<Kind, scene_fields::Color>) {
      member = linear_rgb(*node, kind.most);
    } else if constexpr (std::is_same_v<Kind, scene_fields::Choice>) {
      member = static_cast<Member>(node->one_of({kind.names.begin(), kind.names.end()}));
    } else if constexpr (std::is_same_v<Kind, scene_fields::Channel>) {
      member = channel_name(*node);
    } else {
      static_assert(std::is_same_v<Kind, scene_fields::Colors>);
      read_colors(*node, member.colors, member.written_colors);
    }
  }

 private:
  using Ends = scene_fields::Number::Ends;

  const Node* node_;
};

/// Reads a part from an object that has no keys but its fields. Throws Error.
template <class Part>
Part read_fields(const Node& node, Part part = {}) {
  node.expect_object(keys_of(part));
  scene_fields::visit_fields(part, FieldReader(node));
  return part;
}

}  // namespace pellucid::scene_json
