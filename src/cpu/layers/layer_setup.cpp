// SPDX-License-Identifier: Apache-2.0
#include "layer_setup.h"

#include "device/device_layer.h"
#include "layered_packets.h"
#include "packet_setup.h"
#include "threads.h"

namespace pellucid {
namespace {

/// Null where the layer takes the general path.
std::unique_ptr<const RayTracer> make_fast_tracer(const TracerTask& task,
                                                  const LayerSetting& setting) {
  const LayerContent& content = task.layer.content;
  if (setting.integration.method != Method::exact) return make_packet_sampler(task);
  if (auto surfaces = make_surface_tracer(task)) return surfaces;
  if (is_lit(task.layer) && !std::holds_alternative<VolumeContent>(content)) return nullptr;
  if (extinction_factor_of(task.layer) != nullptr) return nullptr;
  if (const auto* volume = std::get_if<VolumeContent>(&content)) {
    if (volume->mask) return nullptr;
    // Packets of single layers know uniform grids alone.
    if (!is_uniform(*volume->volume) && LayeredPackets::suit(setting)) return nullptr;
    return make_univariate_tracer(task);
  }
  if (std::holds_alternative<MeshContent>(content)) return make_mesh_tracer(task);
  if (std::holds_alternative<ChannelsContent>(content)) return make_multivariate_tracer(task);
  return nullptr;
}

}  // namespace

LayerSetting::LayerSetting(const Integration& of_scene, const RayTolerance& of_rays,
                           double negligible, const std::vector<Light>& of_lights,
                           const RenderOptions& options)
    : integration(of_scene),
      lights(of_lights),
      wanted(of_rays),
      negligible_extinction(negligible),
      depth(options.outputs.depth),
      instruction_set(options.machine.instruction_set),
      gaussian_march(options.machine.gaussian_march) {}

LayerSetup::LayerSetup(const Layer& layer, const LayerSetting& setting, int threads)
    : content_(layer.content),
      transform_(layer.transform),
      setting_(setting),
      layer_(moved_into_place(layer)),
      largest_extinction_(pellucid::largest_extinction(layer_)) {
  RenderOptions options;
  options.outputs.depth = setting_.depth;
  options.machine.instruction_set = setting_.instruction_set;
  options.machine.gaussian_march = setting_.gaussian_march;
  fast_ = make_fast_tracer(
      {layer_, setting_.integration, options, setting_.lights, setting_.wanted, threads}, setting_);
  if (!fast_) make_source(parallel_for(threads));
}

LayerSetup::~LayerSetup() = default;

bool LayerSetup::shows(const Layer& layer) const {
  return layer.content == content_ && layer.transform == transform_ &&
         layer.shading == layer_.shading && layer.gradient_opacity == layer_.gradient_opacity &&
         layer.isosurfaces == layer_.isosurfaces && layer.slices == layer_.slices;
}

const LayerSource& LayerSetup::source() const {
  // By the thread that asks alone: others may wait for it, and must not be needed by it.
  make_source({});
  return *source_;
}

const DeviceLayer& LayerSetup::device(const ParallelFor& parallel) const {
  std::call_once(device_made_, [&] {
    device_ = std::make_unique<const DeviceLayer>(layer_, setting_, parallel);
  });
  return *device_;
}

void LayerSetup::make_source(const ParallelFor& parallel) const {
  std::call_once(source_made_, [&] {
    source_ =
        make_layer_source({layer_, setting_.wanted, setting_.negligible_extinction, parallel});
  });
}

}  // namespace pellucid
