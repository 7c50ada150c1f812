// SPDX-License-Identifier: Apache-2.0
//
// Stands in for the sources that builds for a first picture leave out (PELLUCID_FIRST_PICTURE).
// Light, surfaces and several variables take the general path, which is slower.
#include "pellucid/scene/internal/left_out.h"

#include "grid/grid_light.h"
#include "grid/packet_surfaces.h"
#include "layers/layer_stream.h"
#include "layers/layered_packets.h"
#include "projection/projected_tracer.h"
#include "ray_tracer.h"
#include "sample/sampled_path.h"

namespace pellucid {

std::unique_ptr<const RayTracer> make_surface_tracer(const TracerTask&) {
  return nullptr;
}

bool has_plain_isosurfaces(const Layer&) {
  return false;
}

std::optional<TransferFunction> with_points_at_isosurfaces(const Layer&) {
  return std::nullopt;
}

std::unique_ptr<const GridLight> GridLight::make(const Layer&, const std::vector<Light>&,
                                                 const RayTolerance&) {
  return nullptr;
}

void GridLight::integrate(const StructuredWalk<double>::Step&, const Ray<double>&,
                          const PellucidCell&, const TransferTables&, double,
                          PellucidCellResult&) const {
  throw left_out("what integrates lit cells");
}

bool LayeredPackets::suit(const LayerSetting&) {
  return false;
}

std::unique_ptr<const LayeredPackets> LayeredPackets::make(const std::vector<ClippedLayer>&,
                                                           const std::vector<LightSource<double>>&,
                                                           const RayTolerance&, bool) {
  return nullptr;
}

std::vector<RayResult> LayeredPackets::integrate(const std::vector<RayPart>&,
                                                 const std::vector<double>&,
                                                 const std::stop_token&) const {
  throw left_out("what follows several layers in packets");
}

std::unique_ptr<const RayTracer> make_multivariate_tracer(const TracerTask&) {
  return nullptr;
}

std::unique_ptr<const RayTracer> make_mesh_tracer(const TracerTask&) {
  throw left_out("what renders meshes");
}

std::unique_ptr<const LayerSource> make_mesh_source(const LayerTask&) {
  throw left_out("what renders meshes");
}

std::unique_ptr<const LayerSource> make_own_source(const LayerTask&) {
  throw left_out("what renders stretch sources");
}

std::unique_ptr<const LayerSource> make_label_source(const LayerTask&) {
  throw left_out("what renders labels");
}

std::unique_ptr<const RayTracer> make_packet_sampler(const TracerTask&) {
  throw left_out("what samples rays");
}

SamplingPlan::SamplingPlan(const std::vector<ClippedLayer>&, const Integration&, double, bool)
    : rule_(SegmentRule::midpoint), by_cells_(false), stop_(0), depth_(false) {
  throw left_out("what samples rays");
}

class SampledPath::LayerOnRay {};

SampledPath::SampledPath(const std::vector<ClippedLayer>& layers,
                         const std::vector<LightSource<double>>& lights, const SamplingPlan& plan,
                         double largest_color)
    : plan_(plan), lights_(lights), merge_(layers, lights, largest_color, false) {}

SampledPath::~SampledPath() = default;

RayResult SampledPath::sample(const RayPart&, const std::stop_token&) {
  throw left_out("what samples rays");
}

ProjectedTracer::ProjectedTracer(std::vector<Layer>, std::unique_ptr<const RayTracer>,
                                 const std::vector<Clip>&, double, const ParallelFor&)
    : largest_color_(0) {
  throw left_out("what projects layers");
}

std::vector<RayResult> ProjectedTracer::trace(const std::vector<RayPart>&, const TraceOptions&,
                                              std::vector<double>*) const {
  throw left_out("what projects layers");
}

}  // namespace pellucid
