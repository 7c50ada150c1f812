// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "pellucid/field/grid_gradient.h"
#include "pellucid/field/sample.h"
#include "pellucid/field/structured_grid.h"
#include "pellucid/field/trilinear.h"
#include "pellucid/geometry/affine.h"
#include "pellucid/geometry/box.h"
#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/build_block_records.h"
#include "pellucid/traverse/spans.h"
#include "pellucid/traverse/structured_walk.h"
#include "tests/device/kernel.h"

namespace pellucid {

template <class T>
PELLUCID_HD Ray<T> some_ray(const T* in) noexcept {
  return {{in[0], in[1], in[2]}, normalized(Vec3<T>{in[3], in[4], in[5]})};
}

template <class T>
PELLUCID_HD GridAxis<T> some_axis(const T* in, int values, int padding) noexcept {
  return {padding == 0 ? nullptr : in, values, padding};
}

template <class T>
PELLUCID_HD void geometry(const T* in, T* out) noexcept {
  const Ray<T> ray = some_ray(in);
  const Affine<T> map{{{ray.origin, ray.direction, cross(ray.origin, ray.direction)}}, ray.origin};
  const Vec3<T> p = inverse(map).point(map.vector(ray.at(in[6])));
  const Box<T> box{{in[0], in[1], in[2]}, {in[3], in[4], in[5]}};
  const Interval<T> t = intersect(box, ray);
  out[0] = dot(p, p) + length(p) + determinant(map.matrix);
  out[1] = t.empty() ? T(0) : t.end - t.begin;
}
PELLUCID_DEVICE_KERNEL(geometry)

template <class T>
PELLUCID_HD void walk(const T* in, T* out) noexcept {
  const GridAxis<T> axes[3] = {some_axis(in, 8, 0), some_axis(in, 8, 1), some_axis(in, 8, 0)};
  StructuredWalk<T> walk(axes, some_ray(in), {T(0), in[7]});
  out[0] = walk.hits() ? walk.remaining().end : grid_interval(axes, some_ray(in)).begin;
  typename StructuredWalk<T>::Step step;
  while (walk.next(step)) {
    out[1] += static_cast<T>(step.cell[0] + find_cell(axes[1], step.entry.y));
    out[2] += step.exit.x + step.t_end - step.t_begin;
  }
}
PELLUCID_DEVICE_KERNEL(walk)

template <class Value, class T>
PELLUCID_HD void trilinear_of(const T* in, T* out) noexcept {
  const double planes[3] = {0, 1, 2};
  const GridAxis<double> axis = some_axis(planes, 2, 0);
  const StructuredGrid<Value, double> grid{reinterpret_cast<const Value*>(in), {axis, axis, axis}};
  const CellCorners<T> corners = grid.template corners<T>(0, 0, 0);
  const Vec3<T> a{in[0], in[1], in[2]}, b{in[3], in[4], in[5]};
  out[0] = trilinear_value(corners, a) + dot(trilinear_gradient(corners, a), b);
  out[1] = trilinear_cubic(corners, a, b).mean();
  const Ray<double> ray{{0, 0, 0}, {1, static_cast<double>(in[0]), 0}};
  out[2] += static_cast<T>(for_each_span<T>(grid, ray, [&](const CubicSpan<T>& span) {
    out[3] += span.data.mean() * span.length();
    return out[3] < T(1);
  }));
}
template <class T>
PELLUCID_HD void trilinear(const T* in, T* out) noexcept {
  trilinear_of<std::uint8_t>(in, out);
  trilinear_of<std::int16_t>(in, out);
  trilinear_of<float>(in, out);
  trilinear_of<double>(in, out);
}
PELLUCID_DEVICE_KERNEL(trilinear)

template <class T>
PELLUCID_HD void blocks_of(const T* in, T* out) noexcept {
  const double planes[3] = {0, 1, 2};
  double block_planes[2];
  const GridAxis<double> axis = some_axis(planes, 2, 0);
  const StructuredGrid<T, double> grid{in, {axis, axis, axis}};
  find_block_planes(axis, block_planes);
  const GridAxis<double> blocks_axis{block_planes, block_count(axis) + 1, 0};
  BlockRecord record;
  BlockRecords blocks;
  blocks.record = &record;
  blocks.code = make_block_code(0, static_cast<double>(in[8]), false);
  for (GridAxis<double>& a : blocks.axis) a = blocks_axis;
  blocks.least_width.x = least_plane_distance(axis);
  build_block_records(grid, blocks.axis, blocks.code, 0, blocks.count(), &record);
  const BlockClass block_class{0, BlockKind::skip, 1};
  const Ray<double> ray{{0, 0, 0}, {1, static_cast<double>(in[0]), 0}};
  for_each_block(ClassifiedBlocks{blocks, {&block_class}}, ray, {0, 1}, [&](const BlockStep& step) {
    const BlockRange range = blocks.range(step.block);
    const double length = step.t_end - step.t_begin;
    out[0] += static_cast<T>(bend_deviation(derivative_oscillation(range, ray.direction), length));
    out[1] += static_cast<T>(derivative_variation(blocks.curvature(step.block), ray.direction,
                                                  blocks.least_width, length));
    return !range.constant;
  });
}
PELLUCID_DEVICE_KERNEL(blocks_of)

/// Gradients at a place in a cell.
template <class T>
PELLUCID_HD void gradients_at_places(const T* in, T* out) noexcept {
  double data[8];
  for (int i = 0; i < 8; ++i) data[i] = static_cast<double>(in[i]);
  const GridAxis<double> axis{nullptr, 2, 0};
  const StructuredGrid<double, double> grid{data, {axis, axis, axis}};
  const double x = static_cast<double>(in[8]);
  const GridPlace<double> place = place_in_grid<double>(grid.axis, {x, x, x});
  const CornerGradients corners = field_gradients(grid, place.cell);
  const Mat3<double> map{{{1, 0, 0}, {0, 1, x}, {0, 0, 1}}};
  const Vec3<double> g = gradient_at(corners, map, place.local);
  out[0] = static_cast<T>(g.x + g.y + g.z);
  out[1] = static_cast<T>(magnitude_at(corners, map, place.local) + sample_value(grid, place));
}
PELLUCID_DEVICE_KERNEL(gradients_at_places)

}  // namespace pellucid
