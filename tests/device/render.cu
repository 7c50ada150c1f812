// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "pellucid/render/camera.h"
#include "pellucid/render/integrate_ray.h"
#include "pellucid/render/sample_preintegrated.h"
#include "pellucid/render/sample_ray.h"

namespace pellucid {

/// One pixel per thread: the whole of the core, as a back end will call it.
template <class T, class Value>
__global__ void render_pixels(StructuredGrid<Value, double> grid, ClassifiedBlocks blocks,
                              TransferTables transfer, RayTolerance wanted,
                              CameraFrame<double> camera, bool exact, SamplingRule rule,
                              double step, RayResult* pixels) {
  const int column = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int row = static_cast<int>(blockIdx.y);
  if (column >= camera.width || row >= camera.height) return;
  const Ray<double> ray = camera.ray(column, row);
  pixels[row * camera.width + column] =
      exact ? integrate_ray(grid, &blocks, ray, transfer, wanted, true)
            : sample_ray<T>(grid, ray, transfer.table<T>(), rule, step, 1.0, stop_tolerance<T>(),
                            true);
}

template <class T, class Value>
__global__ void render_preintegrated(StructuredGrid<Value, double> grid, PreintegratedTable table,
                                     CameraFrame<double> camera, double step, RayResult* pixels) {
  const int pixel = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (pixel >= camera.width * camera.height) return;
  pixels[pixel] =
      sample_preintegrated<T>(grid, camera.ray(pixel % camera.width, pixel / camera.width), table,
                              step, 1.0, stop_tolerance<T>(), true);
}
template __global__ void render_preintegrated<float, std::int16_t>(
    StructuredGrid<std::int16_t, double>, PreintegratedTable, CameraFrame<double>, double,
    RayResult*);

#define PELLUCID_RENDER(T, Value)                                                    \
  template __global__ void render_pixels<T, Value>(                                  \
      StructuredGrid<Value, double>, ClassifiedBlocks, TransferTables, RayTolerance, \
      CameraFrame<double>, bool, SamplingRule, double, RayResult*);
PELLUCID_RENDER(float, std::int16_t)
PELLUCID_RENDER(double, std::int16_t)

}  // namespace pellucid
