// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/mesh_channels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "blocks/volume_scan.h"
#include "message.h"
#include "pellucid/scene/error.h"
#include "pellucid/transfer/gaussian.h"

namespace pellucid {
namespace {

[[noreturn]] void fail(const TetrahedralMesh& mesh, const std::string& message) {
  throw Error((mesh.name().empty() ? "mesh" : mesh.name()) + ": " + message);
}

/// Returns 1 for the points that tetrahedra use; empty where all are used.
std::vector<std::uint8_t> used_points(const TetrahedralMesh& mesh) {
  if (mesh.statistics().unused_points == 0) return {};
  std::vector<std::uint8_t> used(mesh.points().size(), 0);
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra()) {
    for (const std::int32_t point : tetrahedron.corner) used[static_cast<std::size_t>(point)] = 1;
  }
  return used;
}

template <class Value>
VolumeScan scan_used(std::span<const Value> values, const std::vector<std::uint8_t>& used) {
  if (used.empty()) return scan(values);
  std::vector<Value> kept;
  kept.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (used[i] != 0) kept.push_back(values[i]);
  }
  return scan(std::span<const Value>(kept));
}

/// Returns the position of the first value that is used and cannot be shown, by the numbers of
/// points.
template <class Value>
std::string first_beyond(const TetrahedralMesh& mesh, std::span<const Value> values,
                         const std::vector<std::uint8_t>& used, bool points, bool infinite) {
  std::int32_t first_point = std::numeric_limits<std::int32_t>::max();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!used.empty() && used[i] == 0) continue;
    const double size = std::abs(static_cast<double>(values[i]));
    if (infinite ? !std::isinf(size) : !(size > largest_value)) continue;
    if (!points) return mesh.describe(i);
    first_point = std::min(first_point, mesh.point_number(i));
  }
  return "point " + std::to_string(first_point);
}

template <class Value>
VolumeStatistics check_values(const TetrahedralMesh& mesh, const MeshChannel& channel,
                              std::span<const Value> values,
                              const std::vector<std::uint8_t>& used) {
  const VolumeScan s = scan_used(values, used);
  const auto at = [&](bool infinite) {
    return first_beyond(mesh, values, used, channel.centering == Centering::point, infinite);
  };
  if (const std::size_t n = s.statistics.infinite; n > 0) {
    fail(mesh, "channel \"" + channel.name + "\" has " + std::to_string(n) + " infinite value" +
                   (n == 1 ? "" : "s") + ", the first at " + at(true) +
                   "; replace by finite numbers, or by NaN for empty space");
  }
  if (s.large) {
    fail(mesh, "channel \"" + channel.name + "\": the value at " + at(false) + " is beyond " +
                   number(largest_value) +
                   " in magnitude, more than float arithmetic carries; rescale the data, or "
                   "replace by NaN where it marks empty space");
  }
  return s.statistics;
}

void check_size(const TetrahedralMesh& mesh, const MeshChannel& channel) {
  const bool point = channel.centering == Centering::point;
  const std::size_t needed = point ? mesh.points().size() : mesh.tetrahedra().size();
  const std::size_t size =
      std::visit([](const auto& values) { return values.size(); }, channel.values);
  if (size == needed) return;
  fail(mesh, "channel \"" + channel.name + "\" has " + std::to_string(size) +
                 " values, but there are " + std::to_string(needed) +
                 (point ? " points; give one for each, or centre it on the tetrahedra"
                        : " tetrahedra; give one for each, or centre it on the points"));
}

/// Sets a flag where a value is NaN; `flags` grows to the number of values.
void flag_nan(const VolumeData& data, std::vector<std::uint8_t>& flags) {
  std::visit(
      [&](const auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        if constexpr (std::is_floating_point_v<Value>) {
          flags.resize(values.size(), 0);
          for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i] != values[i]) flags[i] = 1;
          }
        }
      },
      data);
}

}  // namespace

MeshChannels::MeshChannels(std::shared_ptr<const TetrahedralMesh> mesh,
                           std::vector<MeshChannel> channels)
    : mesh_(std::move(mesh)), channels_(std::move(channels)) {
  if (!mesh_) throw Error("mesh: there is none under the channels; set it");
  if (channels_.empty()) fail(*mesh_, "there is no channel; give from 1 to 8");
  if (channels_.size() > static_cast<std::size_t>(max_channels)) {
    fail(*mesh_, "there are " + std::to_string(channels_.size()) +
                     " channels, but at most 8 can be; leave some out");
  }
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const MeshChannel& channel = channels_[i];
    if (channel.name.empty()) {
      fail(*mesh_, "channel " + std::to_string(i) + " has no name; give it one");
    }
    if (find(channel.name) != static_cast<int>(i)) {
      fail(*mesh_, "two channels have the name \"" + channel.name + "\"; give each its own");
    }
    check_size(*mesh_, channel);
  }

  const std::vector<std::uint8_t> used = used_points(*mesh_), all;
  std::vector<std::uint8_t> point_nan, tetrahedron_nan;
  statistics_.reserve(channels_.size());
  for (const MeshChannel& channel : channels_) {
    const bool point = channel.centering == Centering::point;
    statistics_.push_back(std::visit(
        [&](const auto& values) {
          return check_values(*mesh_, channel, std::span(values.data(), values.size()),
                              point ? used : all);
        },
        channel.values));
    if (statistics_.back().nan > 0) flag_nan(channel.values, point ? point_nan : tetrahedron_nan);
  }

  if (point_nan.empty() && tetrahedron_nan.empty()) return;
  const auto& tetrahedra = mesh_->tetrahedra();
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    const bool own = !tetrahedron_nan.empty() && tetrahedron_nan[t] != 0;
    const bool corner =
        !point_nan.empty() && std::ranges::any_of(tetrahedra[t].corner, [&](std::int32_t point) {
          return point_nan[static_cast<std::size_t>(point)] != 0;
        });
    if (own || corner) ++vacuum_;
  }
}

std::optional<int> MeshChannels::find(std::string_view name) const noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

double MeshChannels::value(int channel, std::size_t index) const {
  return std::visit([index](const auto& values) { return static_cast<double>(values[index]); },
                    channels_[static_cast<std::size_t>(channel)].values);
}

}  // namespace pellucid
