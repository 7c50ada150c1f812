// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "pellucid/render/camera.h"
#include "pellucid/render/integrate_ray.h"
#include "pellucid/render/sample_ray.h"

namespace pellucid {

/// One pixel per thread: the whole of the core, as a back end will call it.
template <class T, class Value>
__global__ void render_pixels(StructuredGrid<Value, double> grid, ClassifiedBlocks blocks,
                              TransferTables transfer, RayTolerance wanted,
                              CameraFrame<double> camera, bool exact, SegmentRule rule, double step,
                              RayResult* pixels) {
  const int column = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int row = static_cast<int>(blockIdx.y);
  if (column >= camera.width || row >= camera.height) return;
  const Ray<double> ray = camera.ray(column, row);
  pixels[row * camera.width + column] =
      exact ? integrate_ray(grid, &blocks, ray, transfer, wanted, true)
            : sample_ray<T>(grid, ray, transfer.table<T>(), rule, step, 1.0, stop_tolerance<T>(),
                            true);
}

#define PELLUCID_RENDER(T, Value)                                                    \
  template __global__ void render_pixels<T, Value>(                                  \
      StructuredGrid<Value, double>, ClassifiedBlocks, TransferTables, RayTolerance, \
      CameraFrame<double>, bool, SegmentRule, double, RayResult*);
PELLUCID_RENDER(float, std::int16_t)
PELLUCID_RENDER(double, std::int16_t)

}  // namespace pellucid
