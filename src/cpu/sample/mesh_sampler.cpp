// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "mesh/mesh_field_storage.h"
#include "mesh/mesh_hits.h"
#include "pellucid/render/sample_mesh_ray.h"
#include "pellucid/render/sample_ray.h"
#include "pellucid/scene/transfer_tables_storage.h"
#include "psi_table_storage.h"
#include "ray_tracer.h"

namespace pellucid {
namespace {

const MeshContent& content_of(const TracerTask& task) {
  return std::get<MeshContent>(task.layer.content);
}

const MeshChannels& mesh_of(const TracerTask& task) {
  return *content_of(task).mesh;
}

CellModel cell_model(Method method) noexcept {
  switch (method) {
    case Method::homogeneous:
      return CellModel::homogeneous;
    case Method::average:
      return CellModel::average;
    case Method::partial:
      return CellModel::partial;
    default:
      return CellModel::linear;
  }
}

PsiTable psi_table_for(CellModel model) {
  return model == CellModel::partial ? psi_table() : PsiTable{};
}

class MeshSampler : public RayTracer {
 public:
  explicit MeshSampler(const TracerTask& task)
      : mesh_(mesh_of(task).mesh().view()),
        fields_(mesh_of(task)),
        stop_(stop_tolerance<double>() / std::max(largest_color(task.layer), 1.0)),
        depth_(task.options.depth) {}

  std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                               const TraceOptions& options) const override {
    std::vector<RayResult> results;
    results.reserve(parts.size());
    MeshHits hits;
    for (const RayPart& part : parts) {
      if (options.stop.stop_requested()) break;
      const Ray<double>& ray = part.ray;
      RayResult result = sample(hits.find(mesh_, ray), std::numeric_limits<double>::infinity());
      if (depth_ && result.opacity > 0) {
        // There exp(-a) = 1 - opacity/2.
        const double half = -std::log1p(-0.5 * result.opacity);
        result.half_opacity_depth = sample(hits.find(mesh_, ray), half).half_opacity_depth;
      }
      results.push_back(result);
    }
    results.resize(parts.size());
    return results;
  }

 protected:
  /// What the ray gathers up to the optical depth.
  virtual RayResult sample(const MeshRay& ray, double depth) const = 0;

  const Tetrahedra mesh_;
  const MeshFieldStorage fields_;
  const double stop_;  ///< transparency

 private:
  const bool depth_;  ///< whether the depth of half opacity is asked for
};

class UnivariateMeshSampler : public MeshSampler {
 public:
  explicit UnivariateMeshSampler(const TracerTask& task)
      : MeshSampler(task),
        transfer_(*content_of(task).univariate()),
        model_(cell_model(task.integration.method)),
        psi_(psi_table_for(model_)) {}

 protected:
  RayResult sample(const MeshRay& ray, double depth) const override {
    return sample_mesh_ray(mesh_, fields_.view(), transfer_.tables().wide, model_, psi_, ray, stop_,
                           depth);
  }

 private:
  TransferTablesStorage transfer_;
  CellModel model_;
  PsiTable psi_;
};

class MultivariateMeshSampler : public MeshSampler {
 public:
  explicit MultivariateMeshSampler(const TracerTask& task)
      : MeshSampler(task),
        transfer_(content_of(task).multivariate()->view()),
        method_(task.integration.method),
        psi_(psi_table_for(cell_model(method_))) {}

 protected:
  RayResult sample(const MeshRay& ray, double depth) const override {
    if (method_ == Method::kniss || method_ == Method::gaussian) {
      const auto rule = method_ == Method::kniss ? GaussianRule::kniss : GaussianRule::closed_form;
      return sample_mesh_gaussians(mesh_, fields_.view(), transfer_, rule, ray, stop_, depth);
    }
    return sample_mesh_ray(mesh_, fields_.view(), transfer_, cell_model(method_), psi_, ray, stop_,
                           depth);
  }

 private:
  MultivariateTransfer<double> transfer_;
  Method method_;
  PsiTable psi_;
};

}  // namespace

std::unique_ptr<const RayTracer> make_mesh_sampler(const TracerTask& task) {
  if (content_of(task).multivariate() != nullptr)
    return std::make_unique<MultivariateMeshSampler>(task);
  return std::make_unique<UnivariateMeshSampler>(task);
}

}  // namespace pellucid
