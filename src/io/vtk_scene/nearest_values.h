// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "look.h"
#include "pellucid/scene/label_volume.h"
#include "pellucid/scene/volume.h"

namespace pellucid::vtk_scene {

/// A volume each place of which has the nearest value: as a segmentation, whose labels are the
/// places of their values in ascending order.
struct NearestValues {
  std::shared_ptr<const LabelVolume> labels;
  std::vector<double> values;  ///< of the labels 0, 1, ...
};
/// Throws Error for infinite values, or more than 2^24 different ones.
NearestValues nearest_values(const Volume& volume);
/// Returns VTK's own opacity and color of each value: at a jump those of VTK's choice.
std::vector<ValueLook> looks_of(const std::vector<double>& values,
                                const ComponentSettings& component, const RampRange& ramp,
                                FunctionReader& reader);

}  // namespace pellucid::vtk_scene
