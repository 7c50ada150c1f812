// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "packet_setup.h"
#include "packet_tracer.h"
#include "pellucid/packet/mesh_interface.h"
#include "pellucid/render/integrate_mesh_ray.h"
#include "pellucid/scene/binned_transfer_storage.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/transfer_tables_storage.h"
#include "ray_tracer.h"

namespace pellucid {
namespace {

/// The channels' values in double, as rays see them.
class FieldStorage {
 public:
  explicit FieldStorage(const MeshChannels& channels)
      : values_(static_cast<std::size_t>(channels.count())) {
    fields_.channels = channels.count();
    for (int c = 0; c < channels.count(); ++c) {
      std::vector<double>& values = values_[static_cast<std::size_t>(c)];
      std::visit([&](const auto& own) { values.assign(own.begin(), own.end()); },
                 channels[c].values);
      fields_.channel[c] = {values.data(), channels[c].centering == Centering::cell};
    }
  }
  const MeshFields& view() const noexcept { return fields_; }

 private:
  std::vector<std::vector<double>> values_;
  MeshFields fields_;
};

/// Throws Error for a method that marches at a step.
void check_method(Method method) {
  if (method == Method::exact) return;
  throw Error("integration: the method " + std::string(method_name(method)) +
              " goes in steps through a grid, but the scene has a mesh; take the exact one");
}

using Kernel = void (*)(const PellucidMeshJob*);

/// Null: rays go one by one.
Kernel kernel_for([[maybe_unused]] InstructionSet set) {
#if PELLUCID_HAS_PACKETS
  return kernel_of(set, pellucid_integrate_mesh_sse4, pellucid_integrate_mesh_avx2,
                   pellucid_integrate_mesh_avx512);
#else
  return nullptr;
#endif
}

/// Rays and where they meet the boundary of the mesh, all of them one behind the other.
class MeshRays {
 public:
  MeshRays(const Tetrahedra& mesh, const std::vector<Ray<double>>& world) {
    const Vec3<double> middle = 0.5 * (mesh.lower + mesh.upper);
    rays_.reserve(world.size());
    for (const Ray<double>& ray : world) {
      MeshRay in_mesh;
      in_mesh.view = make_ray_view(ray, middle, mesh.reach);
      const std::size_t first = hits_.size();
      for_each_boundary_hit(mesh, ray, in_mesh.view,
                            [&](const MeshHit& hit) { hits_.push_back(hit); });
      std::sort(hits_.begin() + static_cast<std::ptrdiff_t>(first), hits_.end());
      in_mesh.count = static_cast<int>(hits_.size() - first);
      rays_.push_back(in_mesh);
    }
    MeshHit* hit = hits_.data();
    for (MeshRay& ray : rays_) {
      ray.hits = hit;
      hit += ray.count;
    }
  }
  MeshRays(const MeshRays&) = delete;
  MeshRays& operator=(const MeshRays&) = delete;

  std::size_t size() const noexcept { return rays_.size(); }
  /// Its hits are used up by whoever follows it.
  const MeshRay& operator[](std::size_t i) const noexcept { return rays_[i]; }

 private:
  std::vector<MeshHit> hits_;
  std::vector<MeshRay> rays_;
};

class MeshTracer : public RayTracer {
 public:
  explicit MeshTracer(const TracerTask& task)
      : mesh_(task.scene.mesh->mesh().view()),
        fields_(*task.scene.mesh),
        wanted_(task.wanted),
        depth_(task.options.depth) {
    check_method(task.scene.integration.method);
  }

  std::vector<RayResult> trace(const std::vector<Ray<double>>& world) const override {
    std::vector<RayResult> results;
    results.reserve(world.size());
    integrate(MeshRays(mesh_, world), results);
    if (!depth_) return results;
    const MeshRays again(mesh_, world);
    for (std::size_t i = 0; i < world.size(); ++i) {
      results[i].half_opacity_depth = find_half_opacity(again[i], results[i].opacity);
    }
    return results;
  }

 protected:
  virtual void integrate(const MeshRays& rays, std::vector<RayResult>& results) const = 0;
  virtual double find_half_opacity(const MeshRay& ray, double opacity) const = 0;

  const Tetrahedra mesh_;
  const FieldStorage fields_;
  const RayTolerance wanted_;

 private:
  const bool depth_;
};

class UnivariateMeshTracer : public MeshTracer {
 public:
  explicit UnivariateMeshTracer(const TracerTask& task)
      : MeshTracer(task), transfer_(*task.scene.transfer_function) {
    const VolumeStatistics& data = task.scene.mesh->statistics(0);
    const double largest = std::max(std::fabs(data.minimum), std::fabs(data.maximum));
    const TransferTables& tables = transfer_.tables();
    const InstructionSet set = packet_instruction_set(task.options.instruction_set);
    if (wanted_.precision != Precision::automatic || wanted_.tolerance < least_packet_tolerance ||
        !is_moderate(largest) || !is_moderate(task.scene.mesh->mesh().statistics().mean_edge) ||
        tables.largest_extinction > 1e12) {
      return;
    }
    kernel_ = kernel_for(set);
    binned_.emplace(tables.wide, tables.merged, tables.merged_count, largest);
    job_.mesh = &mesh_;
    job_.fields = &fields_.view();
    job_.transfer = &binned_->view();
    job_.tolerance = wanted_.tolerance;
    job_.largest_color = std::max(wanted_.largest_color, 1.0);
    job_.largest_extinction = tables.largest_extinction;
    job_.integrate_span = &UnivariateMeshTracer::integrate_span;
    job_.context = this;
  }

 protected:
  void integrate(const MeshRays& rays, std::vector<RayResult>& results) const override {
    if (kernel_ != nullptr) {
      integrate_in_packets(rays, results);
      return;
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      results.push_back(
          integrate_mesh_ray(mesh_, fields_.view(), transfer_.tables(), rays[i], wanted_));
    }
  }
  double find_half_opacity(const MeshRay& ray, double opacity) const override {
    return find_mesh_half_opacity(mesh_, fields_.view(), transfer_.tables(), ray, wanted_, opacity);
  }

 private:
  void integrate_in_packets(const MeshRays& rays, std::vector<RayResult>& results) const {
    RayResult clear;
    clear.error = 0;
    clear.proved = true;
    results.assign(rays.size(), clear);
    std::vector<PellucidMeshRay> meeting;
    std::vector<std::size_t> of;
    meeting.reserve(rays.size());
    of.reserve(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Interval<double> inside = rays[i].inside();
      if (inside.empty()) continue;
      meeting.push_back({&rays[i], inside.begin, inside.end});
      of.push_back(i);
    }
    std::vector<PellucidRayResult> found(meeting.size());
    PellucidMeshJob job = job_;
    job.rays = meeting.data();
    job.results = found.data();
    job.count = static_cast<std::int32_t>(meeting.size());
    kernel_(&job);
    for (std::size_t i = 0; i < found.size(); ++i) read_result(found[i], results[of[i]]);
  }

  static void integrate_span(const void* context, const PellucidLinearSpan* span,
                             PellucidCellResult* result) {
    const auto& tracer = *static_cast<const UnivariateMeshTracer*>(context);
    CellSegment<double> found;
    integrate_linear_span(
        {span->front, span->back, span->error, span->length, span->place_error},
        tracer.transfer_.tables(), tracer.job_.largest_color, true,
        [](double) noexcept { return 0.0; }, found);
    const SegmentResult<double>& s = found.found.segment;
    *result = {s.optical_depth,
               s.opacity,
               s.transparency,
               {s.radiance.r, s.radiance.g, s.radiance.b},
               found.clear ? 0 : found.error(tracer.job_.largest_color),
               found.opacity,
               1,
               0};
  }

  TransferTablesStorage transfer_;
  std::optional<BinnedTransferStorage> binned_;
  PellucidMeshJob job_{};
  Kernel kernel_ = nullptr;  ///< null: rays go one by one
};

class MultivariateMeshTracer : public MeshTracer {
 public:
  explicit MultivariateMeshTracer(const TracerTask& task)
      : MeshTracer(task),
        transfer_function_(*task.scene.multivariate),
        transfer_(transfer_function_.view()) {}

 protected:
  void integrate(const MeshRays& rays, std::vector<RayResult>& results) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      results.push_back(integrate_multivariate_mesh_ray(mesh_, fields_.view(), transfer_,
                                                        transfer_function_.largest_extinction(),
                                                        rays[i], wanted_));
    }
  }
  double find_half_opacity(const MeshRay& ray, double opacity) const override {
    if (!(opacity > 0)) return std::numeric_limits<double>::infinity();
    // There exp(-a) = 1 - opacity/2.
    return integrate_multivariate_mesh_ray(mesh_, fields_.view(), transfer_,
                                           transfer_function_.largest_extinction(), ray, wanted_,
                                           -std::log1p(-0.5 * opacity))
        .half_opacity_depth;
  }

 private:
  const MultivariateTransferFunction& transfer_function_;
  Multivariate<double> transfer_;
};

}  // namespace

std::unique_ptr<const RayTracer> make_mesh_tracer(const TracerTask& task) {
  if (task.scene.multivariate) return std::make_unique<MultivariateMeshTracer>(task);
  return std::make_unique<UnivariateMeshTracer>(task);
}

}  // namespace pellucid
