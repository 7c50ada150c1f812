// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/reference_frame.h"

#include <atomic>
#include <cstdio>
#include <fstream>
#include <limits>
#include <thread>

#include "pellucid/reference/render.h"
#include "tests/scenes/scene_hash.h"

namespace pellucid::scenes {
namespace {

/// Of the size of a mesh: what overlaps by less does so by rounding.
constexpr double min_overlap = 1e-12;

std::array<double, 4> reference_pixel(const ReferenceRays& rays, const Scene& scene,
                                      const CameraFrame<double>& camera, int column, int row,
                                      double size) {
  const int samples = scene.samples;
  const std::size_t index =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(scene.size.width) +
      static_cast<std::size_t>(column);
  const double end = scene.backdrop ? double{scene.backdrop->depth[index]}
                                    : std::numeric_limits<double>::infinity();
  std::array<double, 4> sum{};
  const int count = samples * samples;
  for (int n = 0; n < count; ++n) {
    const Ray<double> ray = camera.ray(column, row, n, samples);
    const ReferencePixel pixel = rays(ray.origin, ray.direction, end);
    if (pixel.overlap > min_overlap * size) sum.fill(std::numeric_limits<double>::quiet_NaN());
    const double channel[4] = {pixel.radiance.r, pixel.radiance.g, pixel.radiance.b, pixel.opacity};
    for (std::size_t c = 0; c < 4; ++c) sum[c] += channel[c] / count;
  }
  if (scene.backdrop) {
    const double transparency = 1 - sum[3];
    const std::array<float, 4>& behind = scene.backdrop->pixels[index];
    for (std::size_t c = 0; c < 4; ++c) sum[c] += transparency * static_cast<double>(behind[c]);
  }
  return sum;
}

/// Returns the diagonal of the largest mesh; 0 without one.
double mesh_size(const Scene& scene) {
  double size = 0;
  for (const Layer& layer : scene.layers) {
    const auto* const content = std::get_if<MeshContent>(&layer.content);
    if (content == nullptr) continue;
    const Box<double>& box = content->mesh->mesh().bounds();
    size = std::max(size, length(box.upper - box.lower));
  }
  return size;
}

}  // namespace

std::vector<std::array<double, 4>> reference_pixels(const Scene& scene,
                                                    const std::vector<std::size_t>& places) {
  const CameraFrame<double> camera = make_camera_frame(scene.camera, scene.size);
  const ReferenceRays rays(scene);
  const double size = mesh_size(scene);
  const auto width = static_cast<std::size_t>(scene.size.width);
  std::vector<std::array<double, 4>> pixels;
  for (const std::size_t place : places) {
    pixels.push_back(reference_pixel(rays, scene, camera, static_cast<int>(place % width),
                                     static_cast<int>(place / width), size));
  }
  return pixels;
}

ReferenceFrame reference_frame(const Scene& scene, int threads) {
  const CameraFrame<double> camera = make_camera_frame(scene.camera, scene.size);
  const ReferenceRays rays(scene);
  const double size = mesh_size(scene);
  ReferenceFrame frame{scene.size.width, scene.size.height, {}};
  const auto width = static_cast<std::size_t>(frame.width);
  frame.pixels.resize(width * static_cast<std::size_t>(frame.height));
  std::atomic<int> next_row{0};
  const auto work = [&] {
    for (int row = next_row++; row < frame.height; row = next_row++) {
      for (int column = 0; column < frame.width; ++column) {
        frame.pixels[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)] =
            reference_pixel(rays, scene, camera, column, row, size);
      }
    }
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  others.clear();  // Joins them.
  return frame;
}

ReferenceFrame cached_reference_frame(const Scene& scene, int threads,
                                      const std::filesystem::path& folder) {
  if (folder.empty()) return reference_frame(scene, threads);
  std::filesystem::create_directories(folder);
  char name[64];
  std::snprintf(name, sizeof name, "%016llx-%u.rgba64f",
                static_cast<unsigned long long>(scene_hash(scene)), reference_version);
  const std::filesystem::path file = folder / name;
  ReferenceFrame frame{scene.size.width, scene.size.height, {}};
  frame.pixels.resize(static_cast<std::size_t>(frame.width) *
                      static_cast<std::size_t>(frame.height));
  const std::size_t size = frame.pixels.size() * sizeof(frame.pixels[0]);
  if (std::filesystem::exists(file) && std::filesystem::file_size(file) == size) {
    std::ifstream stream(file, std::ios::binary);
    stream.read(reinterpret_cast<char*>(frame.pixels.data()), static_cast<std::streamsize>(size));
    if (stream) return frame;
  }
  frame = reference_frame(scene, threads);
  // Under another name first: what is cut off by an interruption is never read.
  std::filesystem::path part = file;
  part += ".part";
  std::ofstream stream(part, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(frame.pixels.data()),
               static_cast<std::streamsize>(size));
  stream.close();
  if (stream) std::filesystem::rename(part, file);
  return frame;
}

}  // namespace pellucid::scenes
