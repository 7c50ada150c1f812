// SPDX-License-Identifier: Apache-2.0
#include "pixel.h"

#include <algorithm>

#include "pellucid/traverse/block_code.h"

namespace pellucid {

ImageView::ImageView(Image& image)
    : width(static_cast<std::size_t>(image.width)),
      pixels(image.pixels.data()),
      depth(image.depth.empty() ? nullptr : image.depth.data()),
      error(image.error.empty() ? nullptr : image.error.data()),
      proved(image.error.empty() ? nullptr : image.proved.data()),
      values(image.values.empty() ? nullptr : image.values.data()) {}

void store_pixel(const Frame& frame, const RayResult& result, std::size_t pixel,
                 const ImageView& image, RenderReport& report) {
  const std::array<double, 4> exact{result.radiance.r, result.radiance.g, result.radiance.b,
                                    result.opacity};
  double brightest = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    image.pixels[pixel][c] = static_cast<float>(exact[c]);
    brightest = std::max(brightest, exact[c]);
  }
  if (image.depth != nullptr) image.depth[pixel] = static_cast<float>(result.half_opacity_depth);

  // A clear pixel is clear whatever the transfer function is off by where it is not zero.
  const double approximation = result.opacity > 0 ? frame.reserved : 0;
  // Both the pixel and the exact one lie between zero and the largest color.
  const double most = std::max(frame.largest_color, 1.0);
  const double error = std::min(result.error + approximation, most) + brightest * 0x1p-24;
  if (image.error != nullptr) {
    image.error[pixel] = float_above(error);
    image.proved[pixel] = result.proved ? 1 : 0;
  }
  if (frame.scene.integration.method != Method::exact) return;
  report.largest_error = std::max(report.largest_error, error);
  if (result.proved) ++report.pixels_proved;
  if (!(error <= frame.scene.integration.tolerance)) ++report.pixels_over_tolerance;
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
