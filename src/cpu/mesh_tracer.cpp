// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pellucid/render/integrate_mesh_ray.h"
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
    std::vector<MeshHit> hits, kept;
    for (const Ray<double>& ray : world) {
      MeshRay in_mesh = find_hits(ray, hits);
      if (depth_) kept = hits;
      results.push_back(integrate(in_mesh));
      if (!depth_) continue;
      in_mesh.hits = kept.data();
      results.back().half_opacity_depth = find_half_opacity(in_mesh, results.back().opacity);
    }
    return results;
  }

 protected:
  virtual RayResult integrate(const MeshRay& ray) const = 0;
  virtual double find_half_opacity(const MeshRay& ray, double opacity) const = 0;

  const Tetrahedra mesh_;
  const FieldStorage fields_;
  const RayTolerance wanted_;

 private:
  MeshRay find_hits(const Ray<double>& ray, std::vector<MeshHit>& hits) const {
    MeshRay result;
    result.view = make_ray_view(ray, 0.5 * (mesh_.lower + mesh_.upper), mesh_.reach);
    hits.clear();
    for_each_boundary_hit(mesh_, ray, result.view,
                          [&](const MeshHit& hit) { hits.push_back(hit); });
    std::sort(hits.begin(), hits.end());
    result.hits = hits.data();
    result.count = static_cast<int>(hits.size());
    return result;
  }

  const bool depth_;
};

class UnivariateMeshTracer : public MeshTracer {
 public:
  explicit UnivariateMeshTracer(const TracerTask& task)
      : MeshTracer(task), transfer_(*task.scene.transfer_function) {}

 protected:
  RayResult integrate(const MeshRay& ray) const override {
    return integrate_mesh_ray(mesh_, fields_.view(), transfer_.tables(), ray, wanted_);
  }
  double find_half_opacity(const MeshRay& ray, double opacity) const override {
    return find_mesh_half_opacity(mesh_, fields_.view(), transfer_.tables(), ray, wanted_, opacity);
  }

 private:
  TransferTablesStorage transfer_;
};

class MultivariateMeshTracer : public MeshTracer {
 public:
  explicit MultivariateMeshTracer(const TracerTask& task)
      : MeshTracer(task),
        transfer_function_(*task.scene.multivariate),
        transfer_(transfer_function_.view()) {}

 protected:
  RayResult integrate(const MeshRay& ray) const override {
    return integrate_multivariate_mesh_ray(mesh_, fields_.view(), transfer_,
                                           transfer_function_.largest_extinction(), ray, wanted_);
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
