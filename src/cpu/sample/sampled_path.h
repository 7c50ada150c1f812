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
#include "ray_tracer.h"
#include "sampling_plan.h"

namespace pellucid {

/// Samples rays through any layers by any rule, for comparison with the general path and for
/// pictures while something moves. In: the points of layers (layer_points.h), in steps of the
/// finest layer there, cut where layers begin or end and at surfaces; or the stretches of meshes.
/// Out: what a ray gathers, of unknown error. Used by one thread.
class SampledPath {
 public:
  /// Samples layers in light. All must outlive the object.
  SampledPath(const std::vector<ClippedLayer>& layers,
              const std::vector<LightSource<double>>& lights, const SamplingPlan& plan,
              double largest_color);
  SampledPath(const SampledPath&) = delete;
  SampledPath& operator=(const SampledPath&) = delete;
  ~SampledPath();

  /// Samples a part of a ray. After a request to stop the result does not matter.
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
  static double crossing(LayerPoints& points, const Isosurface& surface, double begin, double end,
                         double before, double behind, LayerPoint& at);
  void add_step(double begin, double end);
  void add_part(double begin, double end);
  void add_segment(double begin, double end);
  void add_surface(const Surface& surface);
  void add(const SegmentResult<double>& segment, double begin, double end);
  SegmentResult<double> of_materials(double begin, double end);
  SegmentResult<double> of_data(double begin, double end);
  void add_material(std::size_t layer, LayerPoint& point, double t,
                    DepthWeightedColor<double>& sum) const;
  Rgb<double> lit(const Reflection<double>& reflection, const LayerPoint& point, double t,
                  const Rgb<double>& color) const;
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
  /// True if all layers' points go back, and none has slices: isosurfaces are then looked for where
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
