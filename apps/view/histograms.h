// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command.h"
#include "pellucid/scene/joint_histogram.h"
#include "pellucid/scene/scene.h"

namespace pellucid::view {

/// Counts the values of one or two channels of a layer: 256 bins, or 128 along each axis. Meshes
/// are counted by tetrahedra. Whole numbers get fewer bins, each of as many of them. Throws Error
/// if a channel is not there.
JointHistogram count_values(const Layer& layer, const AskHistogram& asked,
                            const ParallelFor& parallel);
/// Returns the message for a page: {"type": "histogram", "layer", "channels", "chosen", "axes":
/// [{"lower", "upper", "bins"}], "count": [...]}, the first axis fastest. `chosen`: whether the
/// page asked for these ranges.
Json histogram_json(const JointHistogram& histogram, const AskHistogram& asked);

/// Returns the names of a layer's channels.
std::vector<std::string> channel_names_of(const Layer& layer);

}  // namespace pellucid::view
