// SPDX-License-Identifier: Apache-2.0
#include "relative_tolerance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

namespace pellucid::cli {

double largest_channel(const Image& image) {
  float largest = 0;
  for (const auto& pixel : image.pixels) {
    for (const float channel : pixel) largest = std::max(largest, channel);
  }
  return static_cast<double>(largest);
}

namespace {

/// Returns the nearest pixels of a backdrop.
std::shared_ptr<const Image> shrunk(const Image& backdrop, ImageSize size) {
  auto small = std::make_shared<Image>();
  small->width = size.width;
  small->height = size.height;
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      const std::size_t from =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(backdrop.height) /
              static_cast<std::size_t>(size.height) * static_cast<std::size_t>(backdrop.width) +
          static_cast<std::size_t>(column) * static_cast<std::size_t>(backdrop.width) /
              static_cast<std::size_t>(size.width);
      small->pixels.push_back(backdrop.pixels.at(from));
      small->depth.push_back(backdrop.depth.at(from));
    }
  }
  return small;
}

}  // namespace

double estimate_range(const Scene& scene, const Machine& machine, const FrameMonitor& monitor) {
  constexpr int longest_side = 96;
  Scene small = scene;
  small.samples = 1;
  const int longest = std::max(scene.size.width, scene.size.height);
  if (longest > longest_side) {
    const auto scaled = [&](int side) {
      const double length = static_cast<double>(side) * longest_side / longest;
      return std::max(1, static_cast<int>(std::lround(length)));
    };
    small.size = {scaled(scene.size.width), scaled(scene.size.height)};
    if (scene.backdrop) {
      check_integration(scene);
      small.backdrop = shrunk(*scene.backdrop, small.size);
    }
  }
  RenderOptions plain;
  plain.machine = machine;
  plain.monitor.progress = monitor.progress;
  plain.monitor.stop = monitor.stop;
  // The range is known to an eighth.
  constexpr double sharper = 8, next = 1.0 / 64;
  small.integration.tolerance = default_tolerance;
  for (;;) {
    const double largest = largest_channel(render(small, plain).image);
    const double tolerance = small.integration.tolerance;
    if (largest >= sharper * tolerance || tolerance <= smallest_tolerance) return largest;
    small.integration.tolerance = nearest_tolerance(tolerance * next);
  }
}

RelativePicture render_relative(double share, double estimated_range,
                                const std::function<RenderResult(double tolerance)>& render_at) {
  // The range is not known before the picture is; a little less makes a second rendering rare.
  constexpr double margin = 0.9;
  constexpr int max_renderings = 6;
  RelativePicture picture;
  double range = estimated_range, seconds = 0;
  for (int i = 0; i < max_renderings; ++i) {
    picture.tolerance = std::clamp(margin * share * range, 1e-30, largest_tolerance);
    RenderResult frame = render_at(picture.tolerance);
    picture.image = std::move(frame.image);
    picture.report = std::move(frame.report);
    seconds += picture.report.seconds;
    picture.largest = largest_channel(picture.image);
    const double wanted = share * picture.largest;
    // The picture may be better than the smallest tolerance.
    picture.over.reset();
    if (picture.report.largest_error <= wanted) break;
    picture.over = fmt::format(
        "pixels may be off by up to {:.3g}, more than {} of the largest channel, {:.3g}{}",
        picture.report.largest_error, percent_text(share), picture.largest,
        wanted < smallest_tolerance
            ? fmt::format("; the smallest tolerance is {:g}", smallest_tolerance)
            : "");
    // Where pixels miss their tolerance, a smaller one does not help.
    if (std::max(picture.tolerance, smallest_tolerance) <= wanted) break;
    if (picture.tolerance <= smallest_tolerance) break;
    range = picture.largest;
  }
  picture.report.seconds = seconds;
  return picture;
}

std::string percent_text(double share) {
  return fmt::format("{:.6g} %", 100 * share);
}

std::optional<std::string> black_picture_text(double largest, double tolerance, double error,
                                              bool png) {
  // Half of the first step of 8-bit sRGB: a .png shows 0.
  constexpr double darkest = 0.5 / 255 / 12.92;
  // 5 of 255: what looks black. A picture at a coarse tolerance may be bright.
  constexpr double black = 0.02, rounding = 1e-12;
  if (png && largest > tolerance && largest < darkest) {
    return fmt::format(
        "the largest channel is {:.3g}, which is 0 in a .png: write an .exr, or raise the "
        "extinctions",
        largest);
  }
  if (largest > std::min(tolerance, black)) return std::nullopt;
  if (largest == 0 && error <= rounding) {
    return "the picture is empty: no ray meets anything that absorbs; look at the camera and the "
           "transfer function";
  }
  return fmt::format(
      "no channel of any pixel is above the tolerance, {:.3g}: the picture may be black though the "
      "scene is not; --tolerance 1% asks for 1 % of the largest channel",
      tolerance);
}

}  // namespace pellucid::cli
