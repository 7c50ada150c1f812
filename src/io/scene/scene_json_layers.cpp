// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "read_fields.h"
#include "scene_json_parts.h"

namespace pellucid::scene_json {
namespace {

/// Labels of a file are 24 bits: LabelVolume.
constexpr long long largest_label = 1 << 24;

std::int32_t label_of(const Node& node) {
  return static_cast<std::int32_t>(node.integer(-largest_label, largest_label));
}

LabelStyle label_style(const Node& node, bool srgb) {
  node.expect_object({"label", "name", "color", "extinction"});
  LabelStyle style;
  style.label = label_of(node.at("label", "give the number of the label"));
  if (const auto name = node.find("name")) style.name = name->string();
  style.color = color_of(node.at("color", "give [r, g, b]"), srgb);
  style.extinction =
      node.at("extinction", "give a number, 1/length in world units").number(0, largest_number);
  return style;
}

Clip clip_of(const Node& node) {
  node.expect_object({"plane", "box", "sphere", "cylinder", "keep"});
  Clip clip;
  int shapes = 0;
  for (std::size_t i = 0; i < std::size(scene_fields::clip_shapes); ++i) {
    const auto found = node.find(scene_fields::clip_shapes[i]);
    if (!found) continue;
    clip.shape = scene_fields::alternative<decltype(Clip::shape)>(i);
    std::visit([&](auto& shape) { shape = read_fields(*found, shape); }, clip.shape);
    ++shapes;
  }
  if (shapes != 1) {
    node.fail("needs one of \"plane\", \"box\", \"sphere\" and \"cylinder\"");
  }
  if (const auto keep = node.find("keep")) {
    clip.keep_inside = keep->one_of({"inside", "outside"}) == 0;
  }
  checked(node, [&] { check_clip(clip, "clip"); });
  return clip;
}

}  // namespace

LabelSource label_source(const Node& labels, const std::filesystem::path& folder) {
  LabelSource source;
  source.field =
      field_source_beside(labels, folder, {"colors", "color_space", "table", "extinction"});
  if (const auto table = labels.find("table")) source.table = file_path(*table, folder);
  if (const auto extinction = labels.find("extinction")) {
    source.extinction = extinction->number(0, largest_number);
  }
  const auto colors = labels.find("colors");
  if (!colors) {
    if (labels.has("color_space")) labels.fail_at("color_space", "needs \"colors\" beside it");
    return source;
  }
  const bool srgb = is_srgb(labels);
  source.styles = list_of(*colors, [&](const Node& node) { return label_style(node, srgb); });
  if (source.styles.empty()) colors->fail("is empty; give one label at least");
  checked(*colors, [&] { return LabelTable(source.styles); });
  return source;
}

MaskSource mask_source(const Node& mask, const std::filesystem::path& folder) {
  MaskSource source;
  source.field = field_source_beside(mask, folder, {"functions"});
  const Node functions = mask.at("functions", "give one for each label that has its own");
  for (std::size_t i = 0; i < functions.array_size(); ++i) {
    const Node node = functions.element(i);
    node.expect_object({"label", "transfer_function"});
    MaskSource::Choice choice;
    const Node label = node.at("label", "give the number of the label");
    choice.label = label_of(label);
    for (const MaskSource::Choice& other : source.choices) {
      if (other.label == choice.label) label.fail("stands twice; keep one of them");
    }
    const Node function = node.at("transfer_function", "give that of the label");
    choice.transfer_function = transfer_function(function);
    if (std::holds_alternative<MultivariateDescription>(choice.transfer_function)) {
      function.fail("is of several variables, but a mask chooses among functions of one");
    }
    source.choices.push_back(std::move(choice));
  }
  if (source.choices.empty()) functions.fail("is empty; give one label at least");
  return source;
}

std::vector<Clip> clips(const Node& list) {
  return list_of(list, clip_of);
}

Affine<double> affine_map(const Node& rows) {
  Affine<double> map;
  const std::array<Node, 3> row = three(rows);
  for (int r = 0; r < 3; ++r) {
    const Node& numbers = row[static_cast<std::size_t>(r)];
    if (numbers.array_size() != 4) {
      numbers.fail("must have 4 numbers, but has " + std::to_string(numbers.array_size()));
    }
    for (int c = 0; c < 3; ++c) {
      map.matrix.column[c][r] = numbers.element(static_cast<std::size_t>(c)).number();
    }
    map.translation[r] = numbers.element(3).number();
  }
  return map;
}

}  // namespace pellucid::scene_json
