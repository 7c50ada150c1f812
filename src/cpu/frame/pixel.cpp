// SPDX-License-Identifier: Apache-2.0
#include "pixel.h"

#include <algorithm>

#include "pellucid/render/pixel.h"

namespace pellucid {

void store_pixel(const Frame& frame, const RayResult& result, std::size_t pixel,
                 const ImageView& image, RenderReport& report) {
  const StoredPixel stored = stored_pixel(
      result, {frame.reserved, frame.largest_color, frame.scene.integration.tolerance});
  std::copy_n(stored.color, 4, image.pixels[pixel].begin());
  if (image.depth != nullptr) image.depth[pixel] = stored.depth;
  if (image.error != nullptr) {
    image.error[pixel] = stored.stored_error();
    image.proved[pixel] = stored.proved ? 1 : 0;
  }
  if (frame.scene.integration.method != Method::exact) return;
  report.largest_error = std::max(report.largest_error, stored.error);
  if (stored.proved) ++report.pixels_proved;
  if (!(stored.error <= frame.scene.integration.tolerance)) ++report.pixels_over_tolerance;
}

void add_work(RenderReport& sum, const RayResult& result) {
  sum.cells += static_cast<std::uint64_t>(result.cells);
  sum.evaluations += static_cast<std::uint64_t>(result.evaluations);
  sum.spans += result.spans;
}

void add(RenderReport& sum, const RenderReport& part) {
  sum.rays += part.rays;
  sum.pixels_interpolated += part.pixels_interpolated;
  sum.cells += part.cells;
  sum.largest_error = std::max(sum.largest_error, part.largest_error);
  sum.pixels_proved += part.pixels_proved;
  sum.pixels_over_tolerance += part.pixels_over_tolerance;
  sum.evaluations += part.evaluations;
  sum.spans += part.spans;
}

}  // namespace pellucid
