// SPDX-License-Identifier: Apache-2.0
#include "layers/clip_intervals.h"
#include "mesh/mesh_field_storage.h"
#include "mesh/mesh_hits.h"
#include "projection/kept_parts.h"
#include "projection/layer_projector.h"
#include "projection/value_gatherer.h"

namespace pellucid {
namespace {

struct MeshWorkspace : ProjectionWorkspace {
  MeshHits hits;
  std::vector<MeshSpan> spans;
};

/// Tetrahedra with one variable, linear or constant in each.
class MeshProjector : public LayerProjector {
 public:
  explicit MeshProjector(const ProjectorTask& task)
      : content_(std::get<MeshContent>(task.layer.content)),
        projection_(*task.layer.projection),
        mesh_(content_.mesh->mesh().view()),
        fields_(*content_.mesh),
        data_(content_.mesh->statistics(0)),
        clips_(task.clips) {}

  std::unique_ptr<ProjectionWorkspace> workspace() const override {
    return std::make_unique<MeshWorkspace>();
  }

  RayValue project(const Ray<double>& ray, double end,
                   ProjectionWorkspace& workspace) const override {
    auto& own = static_cast<MeshWorkspace&>(workspace);
    auto& spans = own.spans;
    ValueGatherer gatherer(projection_, data_.minimum, data_.maximum);
    spans.clear();
    const MeshRay found = own.hits.find(mesh_, ray);
    Interval<double> inside = found.extent();
    for_each_mesh_span(mesh_, fields_.view(), found.view, found.hits, found.count,
                       [&](const MeshSpan& span) {
                         spans.push_back(span);
                         return true;
                       });
    RayValue result;
    if (spans.empty()) return gatherer.result({});
    inside = {std::max(std::min(inside.begin, spans.front().begin), 0.0),
              std::min(std::max(inside.end, spans.back().end), end)};
    const KeptParts parts(inside, clips_, ray);
    ValueGatherer::Errors errors;
    errors.position = parts.position_error();
    bool is_unknown = gatherer.is_extreme() && parts.is_doubtful();
    for (const MeshSpan& span : spans) {
      ++result.cells;
      if (!(span.begin <= inside.end)) break;
      is_unknown = is_unknown || span.overlaps;
      if (span.vacuum) continue;
      errors.position += span.end_error;
      for (const Interval<double>& part : parts.kept()) {
        add(span, part, gatherer, errors);
      }
    }
    const long cells = result.cells;
    result = gatherer.result(errors);
    result.is_unknown = result.is_unknown || is_unknown;
    result.cells = cells;
    return result;
  }

 private:
  /// Adds what a part of the ray has of a span.
  static void add(const MeshSpan& span, const Interval<double>& part, ValueGatherer& gatherer,
                  ValueGatherer::Errors& errors) {
    const double begin = std::max(span.begin, part.begin), stop = std::min(span.end, part.end);
    if (!(begin < stop)) {
      // Rounding may have taken its length, but not what it has of an extreme.
      if (gatherer.is_extreme() && span.begin == span.end && begin == stop) {
        gatherer.add_doubtful(as_cubic(LinearBernstein<double>{{span.front[0], span.back[0]}}), 0);
      }
      return;
    }
    const double length = span.end - span.begin;
    const LinearBernstein<double> whole{{span.front[0], span.back[0]}};
    const bool is_cut = begin > span.begin || stop < span.end;
    const LinearBernstein<double> data =
        is_cut ? restrict_to(whole, (begin - span.begin) / length, (stop - span.begin) / length)
               : whole;
    const double slope = std::abs(span.back[0] - span.front[0]) / length;
    // The value at an end that is off by an error of its position; rounding has 8 u of it.
    const double off = span.value_error[0] + std::min(slope * span.position_error,
                                                      std::abs(span.back[0] - span.front[0]));
    if (length <= 2 * (span.end_error + span.position_error)) {
      gatherer.add_doubtful(as_cubic(data), stop - begin);
    } else {
      errors.slope = std::max(errors.slope, slope);
      gatherer.add(as_cubic(data), stop - begin, off);
    }
  }

  const MeshContent& content_;
  LayerProjection projection_;
  Tetrahedra mesh_;
  MeshFieldStorage fields_;
  VolumeStatistics data_;
  std::vector<Clip> clips_;
};

}  // namespace

std::unique_ptr<const LayerProjector> make_mesh_projector(const ProjectorTask& task) {
  return std::make_unique<MeshProjector>(task);
}

std::unique_ptr<const LayerProjector> make_layer_projector(const ProjectorTask& task) {
  return std::holds_alternative<MeshContent>(task.layer.content) ? make_mesh_projector(task)
                                                                 : make_grid_projector(task);
}

}  // namespace pellucid
