// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// One variable of the data.
struct Channel {
  std::string name;
  std::string unit;  ///< shown to the user; may be empty
  std::shared_ptr<const Volume> volume;
};

/// One to eight variables on one grid, each in its own type. Immutable; copies share the data.
///
/// Each variable is a trilinear field. A cell with a NaN corner in any channel is vacuum.
class Channels {
 public:
  /// Throws Error if there is no channel or more than eight, a name is empty or a duplicate, a
  /// volume is missing, or a grid differs from the first one: dimensions, centering and coordinates
  /// must be equal, placements must agree to within a thousandth of a cell over the whole grid.
  explicit Channels(std::vector<Channel> channels);

  int count() const noexcept { return static_cast<int>(channels_.size()); }
  const Channel& operator[](int i) const noexcept { return channels_[static_cast<std::size_t>(i)]; }
  std::vector<Channel>::const_iterator begin() const noexcept { return channels_.begin(); }
  std::vector<Channel>::const_iterator end() const noexcept { return channels_.end(); }
  /// Returns the index of the channel of this name, or none.
  std::optional<int> find(std::string_view name) const noexcept;
  /// Returns the volume of the first channel; its grid is the grid of all channels.
  const Volume& grid() const noexcept { return *channels_.front().volume; }

 private:
  std::vector<Channel> channels_;
};

}  // namespace pellucid
