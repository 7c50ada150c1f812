// SPDX-License-Identifier: Apache-2.0
//
// Stands in for the sources of this folder in builds for a first picture and for WebAssembly.
#include "device_cache.h"
#include "device_frame.h"
#include "device_layer.h"
#include "pellucid/scene/internal/left_out.h"

namespace pellucid {

DeviceLayer::DeviceLayer(const Layer&, const LayerSetting&, const ParallelFor&) {
  throw left_out("what renders on devices");
}

std::string reason_for_cpu(const Frame&, const RenderOptions&) {
  return "";
}

void render_on_device(const Frame&, const RenderOptions&, CachedDevice&, const ImageView&,
                      RenderReport&) {
  throw left_out("what renders on devices");
}

std::shared_ptr<CachedDevice> DeviceCache::find(Device) {
  throw left_out("what renders on devices");
}

void DeviceCache::clear() {}

}  // namespace pellucid
