// SPDX-License-Identifier: Apache-2.0

// make_truth FILE: the reference's frames of every scene of the gallery from its camera in turn.
// make_truth --check FILE: ends with 1 unless the file has these frames and no others.

#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <thread>

#include "tests/scenes/gallery.h"
#include "tests/scenes/reference_truth.h"

namespace {

using namespace pellucid;
using namespace pellucid::scenes;

/// Returns the largest difference next to 1, relative above it; NaN equals NaN.
double difference(const ReferenceFrame& a, const ReferenceFrame& b) {
  double largest = 0;
  for (std::size_t p = 0; p < a.pixels.size(); ++p) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double x = a.pixels[p][c], y = b.pixels[p][c];
      if (std::isnan(x) && std::isnan(y)) continue;
      const double d = std::fabs(x - y) / std::max(1.0, std::fabs(x));
      if (!(d <= largest)) largest = std::isnan(d) ? 1e300 : d;
    }
  }
  return largest;
}

bool run(const char* file, bool check) {
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const ReferenceTruth old = check ? ReferenceTruth(file) : ReferenceTruth();
  ReferenceTruth made;
  bool good = true;
  for (const GalleryEntry& entry : gallery()) {
    if (const std::string why = entry.why_missing(); !why.empty()) {
      std::fprintf(stderr, "%s: %s\n", entry.name.c_str(), why.c_str());
      good = false;
      continue;
    }
    const Exhibit exhibit = entry.make(truth_size);
    const Scene scene =
        scene_of(exhibit, camera_in_turn(entry.name, exhibit.cameras.size()), truth_size);
    ReferenceFrame frame = reference_frame(scene, threads);
    if (check) {
      const ReferenceFrame* const before = old.find(scene);
      if (before == nullptr || difference(*before, frame) > reference_accuracy) {
        std::fprintf(stderr, "%s: %s\n", entry.name.c_str(),
                     before ? "the frame differs" : "there is no frame");
        good = false;
      }
    }
    made.add(scene, std::move(frame));
  }
  if (check && old.size() != made.size()) {
    std::fprintf(stderr, "%zu frames instead of %zu\n", old.size(), made.size());
    good = false;
  }
  if (!check && good) made.write(file);
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  const bool check = argc == 3 && std::strcmp(argv[1], "--check") == 0;
  if (argc != 2 && !check) {
    std::fprintf(stderr, "make_truth [--check] FILE\n");
    return 2;
  }
  try {
    return run(argv[argc - 1], check) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_truth: %s\n", error.what());
    return 2;
  }
}
