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

/// Returns a backdrop with a pixel per ray; all rays of a pixel end where the pixel says.
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
  double brightest = 0;  ///< of the colors
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

/// The pixels of a scene, of composited rays.
class Pixels {
 public:
  /// Takes the rays of all pixels. `depth`: of the rays; empty: not asked for.
  Pixels(const Scene& scene, const std::vector<RayPixel>& rays, const std::vector<float>& depth)
      : scene_(scene),
        rays_(rays),
        depth_(depth),
        width_(static_cast<std::size_t>(scene.size.width)),
        samples_(static_cast<std::size_t>(scene.samples)),
        reserved_(approximation_error(scene)),
        most_(
            std::max({largest_color(scene), 1.0, scene.backdrop ? brightest_behind(scene) : 0.0})) {
  }

  /// Calls visit(index) for each ray of a pixel.
  template <class Visit>
  void visit_rays(std::size_t pixel, const Visit& visit) const {
    const std::size_t row = pixel / width_, column = pixel % width_;
    for (std::size_t n = 0; n < samples_ * samples_; ++n) {
      visit((row * samples_ + n / samples_) * width_ * samples_ + column * samples_ + n % samples_);
    }
  }

  /// Returns the largest error of a pixel none of whose rays has a larger error.
  double most_error(double of_ray) const noexcept {
    return of_ray + reserved_ + 2 * most_ * 0x1p-24;
  }
  /// Returns the pixel over the backdrop, with all that it may be off by.
  Pixel at(std::size_t index) const {
    Pixel pixel;
    visit_rays(index, [&](std::size_t ray) {
      pixel.add(rays_[ray], depth_.empty() ? infinity : double{depth_[ray]});
    });
    pixel.divide(static_cast<double>(samples_ * samples_));
    const double approximation = pixel.color[3] > 0 ? reserved_ : 0;
    if (scene_.backdrop) {
      pixel.put_over(scene_.backdrop->pixels[index], double{scene_.backdrop->depth[index]});
    }
    for (const double color : pixel.color) pixel.brightest = std::max(pixel.brightest, color);
    pixel.error = std::min(pixel.error + approximation, most_) + pixel.brightest * 0x1p-24;
    return pixel;
  }

 private:
  const Scene& scene_;
  const std::vector<RayPixel>& rays_;
  const std::vector<float>& depth_;
  std::size_t width_, samples_;
  double reserved_, most_;
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

std::vector<std::size_t> rays_over_tolerance(const Scene& scene,
                                             const std::vector<RayPixel>& rays) {
  const std::vector<float> no_depth;
  const Pixels all(scene, rays, no_depth);
  std::vector<std::size_t> over;
  float largest = 0;
  bool known = true;
  for (const RayPixel& ray : rays) {
    largest = std::max(largest, ray.error);
    known = known && ray.error >= 0;  // and no NaN
  }
  if (known && all.most_error(double{largest}) <= scene.integration.tolerance) return over;
  for (std::size_t pixel = 0; pixel < count_of(scene.size); ++pixel) {
    if (all.at(pixel).error <= scene.integration.tolerance) continue;
    all.visit_rays(pixel, [&](std::size_t ray) { over.push_back(ray); });
  }
  return over;
}

Image final_image(const Scene& scene, const RenderOptions& options,
                  const std::vector<RayPixel>& rays, const std::vector<float>& depth,
                  RenderReport& report) {
  Image image;
  image.width = scene.size.width;
  image.height = scene.size.height;
  const std::size_t pixels = count_of(scene.size);
  image.pixels.resize(pixels);
  if (options.outputs.depth) image.depth.resize(pixels);
  if (options.outputs.error) {
    image.error.resize(pixels);
    image.proved.resize(pixels);
  }
  report.largest_error = 0;
  report.pixels = pixels;
  report.pixels_proved = report.pixels_over_tolerance = 0;
  const Pixels all(scene, rays, depth);
  for (std::size_t index = 0; index < pixels; ++index) {
    const Pixel pixel = all.at(index);
    for (std::size_t c = 0; c < 4; ++c) {
      image.pixels[index][c] = static_cast<float>(pixel.color[c]);
    }
    if (options.outputs.depth) image.depth[index] = static_cast<float>(pixel.depth);
    if (options.outputs.error) {
      image.error[index] = float_above(pixel.error);
      image.proved[index] = pixel.proved ? 1 : 0;
    }
    report.largest_error = std::max(report.largest_error, pixel.error);
    if (pixel.proved) ++report.pixels_proved;
    if (!(pixel.error <= scene.integration.tolerance)) ++report.pixels_over_tolerance;
  }
  return image;
}

}  // namespace pellucid
