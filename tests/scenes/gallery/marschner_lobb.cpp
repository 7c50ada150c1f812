// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/gallery.h"
#include "tests/scenes/peers.h"

namespace pellucid::scenes {
Gallery marschner_lobb_gallery() {
  const auto entry = [](const char* name, TransferPointer (*make_transfer)()) {
    return GalleryEntry{std::string("Marschner-Lobb, ") + name, [=](int) {
                          const VolumePointer volume = builtin("marschner_lobb", 41);
                          return Exhibit{volume, make_transfer(), three_cameras(*volume)};
                        }};
  };
  // The table itself is rounded by a hundredth of the peak's width in float.
  GalleryEntry thinnest = entry("peak 2e-6", [] { return peak_transfer(1e5, 2e-6); });
  thinnest.min_tolerance = 1e-4;
  return {entry("ramp",
                [] {
                  return transfer({{0, 0.1, {0.2, 0.4, 1}}, {1, 1.5, {1, 0.6, 0.1}}});
                }),
          entry("haze", haze_transfer),
          entry("wide peak", [] { return peak_transfer(4, 0.4); }),
          entry("peak 0.05", band_transfer),
          entry("peak 0.012", spike_transfer),
          entry("peak 0.002", [] { return peak_transfer(375, 0.002); }),
          thinnest,
          entry("256 corners", comb_transfer)};
}

}  // namespace pellucid::scenes
