// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/mesh_field_storage.h"
#include "mesh/mesh_hits.h"
#include "mesh_gradient.h"
#include "pellucid/render/integrate_mesh_ray.h"
#include "variables_source.h"

namespace pellucid {
namespace {

/// A mesh with a function of one or of several variables.
class MeshSource : public VariablesSource {
 public:
  explicit MeshSource(const LayerTask& task)
      : VariablesSource(task, std::get<MeshContent>(task.layer.content).transfer_function),
        content_(std::get<MeshContent>(task.layer.content)),
        mesh_(content_.mesh->mesh().view()),
        fields_(*content_.mesh) {
    if (look().reflection() != nullptr) {
      const Shading& shading = *task.layer.shading;
      gradient_.emplace(mesh_, fields_.view().channel[shading.channel], points(), shading.gradient);
    }
    if (const auto& factors = task.layer.gradient_opacity) {
      magnitude_.emplace(mesh_, fields_.view().channel[factors->channel()], points(),
                         GradientKind::smooth);
    }
  }

  std::unique_ptr<LayerStream> stream(bool by_cells) const override;

  const Tetrahedra& mesh() const { return mesh_; }
  const MeshFields& fields() const { return fields_.view(); }
  /// Return the gradients for light and for gradient opacity; null where nothing needs them.
  const MeshGradient* gradient() const { return gradient_ ? &*gradient_ : nullptr; }
  const MeshGradient* magnitude() const { return magnitude_ ? &*magnitude_ : nullptr; }

 private:
  std::size_t points() const { return content_.mesh->mesh().points().size(); }

  const MeshContent& content_;
  Tetrahedra mesh_;
  MeshFieldStorage fields_;
  std::optional<MeshGradient> gradient_, magnitude_;
};

/// The tetrahedra that a ray crosses. It finds all of them before the first is asked for.
class MeshStream : public LayerStream {
 public:
  explicit MeshStream(const MeshSource& source) : source_(source) {}

  Interval<double> start(const Ray<double>& ray) override {
    ray_ = ray;
    spans_.clear();
    next_ = 0;
    const MeshRay hits = hits_.find(source_.mesh(), ray);
    const Interval<double> extent = hits.extent();
    for_each_mesh_span(source_.mesh(), source_.fields(), hits.view, hits.hits, hits.count,
                       [&](const MeshSpan& span) {
                         spans_.push_back(span);
                         return true;
                       });
    if (spans_.empty()) return extent;
    return {std::min(extent.begin, spans_.front().begin), std::max(extent.end, spans_.back().end)};
  }
  void restrict_to_range(Interval<double> range) override {
    range_ = range;
    // The last span of the former range may reach into this one.
    if (next_ > 0) --next_;
  }

  bool next(LayerStretch& stretch) override {
    while (next_ < spans_.size()) {
      const MeshSpan& span = spans_[next_];
      if (span.begin >= range_.end) return false;
      ++next_;
      const bool has_length = span.begin < span.end;
      if (span.end < range_.begin || (has_length && span.end <= range_.begin)) continue;
      fill(span, has_length, stretch);
      return true;
    }
    return false;
  }

 private:
  void fill(const MeshSpan& span, bool has_length, LayerStretch& stretch) const {
    stretch.begin = std::max(span.begin, range_.begin);
    stretch.end = std::min(span.end, range_.end);
    stretch.function = -1;
    if (span.overlaps || span.vacuum || !has_length) {
      // Overlapping cells make the rest of the ray unknown. Cells next to vacuum, or of length 0,
      // may begin and end elsewhere.
      const double off = span.position_error + span.end_error;
      stretch.unknown = span.overlaps ? 1 : std::min(source_.most_extinction() * off, 1.0);
      return;
    }
    const MultivariateTransfer<double>& transfer = source_.functions().front();
    stretch.function = 0;
    stretch.position_error = span.position_error + span.end_error;
    stretch.left_out = source_.extinction_error([&](const MultivariateTransfer<double>& function) {
      return detail::extinction_error(function, span);
    });
    const double length = span.end - span.begin;
    const double from = (stretch.begin - span.begin) / length;
    const double to = (stretch.end - span.begin) / length;
    for (int c = 0; c < transfer.channels; ++c) {
      const LinearBernstein<double> whole{{span.front[c], span.back[c]}};
      const bool cut = from > 0 || to < 1;
      stretch.data[c] = as_cubic(cut ? restrict_to(whole, from, to) : whole);
      stretch.value_error[c] = span.value_error[c];
    }
    const Interval<double> range{stretch.begin, stretch.end};
    if (source_.gradient() != nullptr) {
      source_.gradient()->along(span.tetrahedron, ray_, range, stretch.gradient);
    }
    if (source_.magnitude() != nullptr) {
      stretch.magnitude = source_.magnitude()->magnitude_along(span.tetrahedron, ray_, range);
    }
    if (const ChannelTransferFunction* const factor = source_.look().value_factor()) {
      stretch.magnitude = source_.look().factor_argument(stretch.data[factor->channel]);
    }
  }

  const MeshSource& source_;
  Ray<double> ray_{};
  MeshHits hits_;
  std::vector<MeshSpan> spans_;
  std::size_t next_ = 0;
  Interval<double> range_{0, 0};
};

std::unique_ptr<LayerStream> MeshSource::stream(bool /*by_cells*/) const {
  return std::make_unique<MeshStream>(*this);
}

}  // namespace

std::unique_ptr<const LayerSource> make_mesh_source(const LayerTask& task) {
  return std::make_unique<MeshSource>(task);
}

}  // namespace pellucid
