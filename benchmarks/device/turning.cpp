// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/device/turning.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pellucid::bench {
namespace {

/// Turns a vector about the axis `up`, of length 1 (Rodrigues).
Vec3<double> turned(const Vec3<double>& v, const Vec3<double>& up, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(up, v) +
         ((1 - std::cos(angle)) * dot(up, v)) * up;
}

}  // namespace

Turning::Turning(const Scene& scene, Device device, int threads) : scene_(scene) {
  options_.machine.device = device;
  options_.machine.threads = threads;
  first_ = renderer_.render(scene_, options_);
}

double Turning::frames_per_second(int frames, double longest) {
  using Clock = std::chrono::steady_clock;
  const Vec3<double> up = normalized(scene_.camera.up);
  std::vector<double> seconds;
  double spent = 0;
  for (int i = 0; i < frames && (i < 2 || spent < longest); ++i) {
    Camera& camera = scene_.camera;
    camera.position = camera.focal_point + turned(camera.position - camera.focal_point, up, 0.05);
    const auto start = Clock::now();
    renderer_.render(scene_, options_);
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    spent += seconds.back();
  }
  std::ranges::sort(seconds);
  return 1 / seconds[seconds.size() / 2];
}

}  // namespace pellucid::bench
