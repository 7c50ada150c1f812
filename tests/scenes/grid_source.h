// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "pellucid/field/grid_gradient.h"
#include "pellucid/render/integrate_multivariate_ray.h"
#include "pellucid/scene/channels.h"
#include "pellucid/scene/internal/multivariate_blocks_storage.h"
#include "pellucid/scene/layer.h"

namespace pellucid::scenes {

/// Channels on a grid as a field of one's own: what a layer shows of it is what a layer of the
/// channels shows, by other code.
class GridSource : public StretchSource {
 public:
  /// `gradient`: of the variable that lights the layer.
  explicit GridSource(std::shared_ptr<const Channels> channels,
                      GradientKind gradient = GradientKind::smooth)
      : StretchSource(described(*channels)),
        channels_(std::move(channels)),
        grid_(multichannel_grid(*channels_)),
        kind_(gradient) {}

  std::unique_ptr<StretchStream> stream(const StretchDemand& demand) const override {
    return std::make_unique<Stream>(*this, demand);
  }

 private:
  class Stream : public StretchStream {
   public:
    Stream(const GridSource& of, const StretchDemand& demand) : of_(of), demand_(demand) {}

    Interval<double> start(const Ray<double>& ray) override {
      ray_ = map().ray(ray);
      return whole_ = grid_interval(of_.grid_.axis, ray_);
    }
    void restrict_to_range(Interval<double> range) override {
      // From the begin of the ray, so that cells reach out of the range.
      walk_.emplace(of_.grid_.axis, ray_, whole_);
      range_ = range;
    }
    bool next(FieldStretch& stretch) override {
      StructuredWalk<double>::Step step;
      while (walk_->next(step)) {
        if (step.t_end <= range_.begin) continue;
        if (step.t_begin >= range_.end) return false;
        MultivariateSpan<double> span;
        if (!make_multivariate_span(of_.grid_, step, span)) continue;  // vacuum
        stretch.begin = step.t_begin;
        stretch.end = step.t_end;
        stretch.position_error = 8 * rounding_unit<double> * step.t_end;
        std::copy_n(span.data, of_.grid_.channels, stretch.data);
        if (demand_.gradient >= 0) {
          gradients_along(corners(demand_.gradient, of_.kind_, step.cell), map().matrix, step.entry,
                          step.exit, stretch.gradient);
        }
        if (demand_.magnitude >= 0) {
          stretch.magnitude =
              magnitude_along(corners(demand_.magnitude, GradientKind::smooth, step.cell),
                              map().matrix, step.entry, step.exit);
        }
        return true;
      }
      return false;
    }

   private:
    const Affine<double>& map() const { return of_.channels_->grid().grid_from_world(); }
    CornerGradients corners(int channel, GradientKind kind, const int (&cell)[3]) const {
      return (*of_.channels_)[channel].volume->visit([&](const auto& grid) {
        if (kind == GradientKind::field) return field_gradients(grid, cell);
        return smooth_gradients(grid, cell, [&](int axis, int value) {
          return neighbor_distances(grid.axis[axis], value);
        });
      });
    }

    const GridSource& of_;
    const StretchDemand demand_;
    Ray<double> ray_{};
    Interval<double> whole_{0, 0}, range_{0, 0};
    std::optional<StructuredWalk<double>> walk_;
  };

  static Description described(const Channels& channels) {
    Description description;
    description.name = "grid";
    Layer layer;
    layer.content = VolumeContent{channels[0].volume, nullptr};
    const auto corners = world_corners(layer);
    description.bounds = {corners[0], corners[0]};
    for (const Vec3<double>& corner : corners) {
      for (int a = 0; a < 3; ++a) {
        description.bounds.lower[a] = std::min(description.bounds.lower[a], corner[a]);
        description.bounds.upper[a] = std::max(description.bounds.upper[a], corner[a]);
      }
    }
    for (const Channel& channel : channels) {
      const VolumeStatistics& data = channel.volume->statistics();
      description.variables.push_back({channel.name, data.minimum, data.maximum});
    }
    description.voxel_size = voxel_of(layer);
    description.has_gradient = description.has_magnitude = true;
    return description;
  }

  const std::shared_ptr<const Channels> channels_;
  const MultichannelGrid grid_;
  const GradientKind kind_;
};

/// Returns the layer of a volume or of channels, in its place, as one of a field of one's own. Its
/// flatness of light is that of the volume.
inline Layer as_source(const Layer& layer) {
  Layer result = moved_into_place(layer);
  if (result.shading && !result.shading->flatness && !result.shading->flat_gradient) {
    result.shading->flat_gradient = flat_gradient(result);
  }
  const GradientKind kind = result.shading ? result.shading->gradient : GradientKind::smooth;
  if (const auto* const volume = std::get_if<VolumeContent>(&result.content)) {
    const Channels channels({{"value", "", volume->volume}});
    result.content = SourceContent{
        std::make_shared<const GridSource>(std::make_shared<const Channels>(channels), kind),
        volume->transfer_function};
  } else {
    const ChannelsContent channels = std::get<ChannelsContent>(result.content);
    result.content = SourceContent{std::make_shared<const GridSource>(channels.channels, kind),
                                   channels.transfer_function};
  }
  return result;
}

}  // namespace pellucid::scenes
