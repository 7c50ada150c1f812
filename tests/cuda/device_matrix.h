// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/scenes/gallery.h"
#include "tests/scenes/tolerance_matrix.h"

namespace pellucid::scenes {

/// One exhibit from one camera, by the functions of a card, to the quick tolerances in both grades.
struct DeviceRow {
  std::string scene, camera;
  /// False: devices cannot do the scene, and the CPU rendered it.
  bool on_device = false;
  std::size_t frames = 0, pixels = 0;     ///< of all frames
  std::uint64_t in_double = 0, left = 0;  ///< pixels that were followed again; left to the CPU
  std::uint64_t over = 0;                 ///< pixels above the tolerance that do not say so
  std::uint64_t over_reported = 0;        ///< pixels with an error above what they report
  std::vector<std::string> faults;        ///< a sentence for each promise that was not kept
};

/// Renders the frames and holds them against the reference, whose frames `cache` keeps unless it is
/// empty. A scene that devices cannot do must go to the CPU, and say so.
DeviceRow check_on_device(const GalleryEntry& entry, const Exhibit& exhibit, std::size_t camera,
                          Device device, int size, const std::filesystem::path& cache = {});

/// Makes the reference's frame where devices can do the scene, and returns whether they can.
bool make_truth(const Exhibit& exhibit, std::size_t camera, int size,
                const std::filesystem::path& cache);

}  // namespace pellucid::scenes
