// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "common.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/image.h"

namespace pellucid::python {

/// Python's Image.
struct ImageHandle {
  std::shared_ptr<const Image> image;
  std::optional<Background> background{};  ///< of its .png; none: transparent
  double tolerance = 0;                    ///< 0: no error is known
  RenderReport report{};
};

}  // namespace pellucid::python
