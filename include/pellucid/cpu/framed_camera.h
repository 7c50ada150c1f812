// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "pellucid/cpu/render.h"

namespace pellucid {

/// Share of the picture's width or height that framed_camera() fills.
inline constexpr double framed_share = 0.88;

/// Renders a draft of a scene from a camera at a size; only its opacities count, and its depths if
/// there are.
using DraftRenderer = std::function<Image(const Camera&, ImageSize)>;

/// Moves a camera, without turning it, until the picture is filled: the pixels that are seen reach
/// over framed_share of its width or height, whichever is reached first, and lie in its middle. A
/// pixel is seen if its opacity is 5 % or more, or a quarter of the largest one if that is less;
/// the outermost 0.1 % of such pixels at each side do not count, because noise makes some.
///
/// Takes three drafts of 64 to 96 pixels along the smaller side, and up to ten for a small thing in
/// a large volume. If it is far from what the camera turns around, and drafts have depths, the
/// focal point moves to it. Where nothing is seen, the camera stays. `size`: of the picture. Throws
/// what `draft` throws.
Camera framed_camera(const Camera& start, ImageSize size, const DraftRenderer& draft);

/// Returns the same of a scene, whose camera is not looked at: drafts are unlit, without background
/// and backdrop, and neither previewed nor told tile by tile. Throws Error if the scene fails its
/// checks, and Cancelled.
Camera framed_camera(const Scene& scene, const Camera& start, const Machine& machine = {},
                     const FrameMonitor& monitor = {});

/// Returns the scene that a draft renders: `scene` without light, background and backdrop, to a
/// coarse tolerance.
Scene draft_scene(const Scene& scene);

}  // namespace pellucid
