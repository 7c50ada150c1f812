// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// Returns why a picture shows next to nothing, or is burnt, and what to do, in one sentence; none:
/// it is neither.
///
/// - Less than one pixel in 200 has an opacity of 2 % or more: the functions absorb nowhere where
///   the data are, or too little, or the camera looks elsewhere.
/// - A tenth of those that have one have a channel above 1.05 of it: lights or colors are too
/// bright.
///
/// The scene must have passed check_data(); the image is its picture.
std::optional<std::string> picture_advice(const Scene& scene, const Image& image);

/// Returns a sentence for each visible layer with isosurfaces at values that its data do not have,
/// and for each with slices whose planes miss its data. The scene must have passed check_data().
std::vector<std::string> surface_advice(const Scene& scene);

}  // namespace pellucid
