// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command.h"
#include "pellucid/scene/scene.h"
#include "server/page_server.h"

namespace pellucid::view {

/// The label of a picture of labels.
struct SliceLabel {
  std::size_t layer;
  std::int32_t label;
  std::string name;
  Rgb<double> color{};  ///< linear
};

/// Values of a layer's channel and labels of the visible layers in a slice, row by row.
struct SlicePicture {
  std::vector<float> values;          ///< NaN where there is none; empty: not asked for
  std::vector<std::uint16_t> labels;  ///< 0: none, i: shown[i - 1]; empty: no layer has labels
  std::vector<SliceLabel> shown;      ///< the labels that occur, the first 65535 of them
};

/// Computes a slice. Labels of later layers lie over earlier ones. Those without a look, or whose
/// look is transparent, are left out; so are 0 and labels without a function of their own of a
/// mask, whose colors are those of default_label_table(). Throws Error if there is no such layer or
/// channel.
SlicePicture make_slice(const Scene& scene, const AskSlice& ask, const ParallelFor& parallel);
/// Returns the binary message for a page: the members of the question, and
///
///   {"type": "slice", …, "values": true, "labels": [{"layer", "label", "name", "color"}]}
///
/// with the values as float32 and behind them the numbers of labels as uint16. "values" is false
/// where none are asked for; without "labels" there are no numbers.
PageMessage slice_message(const Scene& scene, const AskSlice& ask, const ParallelFor& parallel);

/// Returns the message with the data of the visible layers at a position:
///
///   {"type": "located", "position", "values": [{"layer", "channel", "value"}],
///    "labels": [{"layer", "label", "name", "color"}], "voxels": [{"layer", "index": [i, j, k]}]}
Json located_json(const Scene& scene, const Locate& at);

/// Returns the steps from slice to slice of a layer along the axes x, y, z:
///
///   {"first", "count", "step"}, {"positions": […], "step"} or {"step"} for each of them
Json slice_steps_json(const Layer& layer);

}  // namespace pellucid::view
