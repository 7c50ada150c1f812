// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common.h"
#include "pellucid/cpu/render.h"
#include "pellucid/io/color_bar.h"
#include "pellucid/io/figure.h"
#include "pellucid/scene/image.h"

namespace pellucid::python {

/// Python's Image.
struct ImageHandle {
  std::shared_ptr<const Image> image;
  std::optional<Background> background{};  ///< of its .png; none: transparent
  double tolerance = 0;                    ///< 0: no error is known
  RenderReport report{};
  std::vector<ColorBar> bars{};        ///< of the scene that it shows
  std::optional<FigureSpace> space{};  ///< world of that scene; none: not known
  FigureAccuracy accuracy{};           ///< without what `report` tells
};

/// Returns a handle without an image, which knows the legends, the world and the accuracy of a
/// scene.
ImageHandle image_of_scene(const SceneDescription& description, const Scene& scene,
                           std::optional<Background> background);

}  // namespace pellucid::python
