// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/label_volume.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "functions/point_check.h"
#include "message.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

/// Floats hold every whole number up to it.
constexpr double largest_label = 1 << 24;

bool is_label(double value) {
  return std::abs(value) <= largest_label && value == std::floor(value);
}

template <class Value>
std::set<std::int32_t> labels_in(const DataArray<Value>& values, const std::string& name) {
  std::set<std::int32_t> found;
  Value last{};
  bool any = false;
  for (const Value value : values) {
    // Neighbors are mostly of one label.
    if (any && value == last) continue;
    const auto wide = static_cast<double>(value);
    if (std::isnan(wide)) continue;
    if (!is_label(wide)) {
      throw Error((name.empty() ? "labels" : name) + ": holds the value " + number(wide) +
                  ", but labels are whole numbers from -16777216 to 16777216; show it as a field");
    }
    last = value;
    any = true;
    found.insert(static_cast<std::int32_t>(wide));
  }
  return found;
}

/// Tents at the labels. Each foot is half-way to the next whole number.
TransferFunction tents(const std::vector<LabelStyle>& styles) {
  std::vector<TransferFunction::Point> points;
  points.reserve(3 * styles.size());
  for (const LabelStyle& style : styles) {
    const double label = style.label;
    points.push_back({label - 0.5, 0, style.color});
    points.push_back({label, style.extinction, style.color});
    points.push_back({label + 0.5, 0, style.color});
  }
  return TransferFunction(std::move(points));
}

std::vector<LabelStyle> checked(std::vector<LabelStyle> styles) {
  if (styles.empty()) throw Error("labels: no label has a color; give at least one");
  std::ranges::sort(styles, {}, &LabelStyle::label);
  for (std::size_t i = 0; i < styles.size(); ++i) {
    const LabelStyle& style = styles[i];
    const std::string where = "label " + std::to_string(style.label);
    if (!is_label(style.label)) {
      throw Error(where + ": labels are whole numbers from -16777216 to 16777216");
    }
    if (i > 0 && styles[i - 1].label == style.label) {
      throw Error(where + ": is there twice; remove one of them");
    }
    const auto check = [&](double value, const char* what) {
      if (value >= 0 && value <= largest_point_number) return;
      throw Error(where + ": " + what + " is " + number(value) +
                  ", but must be a number from 0 to " + number(largest_point_number));
    };
    check(style.extinction, "extinction");
    for (const double c : {style.color.r, style.color.g, style.color.b}) check(c, "color");
  }
  return styles;
}

}  // namespace

LabelVolume::LabelVolume(std::shared_ptr<const Volume> volume) : volume_(std::move(volume)) {
  if (!volume_) throw Error("labels: there is no volume; give one");
  std::visit(
      [&](const auto& values) {
        const auto found = labels_in(values, volume_->description().name);
        labels_.assign(found.begin(), found.end());
      },
      volume_->data());
}

LabelVolume LabelVolume::moved(const Affine<double>& transform) const {
  LabelVolume result;
  result.volume_ = std::make_shared<const Volume>(volume_->moved(transform));
  result.labels_ = labels_;
  return result;
}

LabelTable::LabelTable(std::vector<LabelStyle> styles)
    : styles_(checked(std::move(styles))), function_(tents(styles_)) {}

LabelMask::LabelMask(std::shared_ptr<const LabelVolume> labels, std::vector<Choice> choices)
    : labels_(std::move(labels)), choices_(std::move(choices)) {
  if (!labels_) throw Error("mask: there are no labels; give a segmentation");
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    const std::string where = "mask: label " + std::to_string(choices_[i].label);
    if (!choices_[i].transfer_function) {
      throw Error(where + " has no transfer function; give one");
    }
    if (!index_.emplace(choices_[i].label, static_cast<int>(i)).second) {
      throw Error(where + " is there twice; remove one of them");
    }
  }
}

int LabelMask::choice_of(std::int32_t label) const noexcept {
  const auto found = index_.find(label);
  return found == index_.end() ? -1 : found->second;
}

}  // namespace pellucid
