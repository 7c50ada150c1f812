// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Takes the bytes that come next.
using Sink = std::function<void(std::span<const std::byte>)>;

/// Volume to write: components on one grid, of one type.
struct WrittenVolume {
  std::span<const Volume> components;
  std::string array;    ///< its name
  std::string path;     ///< for messages
  std::string space{};  ///< that it is placed in (world_space()); empty: not known

  const Volume::Description& description() const { return components.front().description(); }
  const VolumeData& data() const { return components.front().data(); }
  int count() const { return static_cast<int>(components.size()); }
};

/// Facts that the format does not hold, one line each.
using Losses = std::vector<std::string>;

/// A format that volumes are written in. Folders of formats define such objects and name them in
/// their sources.cmake, as of VolumeFormat.
struct VolumeWriter {
  std::string_view extension;  ///< the end of files' names, in small letters: ".nii.gz"
  /// Writes a volume to `sink`. Returns what the format does not hold. Throws Error.
  Losses (*write)(const WrittenVolume& volume, const Sink& sink);
  bool compressed = false;       ///< whether gzip compresses what is written
  bool keeps_positions = false;  ///< whether it holds rectilinear axes
};

/// Returns all of them. CMake writes the source, from what the folders name.
std::span<const VolumeWriter* const> volume_writers();

void put_text(const std::string& text, const Sink& sink);
/// Writes the components of each point side by side.
void put_interleaved(const WrittenVolume& volume, const Sink& sink);
/// Writes one component behind the other.
void put_one_by_one(const WrittenVolume& volume, const Sink& sink);

/// Writes a number with as many digits as it takes to read the same number again, and no more.
std::string exact_text(double x);
std::string exact_text(const Vec3<double>& v, const std::string& separator);

}  // namespace pellucid
