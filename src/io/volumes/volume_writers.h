// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Takes the bytes that come next.
using Sink = std::function<void(std::span<const std::byte>)>;

/// Volume to write: components on one grid, of one type.
struct WrittenVolume {
  std::span<const Volume> components;
  std::string array;  ///< its name
  std::string path;   ///< for messages

  const Volume::Description& description() const { return components.front().description(); }
  const VolumeData& data() const { return components.front().data(); }
  int count() const { return static_cast<int>(components.size()); }
};

/// Facts that the format does not hold, one line each.
using Losses = std::vector<std::string>;

Losses write_nrrd(const WrittenVolume& volume, const Sink& sink);
Losses write_nifti(const WrittenVolume& volume, const Sink& sink);
Losses write_vti(const WrittenVolume& volume, const Sink& sink);
Losses write_raw(const WrittenVolume& volume, const Sink& sink);

void put_text(const std::string& text, const Sink& sink);
/// The components of each point side by side.
void put_interleaved(const WrittenVolume& volume, const Sink& sink);
/// One component behind the other.
void put_one_by_one(const WrittenVolume& volume, const Sink& sink);

/// With as many digits as it takes to read the same number again, and no more.
std::string exact_text(double x);
std::string exact_text(const Vec3<double>& v, const std::string& separator);

}  // namespace pellucid
