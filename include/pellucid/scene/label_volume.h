// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "pellucid/math/rgb.h"
#include "pellucid/scene/transfer_function.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// A segmentation: whole numbers that name regions. Each place has the label of the nearest data
/// value; labels are never interpolated. The labels fill the box of the volume
/// (Volume::world_corners()). NaN is vacuum. Immutable; copies share the data.
class LabelVolume {
 public:
  /// Throws Error if a value is not a whole number within ±2^24.
  explicit LabelVolume(std::shared_ptr<const Volume> volume);

  const Volume& volume() const noexcept { return *volume_; }
  const std::shared_ptr<const Volume>& shared_volume() const noexcept { return volume_; }
  /// Returns the labels that occur, in ascending order.
  const std::vector<std::int32_t>& labels() const noexcept { return labels_; }
  /// Returns the labels at another place in the world (Volume::moved()).
  LabelVolume moved(const Affine<double>& transform) const;

 private:
  LabelVolume() = default;

  std::shared_ptr<const Volume> volume_;
  std::vector<std::int32_t> labels_;
};

/// The look of one label.
struct LabelStyle {
  std::int32_t label = 0;
  std::string name;
  Rgb<double> color{};    ///< linear RGB, not premultiplied, >= 0
  double extinction = 0;  ///< 1/length in world units, >= 0
};

/// The look of the labels of a segmentation. A label without a style is transparent. Immutable.
class LabelTable {
 public:
  /// Throws Error if there is no style, a label is a duplicate or beyond ±2^24, or a number is
  /// negative, not finite or beyond the limits of TransferFunction.
  explicit LabelTable(std::vector<LabelStyle> styles);

  /// Returns the styles by ascending label.
  const std::vector<LabelStyle>& styles() const noexcept { return styles_; }
  /// Returns a function whose value at each label is the label's extinction and color, and which is
  /// 0 half-way to the whole numbers next to it.
  const TransferFunction& function() const noexcept { return function_; }

 private:
  std::vector<LabelStyle> styles_;
  TransferFunction function_;
};

/// Labels that choose the transfer function of data on the same grid.
class LabelMask {
 public:
  struct Choice {
    std::int32_t label = 0;
    std::shared_ptr<const TransferFunction> transfer_function;
  };
  /// Labels without a choice keep the function of the layer. Throws Error if a label is a duplicate
  /// or a function is missing.
  LabelMask(std::shared_ptr<const LabelVolume> labels, std::vector<Choice> choices);

  const LabelVolume& labels() const noexcept { return *labels_; }
  const std::shared_ptr<const LabelVolume>& shared_labels() const noexcept { return labels_; }
  const std::vector<Choice>& choices() const noexcept { return choices_; }
  /// Returns the index of the label's choice, or -1.
  int choice_of(std::int32_t label) const noexcept;

 private:
  std::shared_ptr<const LabelVolume> labels_;
  std::vector<Choice> choices_;
  std::unordered_map<std::int32_t, int> index_;
};

}  // namespace pellucid
