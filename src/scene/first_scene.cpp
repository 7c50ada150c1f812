// SPDX-License-Identifier: Apache-2.0
// What makes a layer of data and a function, and a scene of a layer.
#include <utility>

#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/look.h"
#include "pellucid/scene/scene.h"

namespace pellucid {
namespace {

/// Returns the pointer. Throws Error if it is null.
template <class Object>
std::shared_ptr<const Object> present(Shared<Object> shared, const char* what) {
  if (!shared.object) throw Error(std::string("layer: ") + what + " is null");
  return std::move(shared.object);
}

std::shared_ptr<const TransferFunction> function_of(const Look& look) {
  return std::make_shared<const TransferFunction>(look.transfer_function);
}

}  // namespace

void put_look(Look look, Layer& layer) {
  if (look.as_labels) {
    LabelContent content;
    content.labels =
        std::make_shared<const LabelVolume>(std::get<VolumeContent>(layer.content).volume);
    content.table = std::make_shared<const LabelTable>(default_label_table(*content.labels));
    layer.content = std::move(content);
    layer.shading.reset();
    return;
  }
  layer.shading = look.shading;
  layer.isosurfaces = std::move(look.isosurfaces);
}

Layer::Layer(Shared<Volume> volume) {
  const std::shared_ptr<const Volume> data = present(std::move(volume), "the volume");
  Look look = choose_look(*data);
  content = VolumeContent{data, function_of(look)};
  put_look(std::move(look), *this);
}

Layer::Layer(Shared<MeshChannels> mesh) {
  const std::shared_ptr<const MeshChannels> data = present(std::move(mesh), "the mesh");
  Look look = choose_look(*data);
  content = MeshContent{data, function_of(look)};
  put_look(std::move(look), *this);
}

Layer::Layer(Shared<Volume> volume, Shared<TransferFunction> function)
    : content(VolumeContent{std::move(volume.object), std::move(function.object)}) {}

Layer::Layer(Shared<Channels> channels, Shared<MultivariateTransferFunction> function)
    : content(ChannelsContent{std::move(channels.object), std::move(function.object)}) {}

Layer::Layer(Shared<MeshChannels> mesh, Shared<TransferFunction> function)
    : content(MeshContent{std::move(mesh.object), std::move(function.object)}) {}

Layer::Layer(Shared<MeshChannels> mesh, Shared<MultivariateTransferFunction> function)
    : content(MeshContent{std::move(mesh.object), std::move(function.object)}) {}

Layer::Layer(Shared<LabelVolume> labels, Shared<LabelTable> table)
    : content(LabelContent{std::move(labels.object), std::move(table.object)}) {}

Scene::Scene(Layer layer, ImageSize wanted) {
  size = wanted;
  check_layer(layer, "layer");
  layers.push_back(std::move(layer));
  camera = default_camera(visible_corners(*this), size);
  make_camera_frame(camera, size);
}

}  // namespace pellucid
