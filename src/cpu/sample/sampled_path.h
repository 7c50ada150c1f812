// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stop_token>
#include <vector>

#include "layers/clipped_layer.h"
#include "layers/layer_merge.h"
#include "layers/layer_points.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/segment/gaussian_mixture.h"
#include "pellucid/segment/segment_rule.h"
#include "preintegrated_storage.h"
#include "ray_tracer.h"

namespace pellucid {

/// How a method for comparison samples the layers of a scene; shared by threads.
class SamplingPlan {
 public:
  /// `layers` must outlive the object; of a scene that check_method() accepts. `integration`: its
  /// method is not `exact`. `largest_color`: of all that a ray may meet.
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

/// Samples rays through any layers by any rule, for comparison with the general path and for
/// pictures while something moves. In: the points of layers (layer_points.h), in steps of the
/// finest layer there, cut where layers begin or end and at surfaces; or the stretches of meshes.
/// Out: what a ray gathers, of unknown error. Used by one thread.
class SampledPath {
 public:
  /// All must outlive the object.
  SampledPath(const std::vector<ClippedLayer>& layers,
              const std::vector<LightSource<double>>& lights, const SamplingPlan& plan,
              double largest_color);
  SampledPath(const SampledPath&) = delete;
  SampledPath& operator=(const SampledPath&) = delete;
  ~SampledPath();

  /// After a request to stop the result does not matter.
  RayResult sample(const RayPart& part, const std::stop_token& stop);

 private:
  /// A layer on a segment.
  struct OnSegment {
    bool present = false;
    LayerPoint front, middle, back;
  };
  class LayerOnRay;
  struct Surface {
    double t, opacity;
    Rgb<double> color;
  };
  struct Gathered {
    double begin, end, depth;
  };

  bool is_over() const;
  void step_through(const RayPart& part);
  void step_between(double first, double last, double step);
  void go_through_cells(const RayPart& part);
  void find_surfaces(const RayPart& part);
  void find_crossings(double begin, double end);
  double crossing(LayerPoints& points, const Isosurface& surface, double begin, double end,
                  double before, double behind, LayerPoint& at) const;
  void add_step(double begin, double end);
  void add_part(double begin, double end);
  void add_segment(double begin, double end);
  void add_surface(const Surface& surface);
  void add(const SegmentResult<double>& segment, double begin, double end);
  SegmentResult<double> of_materials(double begin, double end);
  SegmentResult<double> of_data(double begin, double end);
  Material<double> material(std::size_t layer, LayerPoint& point, double t);
  void light_up_point(std::size_t layer, LayerPoint& point, double t,
                      Material<double>& material) const;
  void add_data(std::size_t layer, int number, const double* front, const double* back,
                double begin, double end, DepthWeightedColor<double>& sum);
  double half_opacity_depth(double opacity) const;

  const SamplingPlan& plan_;
  const std::vector<LightSource<double>>& lights_;
  LayerMerge merge_;  ///< for surfaces and tetrahedra
  std::vector<std::unique_ptr<LayerOnRay>> layers_;
  std::vector<OnSegment> on_;
  /// Whether all layers' points go back, and none has slices: isosurfaces are then looked for where
  /// samples change their sides, which takes less time than a walk.
  bool by_sides_ = true;
  // Of the ray:
  Ray<double> ray_{};
  FrontToBackCompositor<double> fold_;
  long segments_ = 0;
  double sampled_to_ = 0;     ///< the end of the last segment, to which `back` belongs
  std::vector<double> ends_;  ///< where layers begin and end
  const std::stop_token* stop_ = nullptr;
  std::vector<Surface> surfaces_;
  std::size_t next_surface_ = 0;
  std::vector<Gathered> gathered_;
};

}  // namespace pellucid
