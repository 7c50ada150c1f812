// SPDX-License-Identifier: Apache-2.0
#include "final_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pellucid/scene/error.h"
#include "pellucid/traverse/block_code.h"

namespace pellucid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::size_t count_of(ImageSize size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

/// The ends of all rays of a pixel are its own.
std::shared_ptr<const Image> backdrop_of_rays(const Image& backdrop, int samples) {
  if (samples == 1) return std::make_shared<const Image>(backdrop);
  Image rays;
  rays.width = backdrop.width * samples;
  rays.height = backdrop.height * samples;
  for (int row = 0; row < rays.height; ++row) {
    for (int column = 0; column < rays.width; ++column) {
      const std::size_t pixel =
          static_cast<std::size_t>(row / samples) * static_cast<std::size_t>(backdrop.width) +
          static_cast<std::size_t>(column / samples);
      rays.pixels.push_back(backdrop.pixels[pixel]);
      rays.depth.push_back(backdrop.depth[pixel]);
    }
  }
  return std::make_shared<const Image>(std::move(rays));
}

/// The sums of a pixel's rays.
struct Pixel {
  std::array<double, 4> color{};
  double error = 0, depth = infinity;
  bool proved = true;

  void add(const RayPixel& ray, double ray_depth) {
    color[0] += double{ray.red};
    color[1] += double{ray.green};
    color[2] += double{ray.blue};
    color[3] += double{ray.opacity};
    error += double{ray.error};
    proved = proved && !(ray.estimated > 0);
    // The depth is that of the nearest ray whose opacity is more than its error.
    if (ray.opacity > ray.error || !std::isfinite(ray.error)) depth = std::min(depth, ray_depth);
  }
  void divide(double rays) {
    for (double& c : color) c /= rays;
    error /= rays;
  }
  void put_over(const std::array<float, 4>& behind, double behind_depth) {
    const double own = color[3], transparency = 1 - own;
    for (std::size_t c = 0; c < 4; ++c) color[c] += transparency * double{behind[c]};
    if (!(own > 0.5 * color[3]) || std::isinf(depth)) depth = behind_depth;
  }
};

}  // namespace

Scene scene_of_rays(const Scene& scene, int bricks) {
  Scene rays = scene;
  if (scene.size.width > 65536 / scene.samples || scene.size.height > 65536 / scene.samples) {
    throw Error("size and samples: more than 65536 rays along a side are too many for ranks; " +
                std::string("take fewer samples"));
  }
  rays.size.width *= scene.samples;
  rays.size.height *= scene.samples;
  rays.samples = 1;
  if (scene.backdrop) rays.backdrop = backdrop_of_rays(*scene.backdrop, scene.samples);
  const double most = std::max(largest_color(scene), 1.0);
  // What over() and the image's numbers round off.
  const double rounding = most * 0x1p-23 * bricks;
  const double left =
      std::max(scene.integration.tolerance - approximation_error(scene) - rounding - most * 0x1p-24,
               0.25 * scene.integration.tolerance);
  rays.integration.tolerance = std::max(left / std::max(bricks, 1), smallest_tolerance);
  return rays;
}

std::vector<RayPixel> to_ray_pixels(const Image& image) {
  std::vector<RayPixel> rays(image.pixels.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::array<float, 4>& pixel = image.pixels[i];
    rays[i] = {pixel[0], pixel[1],       pixel[2],
               pixel[3], image.error[i], image.proved[i] != 0 ? 0.0f : 1.0f};
  }
  return rays;
}

Image final_image(const Scene& scene, const RenderOptions& options,
                  const std::vector<RayPixel>& rays, const std::vector<float>& depth,
                  RenderReport& report) {
  Image image;
  image.width = scene.size.width;
  image.height = scene.size.height;
  const std::size_t pixels = count_of(scene.size);
  image.pixels.resize(pixels);
  if (options.depth) image.depth.resize(pixels);
  if (options.error) {
    image.error.resize(pixels);
    image.proved.resize(pixels);
  }
  report.largest_error = 0;
  report.pixels = pixels;
  report.pixels_proved = report.pixels_over_tolerance = 0;
  const int samples = scene.samples;
  const double most = std::max(largest_color(scene), 1.0);
  const double brightest_backdrop = scene.backdrop ? brightest_behind(scene) : 0;
  const double reserved = approximation_error(scene);
  const std::size_t row_of_rays = static_cast<std::size_t>(image.width * samples);
  for (std::size_t index = 0; index < pixels; ++index) {
    const std::size_t row = index / static_cast<std::size_t>(image.width),
                      column = index % static_cast<std::size_t>(image.width);
    Pixel pixel;
    for (int n = 0; n < samples * samples; ++n) {
      const std::size_t ray =
          (row * static_cast<std::size_t>(samples) + static_cast<std::size_t>(n / samples)) *
              row_of_rays +
          column * static_cast<std::size_t>(samples) + static_cast<std::size_t>(n % samples);
      pixel.add(rays[ray], depth.empty() ? infinity : double{depth[ray]});
    }
    pixel.divide(samples * samples);
    const double approximation = pixel.color[3] > 0 ? reserved : 0;
    if (scene.backdrop) {
      pixel.put_over(scene.backdrop->pixels[index], double{scene.backdrop->depth[index]});
    }
    double brightest = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      image.pixels[index][c] = static_cast<float>(pixel.color[c]);
      brightest = std::max(brightest, pixel.color[c]);
    }
    const double error = std::min(pixel.error + approximation, std::max(most, brightest_backdrop)) +
                         brightest * 0x1p-24;
    if (options.depth) image.depth[index] = static_cast<float>(pixel.depth);
    if (options.error) {
      image.error[index] = float_above(error);
      image.proved[index] = pixel.proved ? 1 : 0;
    }
    report.largest_error = std::max(report.largest_error, error);
    if (pixel.proved) ++report.pixels_proved;
    if (!(error <= scene.integration.tolerance)) ++report.pixels_over_tolerance;
  }
  return image;
}

}  // namespace pellucid
