// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "frame.h"
#include "pellucid/cpu/render.h"
#include "pellucid/render/ray_result.h"

namespace pellucid {

/// View of an image's own memory, to which the pixels of a frame go, row by row.
struct ImageView {
  std::size_t width;
  std::array<float, 4>* pixels;
  float* depth;          ///< null: not asked for
  float* error;          ///< null: not asked for
  std::uint8_t* proved;  ///< of the presence of `error`
  float* values;         ///< null: not asked for

  explicit ImageView(Image& image);
  std::size_t index(int column, int row) const noexcept {
    return static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
  }
};

/// Puts the pixel into the image, and what it is off by into the report.
void store_pixel(const Frame& frame, const RayResult& result, std::size_t pixel,
                 const ImageView& image, RenderReport& report);

/// Adds the counts of a pixel's rays.
void add_work(RenderReport& sum, const RayResult& result);

/// One tile's part of the report, or the whole.
void add(RenderReport& sum, const RenderReport& part);

}  // namespace pellucid
