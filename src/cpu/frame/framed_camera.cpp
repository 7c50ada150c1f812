// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/framed_camera.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "pellucid/cpu/renderer.h"
#include "pellucid/scene/view_camera.h"

namespace pellucid {
namespace {

constexpr double seen_opacity = 0.05;
constexpr double outlying_share = 0.001;
constexpr double draft_tolerance = 1.0 / 64;

/// An interval of pixels along an axis: [first, end).
struct PixelRange {
  int first = 0, end = 0;
  int size() const noexcept { return end - first; }
};

/// Returns where pixels are, without `outlying` of them at each side.
PixelRange without_outliers(const std::vector<std::int64_t>& counts, double outlying) {
  PixelRange range{0, static_cast<int>(counts.size())};
  const auto at = [&](int i) { return counts[static_cast<std::size_t>(i)]; };
  for (std::int64_t passed = 0; range.first < range.end - 1; ++range.first) {
    passed += at(range.first);
    if (static_cast<double>(passed) > outlying) break;
  }
  for (std::int64_t passed = 0; range.end > range.first + 1; --range.end) {
    passed += at(range.end - 1);
    if (static_cast<double>(passed) > outlying) break;
  }
  return range;
}

struct SeenPart {
  PixelRange columns, rows;
  std::optional<double> depth;  ///< median distance from the eye; none: the image has no depths
};

/// Returns the part of the picture in which something is seen; none: nothing is.
std::optional<SeenPart> seen_part(const Image& image) {
  float most = 0;
  for (const auto& pixel : image.pixels) most = std::max(most, pixel[3]);
  if (!(most > 0)) return std::nullopt;
  const double least = std::min(seen_opacity, static_cast<double>(most) / 4);
  std::vector<std::int64_t> columns(static_cast<std::size_t>(image.width));
  std::vector<std::int64_t> rows(static_cast<std::size_t>(image.height));
  std::int64_t all = 0;
  std::vector<float> depths;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      if (static_cast<double>(image.at(column, row)[3]) < least) continue;
      ++columns[static_cast<std::size_t>(column)];
      ++rows[static_cast<std::size_t>(row)];
      ++all;
      if (image.depth.empty()) continue;
      const float depth =
          image.depth[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(column)];
      if (std::isfinite(depth)) depths.push_back(depth);
    }
  }
  std::optional<double> median;
  if (!depths.empty()) {
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    median = *middle;
  }
  const double outlying = outlying_share * static_cast<double>(all);
  return SeenPart{without_outliers(columns, outlying), without_outliers(rows, outlying), median};
}

ImageSize draft_size(ImageSize size, int smaller_side) {
  const int smaller = std::min(size.width, size.height);
  // A strip is not drawn longer than four times its width.
  const auto scaled = [&](int side) {
    const double length = std::min(4.0, static_cast<double>(side) / smaller) * smaller_side;
    return static_cast<int>(std::lround(length));
  };
  return {scaled(size.width), scaled(size.height)};
}

}  // namespace

Camera framed_camera(const Camera& start, ImageSize size, const DraftRenderer& draft) {
  Camera camera = start;
  constexpr int max_drafts = 10;
  for (int i = 0; i < max_drafts; ++i) {
    const ImageSize small = draft_size(size, i < 2 ? 64 : 96);
    const CameraFrame<double> frame = make_camera_frame(camera, small);
    const Image image = draft(camera, small);
    const std::optional<SeenPart> seen = seen_part(image);
    if (!seen) return i == 0 ? start : camera;
    const auto& [columns, rows, depth] = *seen;
    if (frame.perspective && depth) {
      // The middle of a thing as thick as it is wide. Where it is far from what the camera turns
      // around, that moves there.
      const double wide = columns.size() * length(frame.right) / image.width,
                   high = rows.size() * length(frame.up) / image.height;
      const double middle = *depth * (1 + std::min(wide, high));
      const Vec3<double> toward = camera.focal_point - camera.position;
      const double ratio = middle / length(toward);
      if (ratio < 0.75 || ratio > 1.33) camera.focal_point = camera.position + toward * ratio;
    }
    // What reaches a border may go on outside.
    const int borders = (columns.first == 0 ? 1 : 0) + (columns.end == image.width ? 1 : 0) +
                        (rows.first == 0 ? 1 : 0) + (rows.end == image.height ? 1 : 0);
    const double x = static_cast<double>(columns.first + columns.end) / image.width - 1;
    const double y = 1 - static_cast<double>(rows.first + rows.end) / image.height;
    const double distance = frame.perspective ? length(camera.focal_point - camera.position) : 1;
    const Vec3<double> move = (frame.right * x + frame.up * y) * distance;
    camera.position = camera.position + move;
    camera.focal_point = camera.focal_point + move;
    if (borders > 0) {
      // In perspective a thing that comes nearer leaves the middle: a small step back finds it.
      zoom_camera(camera, borders > 2 ? 0.25 : borders > 1 ? 0.5 : 0.85);
      continue;
    }
    const double filled = std::max(static_cast<double>(columns.size()) / image.width,
                                   static_cast<double>(rows.size()) / image.height);
    const double pixel = 1.0 / std::min(image.width, image.height);
    const bool is_near = std::abs(filled - framed_share) < 2 * pixel;
    if (is_near && i >= 2 && std::max(std::abs(x), std::abs(y)) < 4 * pixel) {
      zoom_camera(camera, framed_share / filled);
      break;
    }
    // A thing of few pixels may be two larger.
    zoom_camera(camera, framed_share / (is_near ? filled : filled + 2 * pixel));
  }
  return camera;
}

Scene draft_scene(const Scene& scene) {
  Scene draft = scene;
  draft.samples = 1;
  draft.background.reset();
  draft.backdrop.reset();
  draft.integration = Integration{};
  draft.integration.tolerance = draft_tolerance;
  for (Layer& layer : draft.layers) layer.shading.reset();
  return draft;
}

Camera framed_camera(const Scene& scene, const Camera& start, const Machine& machine,
                     const FrameMonitor& monitor) {
  Scene draft = draft_scene(scene);
  RenderOptions plain;
  plain.machine = machine;
  plain.monitor.progress = monitor.progress;
  plain.monitor.stop = monitor.stop;
  plain.outputs.depth = true;
  Renderer renderer(machine.threads);
  return framed_camera(start, scene.size, [&](const Camera& camera, ImageSize size) {
    draft.camera = camera;
    draft.size = size;
    return renderer.render(draft, plain).image;
  });
}

}  // namespace pellucid
