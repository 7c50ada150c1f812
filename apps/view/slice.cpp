// SPDX-License-Identifier: Apache-2.0
#include "slice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "histograms.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/srgb.h"
#include "server/page_messages.h"

namespace pellucid::view {

namespace {

/// Looks of the labels that a layer shows.
class LabelLooks {
 public:
  explicit LabelLooks(const Layer& layer) {
    if (const auto* labels = std::get_if<LabelContent>(&layer.content)) {
      for (const LabelStyle& style : labels->table->styles()) {
        if (style.extinction > 0) looks_.emplace(style.label, style);
      }
    }
    const auto* volume = std::get_if<VolumeContent>(&layer.content);
    if (volume == nullptr || !volume->mask) return;
    const LabelTable table = default_label_table(volume->mask->labels());
    for (const LabelStyle& style : table.styles()) {
      if (style.label != 0 && volume->mask->choice_of(style.label) >= 0) {
        looks_.emplace(style.label, style);
      }
    }
  }

  /// Returns the look of a label, which lives as long as this; null: it is transparent.
  const LabelStyle* find(std::int32_t label) const& {
    const auto found = looks_.find(label);
    return found == looks_.end() ? nullptr : &found->second;
  }
  const LabelStyle* find(std::int32_t label) const&& = delete;

 private:
  std::unordered_map<std::int32_t, LabelStyle> looks_;
};

std::string hex_color(const Rgb<double>& linear) {
  const auto byte = [](double light) {
    return std::lround(255 * linear_to_srgb(std::clamp(light, 0.0, 1.0)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(linear.r), byte(linear.g), byte(linear.b));
}

Json label_json(const SliceLabel& label) {
  return {{"layer", label.layer},
          {"label", label.label},
          {"name", label.name},
          {"color", hex_color(label.color)}};
}

void add_labels(const Layer& layer, std::size_t index, const LayerValues& values,
                const SlicePlane& plane, const ParallelFor& parallel, SlicePicture& picture) {
  if (picture.labels.empty()) picture.labels.resize(plane.count());
  const LabelLooks looks(layer);
  std::unordered_map<std::int32_t, std::uint16_t> numbers;
  const auto number_of = [&](std::int32_t label) -> std::uint16_t {
    const auto known = numbers.find(label);
    if (known != numbers.end()) return known->second;
    const LabelStyle* const look = looks.find(label);
    std::uint16_t number = 0;
    if (look != nullptr && picture.shown.size() < std::numeric_limits<std::uint16_t>::max()) {
      picture.shown.push_back({index, label, look->name, look->color});
      number = static_cast<std::uint16_t>(picture.shown.size());
    }
    return numbers[label] = number;
  };
  std::vector<std::int32_t> labels(plane.count());
  values.fill_labels(plane, parallel, labels);
  std::int32_t last = LayerValues::no_label;
  std::uint16_t number = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == LayerValues::no_label) continue;
    if (labels[i] != last) number = number_of(last = labels[i]);
    if (number != 0) picture.labels[i] = number;
  }
}

template <class Value>
std::string_view bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

}  // namespace

SlicePicture make_slice(const Scene& scene, const AskSlice& ask, const ParallelFor& parallel) {
  SlicePicture picture;
  if (ask.layer) {
    if (*ask.layer >= scene.layers.size()) {
      throw Error(fmt::format("slice: there is no layer {}", *ask.layer + 1));
    }
    const Layer& layer = scene.layers[*ask.layer];
    const bool is_of_labels = std::holds_alternative<LabelContent>(layer.content);
    if (is_of_labels || ask.channel >= channels_of(layer)) {
      throw Error(fmt::format("slice: layer {} has no values of a channel {}", *ask.layer + 1,
                              ask.channel));
    }
    picture.values.resize(ask.plane.count());
    LayerValues(layer).fill(ask.channel, ask.plane, parallel, picture.values);
  }
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    if (!scene.layers[i].visible) continue;
    const LayerValues values(scene.layers[i]);
    if (values.has_labels()) add_labels(scene.layers[i], i, values, ask.plane, parallel, picture);
  }
  return picture;
}

PageMessage slice_message(const Scene& scene, const AskSlice& ask, const ParallelFor& parallel) {
  const SlicePicture picture = make_slice(scene, ask, parallel);
  const SlicePlane& plane = ask.plane;
  Json header{{"type", "slice"},
              {"axis", plane.axis},
              {"position", plane.position},
              {"from", plane.from},
              {"to", plane.to},
              {"columns", plane.columns},
              {"rows", plane.rows},
              {"values", ask.layer.has_value()}};
  if (ask.layer) {
    header["layer"] = *ask.layer;
    header["channel"] = ask.channel;
  }
  if (!picture.labels.empty()) {
    header["labels"] = Json::array();
    for (const SliceLabel& label : picture.shown) header["labels"].push_back(label_json(label));
  }
  return binary_message(header, {bytes_of(picture.values), bytes_of(picture.labels)});
}

Json located_json(const Scene& scene, const Locate& at) {
  Json values = Json::array(), labels = Json::array(), voxels = Json::array();
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const Layer& layer = scene.layers[i];
    if (!layer.visible) continue;
    const LayerValues data(layer);
    const std::vector<double> found = data.at(at.position);
    const std::vector<std::string> names = channel_names_of(layer);
    for (std::size_t c = 0; c < found.size(); ++c) {
      values.push_back({{"layer", i}, {"channel", names[c]}, {"value", found[c]}});
    }
    if (const auto label = data.label_at(at.position)) {
      const LabelLooks looks(layer);
      const LabelStyle* const look = looks.find(*label);
      labels.push_back(label_json({i, *label, look == nullptr ? "" : look->name,
                                   look == nullptr ? Rgb<double>{} : look->color}));
    }
    if (const auto voxel = data.voxel_at(at.position)) {
      voxels.push_back({{"layer", i}, {"index", *voxel}});
    }
  }
  return {{"type", "located"},
          {"position", {at.position.x, at.position.y, at.position.z}},
          {"values", std::move(values)},
          {"labels", std::move(labels)},
          {"voxels", std::move(voxels)}};
}

Json slice_steps_json(const Layer& layer) {
  Json steps = Json::array();
  for (const SliceSteps& along : slice_steps(layer)) {
    Json json{{"step", along.step}};
    if (along.count > 0) json["first"] = along.first, json["count"] = along.count;
    if (!along.positions.empty()) json["positions"] = along.positions;
    steps.push_back(std::move(json));
  }
  return steps;
}

}  // namespace pellucid::view
