// SPDX-License-Identifier: Apache-2.0
#include "channel_sample.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <variant>

namespace pellucid {
namespace {

/// Returns the place in data of point i of a sample (the finalizer of SplitMix64, Steele et al.
/// 2014).
std::size_t place_of(std::size_t i, std::size_t period) {
  std::uint64_t hash = (std::uint64_t{i} + 1) * 0x9e3779b97f4a7c15U;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9U;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebU;
  hash ^= hash >> 31;
  return i * period + hash % period;
}

template <class Value>
VolumeData values_at(const DataArray<Value>& data, std::size_t count, std::size_t period,
                     const ParallelFor& parallel) {
  constexpr std::size_t chunk = 1024;
  std::vector<Value> values(count);
  parallel_or_serial(parallel)(
      static_cast<int>((count + chunk - 1) / chunk), [&](int first, int last) {
        const std::size_t end = std::min(count, static_cast<std::size_t>(last) * chunk);
        for (std::size_t i = static_cast<std::size_t>(first) * chunk; i < end; ++i) {
          values[i] = data[place_of(i, period)];
        }
      });
  return {std::move(values)};
}

}  // namespace

ChannelSample sample_channels(const Channels& channels, const std::vector<int>& which,
                              std::size_t most, const ParallelFor& parallel) {
  std::vector<Channel> chosen;
  chosen.reserve(which.size());
  for (const int c : which) chosen.push_back(channels[c]);
  const std::size_t all =
      std::visit([](const auto& data) { return data.size(); }, channels.grid().data());
  const std::size_t period = (all + most - 1) / most;
  if (period <= 1) return {Channels(std::move(chosen)), 1};
  const std::size_t count = all / period;
  for (Channel& channel : chosen) {
    Volume::Description line;
    line.dimensions = {static_cast<int>(count), 1, 1};
    line.centering = Centering::cell;
    line.name = channel.name;
    channel.volume = std::make_shared<const Volume>(
        std::move(line),
        std::visit([&](const auto& data) { return values_at(data, count, period, parallel); },
                   channel.volume->data()));
  }
  return {Channels(std::move(chosen)), period};
}

}  // namespace pellucid
