// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/field/tetrahedra.h"
#include "pellucid/render/camera.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/render/integrate_lit_ray.h"
#include "pellucid/render/pixel.h"
#include "pellucid/traverse/multivariate_blocks.h"

namespace pellucid {

/// Kind of data through which a device follows rays: one function of trace_pixel.h each.
enum class DeviceLook : std::uint8_t {
  grid,          ///< one variable on a grid
  lit_grid,      ///< the same in light, or with gradient opacity
  channels,      ///< several variables on a grid
  mesh,          ///< one variable on tetrahedra
  mesh_channels  ///< several variables on tetrahedra
};

/// A frame as a device holds it: numbers and pointers, into the memory of the host or of a card. A
/// view; owns nothing. for_each_array() names all that it points to.
struct DeviceScene {
  DeviceLook look = DeviceLook::grid;
  // Of the frame.
  CameraFrame<double> camera;
  int samples = 1;  ///< samples × samples rays a pixel
  RayTolerance wanted;
  PixelLimits limits;
  bool with_depth = false;
  bool single_first = false;  ///< cells in binary32; rays that need binary64 go to a queue
  double sampling_step = 0;   ///< world length, of the midpoint sampler; 0: exact
  /// Ends of the rays: the depth of each pixel, and the color behind it; null: nowhere.
  const float* backdrop_depth = nullptr;
  const float* backdrop_color = nullptr;  ///< four numbers a pixel
  // Of the layer.
  LitGrid lit;              ///< grid, blocks and place of a grid; light of a lit one
  TransferTables transfer;  ///< of one variable
  MultichannelGrid channels;
  MultivariateBlocks channel_blocks;
  Affine<double> grid_from_world;         ///< of the channels
  MultivariateTransfer<double> function;  ///< of several variables
  double largest_extinction = 0;          ///< of that
  Tetrahedra mesh;
  MeshFields fields;

  // The numbers of things that pointers do not tell.
  std::int64_t mesh_points = 0, mesh_nodes = 0, mesh_faces = 0;
};

/// Pixels of a frame: (column + i·stride, row + j·stride) for 0 <= i < columns, 0 <= j < rows.
struct PixelLattice {
  int column = 0, row = 0;
  int columns = 0, rows = 0;
  int stride = 1;

  PELLUCID_HD constexpr std::int64_t count() const noexcept { return std::int64_t{columns} * rows; }
};

/// The image of a frame in the memory of a device, row by row.
struct DeviceImage {
  float* color = nullptr;          ///< four numbers a pixel: premultiplied linear RGBA
  float* depth = nullptr;          ///< null: not asked for
  float* error = nullptr;          ///< null: not asked for
  std::uint8_t* proved = nullptr;  ///< of the presence of `error`
  int width = 0;
};

/// Pixels that wait for somebody: their numbers in the image, in no order.
struct PixelQueue {
  std::uint32_t* pixel = nullptr;  ///< room for the pixels of a lattice
};

/// Counts of a device. All are sums or maxima of what pixels have: their order does not matter.
struct DeviceCounts {
  std::uint64_t in_double = 0;      ///< length of the queue of pixels that need binary64
  std::uint64_t left = 0;           ///< length of the queue of pixels that the device cannot do
  std::uint64_t largest_error = 0;  ///< the bits of a double >= 0, which are ordered like it
  std::uint64_t proved = 0;         ///< pixels
  std::uint64_t over = 0;           ///< pixels with an error above the tolerance
  std::uint64_t cells = 0, evaluations = 0;
  std::uint64_t skipped = 0, constant = 0, strides = 0, lines = 0, closed = 0, panels = 0,
                cells_in_double = 0;
};

/// Task of a device, in its own memory.
struct DeviceTask {
  PixelLattice pixels;
  DeviceImage image;
  PixelQueue in_double, left;
  DeviceCounts* counts = nullptr;
};

/// Calls visit(pointer, count) for the arrays of a scene: `pointer` is a reference that may be set
/// to a copy, `count` its number of elements. Null pointers are left out. Tables of several
/// variables point to further arrays, and are not visited: see for_each_table_array().
template <class Visit>
void for_each_array(DeviceScene& scene, Visit&& visit) {
  const auto some = [&](auto& pointer, std::int64_t count) {
    if (pointer != nullptr && count > 0) visit(pointer, count);
  };
  const auto planes = [&](GridAxis<double>(&axis)[3]) {
    for (GridAxis<double>& one : axis) some(one.plane_position, one.cells() + 1);
  };
  const auto values = [&](const void*& data, ValueType type, const GridAxis<double>(&axis)[3]) {
    std::int64_t count = 1;
    for (const GridAxis<double>& one : axis) count *= one.values;
    const std::size_t size =
        visit_values(type, data, [](const auto* typed) noexcept { return sizeof(*typed); });
    auto bytes = static_cast<const unsigned char*>(data);
    some(bytes, count * static_cast<std::int64_t>(size));
    data = bytes;
  };
  const auto table = [&]<class T>(PiecewiseLinear<T>& one) {
    some(one.value, one.count);
    some(one.material, one.count);
  };
  const std::int64_t pixels = std::int64_t{scene.camera.width} * scene.camera.height;
  some(scene.backdrop_depth, pixels);
  some(scene.backdrop_color, 4 * pixels);

  AnyGrid& grid = scene.lit.grid;
  if (grid.data != nullptr) {
    values(grid.data, grid.type, grid.axis);
    planes(grid.axis);
  }
  BlockRecords& records = scene.lit.blocks.records;
  some(scene.lit.blocks.classes.block, records.record != nullptr ? records.count() : 0);
  some(records.record, records.record != nullptr ? records.count() : 0);
  planes(records.axis);
  some(scene.lit.light, scene.lit.lights);
  table(scene.lit.transfer);
  table(scene.lit.gradient_opacity);

  table(scene.transfer.single);
  table(scene.transfer.wide);
  some(scene.transfer.single_antiderivative.node, 2 * scene.transfer.single_antiderivative.leaves);
  some(scene.transfer.wide_antiderivative.node, 2 * scene.transfer.wide_antiderivative.leaves);
  some(scene.transfer.merged, scene.transfer.merged_count);

  for (int c = 0; c < scene.channels.channels; ++c) {
    values(scene.channels.data[c], scene.channels.type[c], scene.channels.axis);
  }
  planes(scene.channels.axis);
  BlockRecords& blocks = scene.channel_blocks.records;
  const std::int64_t count = blocks.record != nullptr ? blocks.count() : 0;
  some(scene.channel_blocks.classes.block, count);
  some(scene.channel_blocks.primitives, count);
  some(blocks.record, count);
  planes(blocks.axis);
  some(scene.function.gaussians.primitive, scene.function.gaussians.count);

  some(scene.mesh.point, scene.mesh_points);
  some(scene.mesh.tetrahedron, scene.mesh.count);
  some(scene.mesh.tree, scene.mesh_nodes);
  some(scene.mesh.boundary, scene.mesh_faces);
  for (int c = 0; c < scene.fields.channels; ++c) {
    MeshField& field = scene.fields.channel[c];
    some(field.value, field.per_cell ? scene.mesh.count : scene.mesh_points);
  }
}

/// Visits likewise the arrays of a table of several variables.
template <class Visit>
void for_each_table_array(ChannelTable<double>& table, Visit&& visit) {
  visit(table.table.value, std::int64_t{table.table.count});
  visit(table.table.material, std::int64_t{table.table.count});
}

}  // namespace pellucid
