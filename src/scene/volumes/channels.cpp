// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/channels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "message.h"
#include "pellucid/scene/error.h"
#include "pellucid/transfer/gaussian.h"

namespace pellucid {
namespace {

std::string named(const Channel& channel) {
  const std::string& volume = channel.volume->description().name;
  return "channel \"" + channel.name + "\"" +
         (volume.empty() || volume == channel.name ? "" : " (" + volume + ")");
}

std::string dimensions(const Volume& volume) {
  const auto& n = volume.description().dimensions;
  return std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]);
}

/// Returns the largest distance of the two grids' corners, in voxels of the first.
double displacement(const Volume& a, const Volume& b) {
  double largest = 0;
  const auto p = a.world_corners(), q = b.world_corners();
  for (std::size_t i = 0; i < p.size(); ++i) largest = std::max(largest, length(p[i] - q[i]));
  return largest / a.voxel_size();
}

void check_agreement(const Channel& first, const Channel& other) {
  const Volume::Description &a = first.volume->description(), &b = other.volume->description();
  const std::string both = named(other) + " and " + named(first);
  if (a.dimensions != b.dimensions) {
    throw Error("channels: " + both + " are not on one grid: " + dimensions(*other.volume) +
                " and " + dimensions(*first.volume) + " values; resample one to the other's grid");
  }
  if (a.centering != b.centering) {
    throw Error("channels: " + both +
                " are not on one grid: one is point-centred, the other cell-centred; give both "
                "the same centering");
  }
  if (a.coordinates != b.coordinates) {
    throw Error("channels: " + both +
                " are not on one grid: the coordinates of their axes differ; resample one to the "
                "other's grid");
  }
  constexpr double most = 1e-3;
  const double apart = displacement(*first.volume, *other.volume);
  if (!(apart <= most)) {
    throw Error("channels: " + both + " are not at one place: their corners are up to " +
                number(apart) + " voxels apart; resample one to the other's grid, or, if they do " +
                "belong together, give both the same origin, spacing and direction");
  }
}

}  // namespace

Channels::Channels(std::vector<Channel> channels) : channels_(std::move(channels)) {
  if (channels_.empty()) throw Error("channels: there is none; give from 1 to 8");
  if (channels_.size() > static_cast<std::size_t>(max_channels)) {
    throw Error("channels: there are " + std::to_string(channels_.size()) +
                ", but at most 8 can be; leave some out");
  }
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& channel = channels_[i];
    if (channel.name.empty()) {
      throw Error("channels: number " + std::to_string(i) + " has no name; give it one");
    }
    if (!channel.volume) throw Error("channels: \"" + channel.name + "\" has no volume; set it");
    if (find(channel.name) != static_cast<int>(i)) {
      throw Error("channels: the name \"" + channel.name +
                  "\" stands twice; give each channel its own");
    }
    check_agreement(channels_.front(), channel);
  }
}

std::optional<int> Channels::find(std::string_view name) const noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

}  // namespace pellucid
