// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "clip_intervals.h"
#include "grid/field.h"
#include "grid/grid.h"
#include "mixture/mixture.h"
#include "pellucid/scene/layer.h"

namespace pellucid::reference {

/// A stretch of a ray on which the data of a layer are polynomials of one function.
struct LayerStretch {
  Real t_begin, t_end;
  std::vector<Chord> chords;  ///< as Stretch has them
  const Mixture* function;
};

/// Data of one layer along rays. A view of its data, clips and those of the scene.
class LayerData {
 public:
  /// Prepares a layer, which is in its place.
  LayerData(const Layer& layer, const std::vector<Clip>& of_scene);

  /// Returns the stretches of a ray at t >= 0 that clips keep, front to back. Adds the number of
  /// cells crossed to `cells`, and the length on which the data have two values to `overlap`.
  std::vector<LayerStretch> stretches(const RealRay& ray, std::uint64_t& cells,
                                      Real& overlap) const;

 private:
  std::vector<LayerStretch> stretches_of_labels(const RealRay& ray) const;
  void cut_by_mask(const RealRay& ray, std::vector<LayerStretch>& list) const;
  const Mixture* function_of(Real label) const;

  std::unique_ptr<const Field> field_;  ///< null: labels
  std::optional<Grid> labels_;          ///< of labels and of a mask
  std::deque<Mixture> functions_;       ///< the first is that of the field
  std::vector<std::int32_t> label_of_;  ///< of the functions behind that one, or of all
  std::deque<std::vector<TransferFunction::Point>> points_;
  std::vector<const Clip*> clips_;
};

}  // namespace pellucid::reference
