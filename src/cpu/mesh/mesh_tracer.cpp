// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "gaussians/culled_mixture_storage.h"
#include "grid/packet_tracer.h"
#include "mesh_field_storage.h"
#include "mesh_hits.h"
#include "packet_setup.h"
#include "pellucid/packet/mesh_interface.h"
#include "pellucid/render/integrate_mesh_ray.h"
#include "pellucid/scene/internal/binned_transfer_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "ray_tracer.h"

struct PellucidSpanContext {
  const pellucid::TransferTables* transfer;
  double largest_color;
};

namespace pellucid {
namespace {

const MeshContent& content_of(const TracerTask& task) {
  return std::get<MeshContent>(task.layer.content);
}

const MeshChannels& mesh_of(const TracerTask& task) {
  return *content_of(task).mesh;
}

using Kernel = void (*)(const PellucidMeshJob*);

/// Returns null where rays go one by one.
Kernel kernel_for(InstructionSet set, bool several) {
  return several ? PELLUCID_KERNEL_OF(set, pellucid_integrate_multivariate_mesh)
                 : PELLUCID_KERNEL_OF(set, pellucid_integrate_mesh);
}

class MeshTracer : public RayTracer {
 public:
  explicit MeshTracer(const TracerTask& task)
      : mesh_(mesh_of(task).mesh().view()),
        fields_(mesh_of(task)),
        wanted_(task.wanted),
        depth_(task.options.outputs.depth) {}

  /// Single rays are followed from end to end.
  bool keeps_to_ranges() const override { return kernel_ != nullptr; }

  std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                               const TraceOptions& options) const override {
    std::vector<RayResult> results(parts.size());
    integrate(parts, options, results);
    if (depth_) find_half_opacity(parts, results);
    return results;
  }

 protected:
  virtual void integrate(const std::vector<RayPart>& rays, const TraceOptions& options,
                         std::vector<RayResult>& results) const = 0;
  /// Finds the half-opacity depths of rays for which this is known; for others the general path
  /// does.
  virtual void find_half_opacity(const std::vector<RayPart>& /*rays*/,
                                 std::vector<RayResult>& /*results*/) const {}

  /// Sets up packets, where the mesh and what is wanted suit them.
  void prepare(const TracerTask& task, double largest_extinction, bool several) {
    const InstructionSet set = packet_instruction_set(task.options.machine.instruction_set);
    const MeshChannels& channels = mesh_of(task);
    if (wanted_.precision != Precision::automatic || wanted_.tolerance < min_packet_tolerance ||
        !is_moderate(channels.mesh().statistics().mean_edge) || largest_extinction > 1e12) {
      return;
    }
    for (int c = 0; c < channels.count(); ++c) {
      const double largest = largest_value(channels.statistics(c));
      if (!is_moderate(largest) && !(several && largest == 0)) return;
    }
    kernel_ = kernel_for(set, several);
    if (kernel_ == nullptr) return;
    job_.mesh = &mesh_;
    job_.fields = &fields_.view();
    job_.tolerance = wanted_.tolerance;
    job_.largest_color = std::max(wanted_.largest_color, 1.0);
    job_.largest_extinction = largest_extinction;
    job_.proved = wanted_.grade == Grade::proved ? 1 : 0;
    job_.depth = depth_ ? 1 : 0;
    points_ = fields_.points(mesh_of(task).mesh().points());
    job_.points = points_.data();
  }

  /// Follows the rays of `left` in packets, and leaves those there that are beyond the tolerance.
  void follow(const std::vector<RayPart>& rays, double share, bool in_double,
              std::vector<std::size_t>& left, std::vector<RayResult>& results) const {
    std::vector<PellucidMeshRay> of_job;
    of_job.reserve(left.size());
    for (const std::size_t i : left) {
      const Vec3<double>&o = rays[i].ray.origin, &d = rays[i].ray.direction;
      const Interval<double>& range = rays[i].range;
      of_job.push_back({{o.x, o.y, o.z}, {d.x, d.y, d.z}, std::max(range.begin, 0.0), range.end});
    }
    std::vector<PellucidRayResult> found(left.size());
    PellucidMeshJob job = job_;
    job.in_double = in_double ? 1 : 0;
    job.tolerance *= share;
    job.rays = of_job.data();
    job.results = found.data();
    job.count = static_cast<std::int32_t>(left.size());
    kernel_(&job);
    std::vector<std::size_t> beyond;
    beyond.reserve(left.size());
    for (std::size_t n = 0; n < left.size(); ++n) {
      RayResult& result = results[left[n]];
      read_result(found[n], result);
      if (result.status == RayStatus::left || !(result.error <= share * wanted_.tolerance)) {
        beyond.push_back(left[n]);
      }
    }
    left = std::move(beyond);
  }

  const Tetrahedra mesh_;
  const MeshFieldStorage fields_;
  const RayTolerance wanted_;
  PellucidMeshJob job_{};
  Kernel kernel_ = nullptr;  ///< null: rays go one by one

 private:
  const bool depth_;
  std::vector<MeshPoint> points_;
};

class UnivariateMeshTracer : public MeshTracer {
 public:
  explicit UnivariateMeshTracer(const TracerTask& task)
      : MeshTracer(task), transfer_(*content_of(task).univariate()) {
    const TransferTables& tables = transfer_.tables();
    prepare(task, tables.largest_extinction, false);
    if (kernel_ == nullptr) return;
    binned_.emplace(tables.wide, largest_value(mesh_of(task).statistics(0)));
    job_.transfer = &binned_->view();
    job_.integrate_span = &UnivariateMeshTracer::integrate_span;
    context_ = {&tables, job_.largest_color};
    job_.context = &context_;
  }

 protected:
  void integrate(const std::vector<RayPart>& rays, const TraceOptions& options,
                 std::vector<RayResult>& results) const override {
    std::vector<std::size_t> left(rays.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    if (kernel_ != nullptr) {
      if (wanted_.tolerance >= min_tolerance_in_float) {
        follow(rays, options.share, false, left, results);
      }
      if (!left.empty()) follow(rays, options.share, true, left, results);
      // What is left has more hits than a lane has room for, or runs along faces, of which a ray by
      // itself knows more.
    }
    MeshHits hits;
    RayTolerance wanted = wanted_;
    wanted.tolerance *= options.share;
    for (const std::size_t i : left) {
      if (!is_whole(rays[i])) {
        results[i] = left_ray_result();
        continue;
      }
      results[i] = integrate_mesh_ray(mesh_, fields_.view(), transfer_.tables(),
                                      hits.find(mesh_, rays[i].ray), wanted);
    }
  }
  void find_half_opacity(const std::vector<RayPart>& rays,
                         std::vector<RayResult>& results) const override {
    MeshHits hits;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!is_whole(rays[i])) continue;
      RayResult& known = results[i];
      known.half_opacity_depth =
          find_mesh_half_opacity(mesh_, fields_.view(), transfer_.tables(),
                                 hits.find(mesh_, rays[i].ray), wanted_, known.opacity, known.half);
    }
  }

 private:
  /// Below it most rays would be followed twice.
  static constexpr double min_tolerance_in_float = 2e-4;

  static void integrate_span(const PellucidSpanContext* context, const PellucidLinearSpan* span,
                             PellucidCellResult* result) {
    CellSegment<double> found;
    integrate_linear_span(
        {span->front, span->back, span->error, span->length, span->position_error, span->end_error},
        *context->transfer, context->largest_color, true, [](double) noexcept { return 0.0; },
        found);
    const SegmentResult<double>& s = found.found.segment;
    *result = {s.optical_depth,
               s.opacity,
               s.transparency,
               {s.radiance.r, s.radiance.g, s.radiance.b},
               found.clear ? 0 : found.error(context->largest_color),
               found.opacity,
               1,
               0,
               pellucid_followed};
  }

  TransferTablesStorage transfer_;
  std::optional<BinnedTransferStorage> binned_;
  PellucidSpanContext context_{};
};

class MultivariateMeshTracer : public MeshTracer {
 public:
  explicit MultivariateMeshTracer(const TracerTask& task)
      : MeshTracer(task),
        transfer_function_(*content_of(task).multivariate()),
        transfer_(transfer_function_.view()) {
    prepare(task, transfer_function_.largest_extinction(), true);
    if (kernel_ == nullptr) return;
    // Half of what is left out is for Gaussians, half for what errors of the data change there.
    double largest[max_channels] = {};
    for (int c = 0; c < transfer_.channels; ++c) {
      largest[c] = largest_value(mesh_of(task).statistics(c));
    }
    mixture_ = NearMixtureStorage(largest, true, transfer_,
                                  0.5 * left_out_share * job_.tolerance / job_.largest_color,
                                  length(mesh_.upper - mesh_.lower));
    if (!mixture_.suits_packets()) {
      kernel_ = nullptr;
      return;
    }
    job_.tolerance *= 1 - left_out_share;
    job_.mixture = &mixture_.view();
    const std::size_t points = mesh_of(task).mesh().points().size();
    values_ = fields_.values_by_point(points);
    job_.values = values_.data();
    job_.value_points = static_cast<std::int32_t>(points);
  }

  bool goes_in_packets() const { return kernel_ != nullptr; }

 protected:
  void integrate(const std::vector<RayPart>& rays, const TraceOptions& options,
                 std::vector<RayResult>& results) const override {
    std::vector<std::size_t> left(rays.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    follow(rays, options.share, true, left, results);
    for (RayResult& result : results) std::swap(result.spans.closed, result.spans.lines);
    // What is left has more hits than a lane has room for, or is beyond what packets can do.
    for (const std::size_t i : left) results[i] = left_ray_result();
  }

 private:
  /// Fraction of the tolerance for primitives that are left out.
  static constexpr double left_out_share = 1.0 / 16;

  const MultivariateTransferFunction& transfer_function_;
  MultivariateTransfer<double> transfer_;
  NearMixtureStorage mixture_;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<const RayTracer> make_mesh_tracer(const TracerTask& task) {
  if (content_of(task).multivariate() == nullptr) {
    return std::make_unique<UnivariateMeshTracer>(task);
  }
  auto tracer = std::make_unique<MultivariateMeshTracer>(task);
  if (!tracer->goes_in_packets()) return nullptr;
  return tracer;
}

}  // namespace pellucid
