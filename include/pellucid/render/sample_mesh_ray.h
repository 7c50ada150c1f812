// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/render/integrate_mesh_ray.h"
#include "pellucid/segment/cell_model.h"
#include "pellucid/segment/gaussian_step.h"

namespace pellucid {

/// Marches a ray through a mesh with one segment per tetrahedron, for comparison: segment_of(span)
/// returns the segment. Its error is unknown. The ray ends where the transparency is at most
/// `stop`. Vacuum and overlapping parts of the mesh are skipped.
///
/// If `depth` is finite, the ray ends where the optical depth reaches it, and
/// RayResult::half_opacity_depth is that position.
template <class SegmentOf>
PELLUCID_HD RayResult
sample_mesh_spans(const Tetrahedra& mesh, const MeshFields& fields, const MeshRay& ray,
                  const SegmentOf& segment_of, double stop,
                  double depth = std::numeric_limits<double>::infinity()) noexcept {
  RayResult result;
  FrontToBackCompositor<double> fold(stop);
  for_each_mesh_span(mesh, fields, ray.view, ray.hits, ray.count, [&](const MeshSpan& span) {
    ++result.cells;
    if (span.vacuum || span.overlaps) return true;
    const SegmentResult<double> segment = segment_of(span);
    const double before = fold.optical_depth();
    fold.add(segment);
    if (fold.optical_depth() >= depth) {
      // Within a cell the models know no more than a constant extinction.
      result.half_opacity_depth =
          span.begin + (depth - before) / segment.optical_depth * (span.end - span.begin);
      return false;
    }
    return !fold.done();
  });
  result.evaluations = result.cells;
  result.radiance = fold.radiance();
  result.optical_depth = fold.optical_depth();
  result.opacity = fold.opacity();
  return result;
}

/// Marches with a model of the cell. `transfer` is a PiecewiseLinear of one variable or a
/// MultivariateTransfer.
template <class Transfer>
PELLUCID_HD RayResult
sample_mesh_ray(const Tetrahedra& mesh, const MeshFields& fields, const Transfer& transfer,
                CellModel model, const PsiTable& psi, const MeshRay& ray, double stop,
                double depth = std::numeric_limits<double>::infinity()) noexcept {
  const auto segment_of = [&](const MeshSpan& span) noexcept {
    return cell_segment(model, psi, transfer, fields.channels, span.front, span.back,
                        span.end - span.begin);
  };
  return sample_mesh_spans(mesh, fields, ray, segment_of, stop, depth);
}

/// Marches like Kniss et al. 2003, who take the data of a segment as linear; in a tetrahedron they
/// are.
PELLUCID_HD inline RayResult sample_mesh_gaussians(
    const Tetrahedra& mesh, const MeshFields& fields, const MultivariateTransfer<double>& transfer,
    GaussianRule rule, const MeshRay& ray, double stop,
    double depth = std::numeric_limits<double>::infinity()) noexcept {
  const auto segment_of = [&](const MeshSpan& span) noexcept {
    return mean_color_segment(rule, transfer, span.front, span.back, span.end - span.begin);
  };
  return sample_mesh_spans(mesh, fields, ray, segment_of, stop, depth);
}

}  // namespace pellucid
