// SPDX-License-Identifier: Apache-2.0
#include "error_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "final_image.h"

namespace pellucid {
namespace {

/// Fraction of the remaining tolerance that is shared out again: roundings need a little.
constexpr double of_the_rest = 0.98;
/// Fraction of the tolerance that must remain for the others to be rendered again.
constexpr double least_rest = 0.02;
/// Rays that are tried first.
constexpr std::size_t most_tried = 256;
/// Parts of allowances by a factor of 2, which rays have in common.
constexpr double steps_of_two = 4;

/// Rounds down, so that rays of like allowances go together.
double in_steps(double allowance) {
  return std::exp2(std::floor(std::log2(allowance) * steps_of_two) / steps_of_two);
}

/// Returns the numbers of rank 0 on all ranks.
std::vector<std::size_t> sent(Communicator& ranks, const std::vector<std::size_t>& numbers) {
  std::array<double, 1> count{ranks.rank() == 0 ? static_cast<double>(numbers.size()) : 0};
  ranks.reduce_all(count, Communicator::Reduction::maximum);
  std::vector<double> values(static_cast<std::size_t>(count[0]), 0);
  if (ranks.rank() == 0) {
    std::ranges::transform(numbers, values.begin(),
                           [](std::size_t n) { return static_cast<double>(n); });
  }
  ranks.reduce_all(values, Communicator::Reduction::maximum);
  return {values.begin(), values.end()};
}

class SecondLook {
 public:
  SecondLook(Communicator& ranks, const RenderedParts& parts,
             const std::function<void(const std::function<void()>&)>& together)
      : ranks_(ranks),
        parts_(parts),
        together_(together),
        part_tolerance_(parts.rays.integration.tolerance),
        tolerance_(part_tolerance_ * parts.most_bricks),
        camera_(make_camera_frame(parts.rays.camera, parts.rays.size)) {}

  /// Looks at these rays. Returns how many of them are within the tolerance then.
  std::size_t look(const std::vector<std::size_t>& all) {
    rays_ = all;
    failed_ = beyond_share();
    std::size_t within = 0;
    for (const bool others : {false, true}) {
      render(others);
      composite();
      const std::size_t before = rays_.size();
      leave_those_within();
      within += before - rays_.size();
      if (rays_.empty()) break;
    }
    return within;
  }
  std::uint64_t count() const noexcept { return count_; }

 private:
  /// Returns whether this rank's part of a ray exceeds its equal share.
  std::vector<char> beyond_share() const {
    std::vector<char> failed;
    for (const std::size_t ray : rays_) {
      const double share = tolerance_ / std::max(parts_.tree.bricks_on(ray_of(ray)), 1);
      failed.push_back(error_of(ray) > share ? 1 : 0);
    }
    return failed;
  }

  Ray<double> ray_of(std::size_t ray) const {
    const auto [column, row] = place_of(ray);
    return camera_.ray(column, row);
  }
  std::pair<int, int> place_of(std::size_t ray) const {
    const auto width = static_cast<std::size_t>(parts_.rays.size.width);
    return {static_cast<int>(ray % width), static_cast<int>(ray / width)};
  }
  double error_of(std::size_t ray) const { return double{parts_.own[ray].error}; }

  std::vector<RayPixel> own_pixels() const {
    std::vector<RayPixel> pixels;
    pixels.reserve(rays_.size());
    for (const std::size_t ray : rays_) pixels.push_back(parts_.own[ray]);
    return pixels;
  }

  /// Returns the transparency of all that is in front of this rank's part.
  std::vector<double> transparency_in_front() {
    std::vector<RayPixel> pixels = own_pixels();
    ranks_.composite_in_front(pixels, parts_.place);
    std::vector<double> transparency;
    transparency.reserve(pixels.size());
    for (const RayPixel& pixel : pixels) {
      transparency.push_back(std::clamp(1 - double{pixel.opacity}, 0.0, 1.0));
    }
    return transparency;
  }

  /// Renders the parts that exceeded their share, or the `others`, to what is left for them.
  void render(bool others) {
    const std::vector<double> transparency = transparency_in_front();
    // Of each ray: the errors that stay, as they are seen from the camera, and the number of parts
    // that are rendered again.
    const std::size_t n = rays_.size();
    std::vector<double> sums(2 * n, 0);
    const auto takes_part = [&](std::size_t i) {
      return (failed_[i] != 0) != others && error_of(rays_[i]) > 0 && transparency[i] > 0;
    };
    for (std::size_t i = 0; i < n; ++i) {
      if (takes_part(i)) {
        sums[n + i] = 1;
      } else if (transparency[i] > 0) {
        sums[i] = transparency[i] * error_of(rays_[i]);
      }
    }
    ranks_.reduce_all(sums, Communicator::Reduction::sum);
    std::vector<PixelRequest> requests;
    std::vector<std::size_t> of;
    for (std::size_t i = 0; i < n; ++i) {
      const double rest = tolerance_ - sums[i];
      if (!takes_part(i) || !(rest >= least_rest * tolerance_)) continue;
      // Behind what is nearly opaque a part may be off by much more.
      constexpr double most = 0.1;
      const double wanted =
          std::min(of_the_rest * rest / (sums[n + i] * std::max(transparency[i], 1e-6)), most);
      if (others && !(wanted < error_of(rays_[i]))) continue;
      const auto [column, row] = place_of(rays_[i]);
      requests.push_back({column, row, in_steps(wanted / part_tolerance_)});
      of.push_back(rays_[i]);
    }
    together_([&] {
      if (requests.empty()) return;
      const std::vector<RayPixel> found =
          to_ray_pixels(parts_.renderer.render_pixels(parts_.rays, parts_.options, requests).image);
      for (std::size_t i = 0; i < of.size(); ++i) {
        RayPixel& own = parts_.own[of[i]];
        if (found[i].error < own.error) own = found[i];
      }
    });
    std::array<double, 1> count{static_cast<double>(requests.size())};
    ranks_.reduce_all(count, Communicator::Reduction::sum);
    count_ += static_cast<std::uint64_t>(count[0]);
  }

  void composite() {
    std::vector<RayPixel> pixels = own_pixels();
    ranks_.composite(pixels, parts_.place);
    if (ranks_.rank() != 0) return;
    for (std::size_t i = 0; i < rays_.size(); ++i) parts_.composite[rays_[i]] = pixels[i];
  }

  void leave_those_within() {
    std::vector<double> over(rays_.size(), 0);
    if (ranks_.rank() == 0) {
      for (std::size_t i = 0; i < over.size(); ++i) {
        over[i] = double{parts_.composite[rays_[i]].error} <= tolerance_ ? 0 : 1;
      }
    }
    ranks_.reduce_all(over, Communicator::Reduction::maximum);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < over.size(); ++i) {
      if (over[i] == 0) continue;
      rays_[kept] = rays_[i];
      failed_[kept++] = failed_[i];
    }
    rays_.resize(kept);
    failed_.resize(kept);
  }

  Communicator& ranks_;
  const RenderedParts& parts_;
  const std::function<void(const std::function<void()>&)>& together_;
  double part_tolerance_, tolerance_;  ///< of a part's scene, and of all parts of a ray
  CameraFrame<double> camera_;
  std::vector<std::size_t> rays_;
  std::vector<char> failed_;  ///< for each of the rays
  std::uint64_t count_ = 0;
};

}  // namespace

std::uint64_t look_again(Communicator& ranks, const RenderedParts& parts,
                         const std::vector<std::size_t>& over,
                         const std::function<void(const std::function<void()>&)>& together) {
  const std::vector<std::size_t> all = sent(ranks, over);
  if (all.empty()) return 0;
  // Some of everywhere first.
  const std::size_t apart = (all.size() + most_tried - 1) / most_tried;
  std::vector<std::size_t> tried, rest;
  for (std::size_t i = 0; i < all.size(); ++i) (i % apart == 0 ? tried : rest).push_back(all[i]);
  SecondLook second(ranks, parts, together);
  if (second.look(tried) > 0 && !rest.empty()) second.look(rest);
  return second.count();
}

}  // namespace pellucid
