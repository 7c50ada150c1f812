// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "pellucid/scene/scene.h"

namespace pellucid::scenes {

/// What reference_ray gives may be off by, next to 1 and relatively above it: its quadrature goes
/// to 1e-12 in each piece. What is smaller says nothing about the judged.
inline constexpr double reference_accuracy = 1e-11;

/// Counts up where the reference or the format of its frames changes, so that older files are not
/// used.
inline constexpr unsigned reference_version = 1;

/// A picture that is not rounded: premultiplied linear RGBA in double, row 0 at the top. NaN: a ray
/// is in two tetrahedra at once.
struct ReferenceFrame {
  int width = 0, height = 0;
  std::vector<std::array<double, 4>> pixels;
};

/// Every ray of the scene's camera, all samples of a pixel, by reference_ray. `threads` >= 1.
ReferenceFrame reference_frame(const Scene& scene, int threads);

/// Returns pixels of the same: those at row * width + column = places[i].
std::vector<std::array<double, 4>> reference_pixels(const Scene& scene,
                                                    const std::vector<std::size_t>& places);

/// The same from the folder if it was made before: the file's name is the scene's hash. An empty
/// folder: always made.
ReferenceFrame cached_reference_frame(const Scene& scene, int threads,
                                      const std::filesystem::path& folder);

}  // namespace pellucid::scenes
