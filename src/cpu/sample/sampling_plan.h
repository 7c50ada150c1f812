// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "layers/clipped_layer.h"
#include "pellucid/segment/segment_rule.h"
#include "preintegrated_storage.h"

namespace pellucid {

/// Plan by which a method for comparison samples the layers of a scene; shared by threads.
class SamplingPlan {
 public:
  /// Plans for layers, which must outlive the object; of a scene that check_method() accepts.
  /// `integration`: its method is not `exact`. `largest_color`: of all that a ray may meet.
  SamplingPlan(const std::vector<ClippedLayer>& layers, const Integration& integration,
               double largest_color, bool depth);

  SegmentRule rule() const noexcept { return rule_; }
  /// Returns whether segments are those of the meshes' tetrahedra, in place of steps.
  bool by_cells() const noexcept { return by_cells_; }
  /// Returns the step of a layer by itself, world length.
  double step(std::size_t layer) const noexcept { return steps_[layer]; }
  /// Returns the transparency at which a ray ends.
  double stop() const noexcept { return stop_; }
  /// Returns whether the depth of half opacity is asked for.
  bool depth() const noexcept { return depth_; }
  /// Returns the table of a layer's function; empty if the rule is another than `preintegrated`.
  PreintegratedTable table(std::size_t layer, int function) const noexcept {
    if (tables_.empty()) return {};
    return tables_[layer][static_cast<std::size_t>(function)]->view();
  }
  const PsiTable& psi() const noexcept { return psi_; }

 private:
  SegmentRule rule_;
  bool by_cells_;
  double stop_;
  bool depth_;
  std::vector<double> steps_;  ///< of each layer
  PsiTable psi_{};
  std::vector<std::vector<std::unique_ptr<const PreintegratedStorage>>> tables_;
};

}  // namespace pellucid
