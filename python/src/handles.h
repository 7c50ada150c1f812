// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common.h"
#include "pellucid/io/channel_source.h"
#include "pellucid/io/field_source.h"
#include "pellucid/io/mesh_source.h"
#include "pellucid/io/transfer_function_description.h"
#include "pellucid/scene/channels.h"
#include "pellucid/scene/label_volume.h"
#include "pellucid/scene/mesh_channels.h"

/// Contents of the Python classes of data and functions: the library's shared objects, and what a
/// saved scene says about them.
namespace pellucid::python {

/// Python's Volume.
struct VolumeHandle {
  std::shared_ptr<const Volume> volume;
  /// The axes of the array that are the volume's x, y and z (GridValues::axes).
  std::array<std::size_t, 3> axes{2, 1, 0};
  std::optional<FieldSource> source{};  ///< none: an array
};

/// Returns the volume with the memory order of another one: itself, or a copy whose x, y and z are
/// the same axes of its array. Volumes of several memory orders have one grid then.
VolumeHandle in_order_of(const VolumeHandle& like, const VolumeHandle& volume);

/// Python's Channels.
struct ChannelsHandle {
  std::shared_ptr<const Channels> channels;
  std::vector<std::array<std::size_t, 3>> axes;  ///< of each channel (VolumeHandle::axes)
  std::vector<ChannelSource> sources{};          ///< empty: arrays
};

/// Python's Mesh.
struct MeshHandle {
  std::shared_ptr<const MeshChannels> mesh;
  std::optional<MeshSource> source{};  ///< none: arrays
};

/// Python's LabelVolume.
struct LabelHandle {
  std::shared_ptr<const LabelVolume> labels;
  std::array<std::size_t, 3> axes{2, 1, 0};  ///< VolumeHandle::axes
  std::optional<FieldSource> source{};       ///< none: an array
};

/// Python's LabelMask. The functions of the choices are those of the mask.
struct MaskHandle {
  std::shared_ptr<const LabelMask> mask;
  std::array<std::size_t, 3> axes{2, 1, 0};  ///< VolumeHandle::axes
  std::optional<FieldSource> source{};
  /// In the order of the last volume whose order was another one.
  mutable std::shared_ptr<const LabelMask> reordered{};
  mutable std::array<std::size_t, 3> reordered_axes{};
};

/// Python's Gaussians: a function of several variables as written and as made.
struct GaussiansHandle {
  std::shared_ptr<const MultivariateTransferFunction> function;
  MultivariateDescription description;
  std::vector<std::string> channels;
};

/// Python's OpacityTable. It becomes points when the tolerance of a scene is known; `fitted` keeps
/// the last ones, so that frames with the same points share them.
struct OpacityTableHandle {
  OpacityTable table;
  mutable std::shared_ptr<const TransferFunction> fitted{};
};

/// Calls body(data) with the volume or the mesh of an object. Throws Error, which begins with
/// `expected`, for others.
template <class Body>
auto with_data(const py::object& data, Body&& body,
               const std::string& expected = "data: expected a Volume or a Mesh") {
  if (py::isinstance<VolumeHandle>(data)) return body(*py::cast<const VolumeHandle&>(data).volume);
  if (py::isinstance<MeshHandle>(data)) return body(*py::cast<const MeshHandle&>(data).mesh);
  throw Error(expected + ", got " + short_repr(data));
}

}  // namespace pellucid::python
