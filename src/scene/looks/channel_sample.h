// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/scene/channels.h"

namespace pellucid {

/// Values of some channels at some data points, the same points in each.
struct ChannelSample {
  Channels channels;       ///< the chosen channels, in their own types; their grid means nothing
  std::size_t period = 1;  ///< number of data points that each point of the sample stands for
};

/// Takes the channels `which` at one data point of each `period` consecutive ones (the last few may
/// have none), where `period` is the smallest number that leaves at most `most` points. Which
/// of them is a fixed hash of their number, so that a pattern in the data does not matter. Data
/// with no more points are shared, not copied.
ChannelSample sample_channels(const Channels& channels, const std::vector<int>& which,
                              std::size_t most, const ParallelFor& parallel = {});

}  // namespace pellucid
