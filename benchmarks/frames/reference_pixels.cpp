// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/reference_pixels.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include "benchmarks/support/document.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/reference/render.h"
#include "tests/scenes/scene_hash.h"

namespace pellucid::bench {
namespace {

/// Counts up where the reference, the choice of pixels or the file changes.
constexpr unsigned version = 1;

std::array<double, 4> reference_pixel(const Scene& scene, const ReferenceRays& rays,
                                      const CameraFrame<double>& camera, std::size_t index) {
  const auto width = static_cast<std::size_t>(scene.size.width);
  const auto column = static_cast<int>(index % width), row = static_cast<int>(index / width);
  const int count = scene.samples * scene.samples;
  std::array<double, 4> mean{};
  for (int n = 0; n < count; ++n) {
    const Ray<double> ray = camera.ray(column, row, n, scene.samples);
    const ReferencePixel pixel = rays(ray.origin, ray.direction);
    const double channel[4] = {pixel.radiance.r, pixel.radiance.g, pixel.radiance.b, pixel.opacity};
    for (std::size_t c = 0; c < 4; ++c) mean[c] += channel[c] / count;
  }
  return mean;
}

void render_pixels(const Scene& scene, int threads, ReferencePixels& pixels) {
  const CameraFrame<double> camera = make_camera_frame(scene.camera, scene.size);
  const ReferenceRays rays(scene);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < pixels.index.size(); i = next++) {
      pixels.value[i] = reference_pixel(scene, rays, camera, pixels.index[i]);
    }
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
}

}  // namespace

std::vector<std::size_t> chosen_pixels(ImageSize size, std::size_t count) {
  const auto width = static_cast<std::size_t>(size.width);
  const auto height = static_cast<std::size_t>(size.height);
  std::vector<std::size_t> list;
  if (count >= width * height) {
    list.resize(width * height);
    std::iota(list.begin(), list.end(), std::size_t{0});
    return list;
  }
  const std::size_t row = height * 3 / 8, column = width * 5 / 8;
  for (std::size_t x = 0; x < width; ++x) list.push_back(row * width + x);
  for (std::size_t y = 0; y < height; ++y) list.push_back(y * width + column);
  const auto only_once = [&] {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  only_once();
  std::mt19937_64 random(1);
  while (list.size() < count) {
    const std::size_t missing = count - list.size();
    for (std::size_t i = 0; i < missing; ++i) list.push_back(random() % (width * height));
    only_once();
  }
  return list;
}

ReferencePixels reference_pixels(const Scene& scene, std::size_t count, int threads,
                                 const std::filesystem::path& folder) {
  ReferencePixels pixels{chosen_pixels(scene.size, count), {}};
  pixels.value.resize(pixels.index.size());
  if (folder.empty()) {
    render_pixels(scene, threads, pixels);
    return pixels;
  }
  std::filesystem::create_directories(folder);
  const std::filesystem::path file =
      folder / format("%016llx-%zu-%u.rgba64f",
                      static_cast<unsigned long long>(scenes::scene_hash(scene)),
                      pixels.index.size(), version);
  const std::size_t size = pixels.value.size() * sizeof(pixels.value[0]);
  if (std::filesystem::exists(file) && std::filesystem::file_size(file) == size) {
    const std::string bytes = read_text_file(file, size);
    std::memcpy(pixels.value.data(), bytes.data(), size);
    return pixels;
  }
  render_pixels(scene, threads, pixels);
  std::string bytes(size, '\0');
  std::memcpy(bytes.data(), pixels.value.data(), size);
  write_text_file(file, bytes);
  return pixels;
}

PixelError error_of(const Image& image, const ReferencePixels& reference) {
  PixelError error;
  double sum = 0;
  for (std::size_t i = 0; i < reference.index.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      double off = std::fabs(static_cast<double>(image.pixels.at(reference.index[i])[c]) -
                             reference.value[i][c]);
      if (!std::isfinite(off)) off = std::numeric_limits<double>::infinity();
      error.largest = std::max(error.largest, off);
      sum += off * off;
    }
  }
  error.rms = std::sqrt(sum / static_cast<double>(4 * reference.index.size()));
  return error;
}

}  // namespace pellucid::bench
