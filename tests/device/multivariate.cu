// SPDX-License-Identifier: Apache-2.0
#include "pellucid/render/camera.h"
#include "pellucid/render/integrate_multivariate_ray.h"
#include "pellucid/segment/gaussian_nodes.h"
#include "pellucid/transfer/gaussian_bound.h"
#include "tests/device/kernel.h"

namespace pellucid {

/// A panel of two primitives and a table, and what it is made of.
template <class T>
PELLUCID_HD void panel(const T* in, T* out) noexcept {
  Gaussian<T> two[2]{};
  for (int i = 0; i < 2; ++i) {
    two[i].matrix[0][0] = in[i];
    two[i].peak = in[2];
    two[i].color = {in[3], in[4], T(i)};
  }
  const Material<T> materials[2] = {{in[5], {in[6], in[7], in[8]}}, {in[9], {in[6], in[8], in[7]}}};
  const ChannelTable<T> table{0, {in + 10, materials, 2}};
  MultivariateTransfer<T> transfer;
  transfer.gaussians = {two, 2};
  transfer.table = &table;
  transfer.tables = 1;
  MultivariateSpan<T> span;
  span.data[0] = {{in[12], in[13], in[14], in[15]}};
  span.length = in[16];
  PanelDemand<T> demand;
  demand.last_resort = in[17] > T(0);
  const auto found =
      integrate_multivariate_panel(transfer, span.part(1, in[18], in[19]), demand,
                                   [&](T opacity) noexcept { return in[20] * opacity + in[21]; });
  out[0] = found.found.segment.radiance.r + found.error(in[22]) + found.cut;
  out[1] = table_mass(span.data[0], table.table, span.length).depth;
  out[2] = least_exponent(two[0], in, in + 1, in[23]) + transfer.evaluate(in).extinction;
  LinearSpan<T> straight;
  straight.data[0] = {{in[12], in[13]}};
  straight.length = in[16];
  out[3] = integrate_multivariate_panel(transfer, straight.part(1, in[18], in[19]), demand,
                                        [&](T) noexcept { return in[21]; })
               .opacity +
           (GaussianLinear<T>(two[0], straight.data).comes_within(in[23]) ? T(1) : T(0));
}
PELLUCID_DEVICE_KERNEL(panel)

/// A panel by Gauss nodes.
template <class T>
PELLUCID_HD void nodes(const T* in, T* out) noexcept {
  Gaussian<T> g;
  g.rows = 1 + static_cast<int>(in[0]);
  g.peak = in[1];
  g.color = {in[2], in[3], in[4]};
  NodeWorkspace<T> room;
  GaussianNodes<T> panel(in[5], room);
  const T steps[3][2] = {{in[6], in[7]}, {in[8], in[9]}, {in[10], in[11]}};
  panel.add(g, in + 12, steps, in[14], in[15] > T(0));
  const auto found = panel.integrate(in[16]);
  out[0] = found.segment.radiance.r + found.error + found.clear + found.cut;
  out[1] = panel.depth_bound() + panel.least_error() + (panel.is_short() ? T(1) : T(0));
}
PELLUCID_DEVICE_KERNEL(nodes)

/// One pixel per thread.
__global__ void render_multivariate(MultichannelGrid grid, MultivariateBlocks blocks,
                                    MultivariateTransfer<double> transfer, RayTolerance wanted,
                                    CameraFrame<double> camera, RayResult* pixels) {
  const int pixel = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (pixel >= camera.width * camera.height) return;
  const Ray<double> ray = camera.ray(pixel % camera.width, pixel / camera.width);
  pixels[pixel] = integrate_multivariate_ray(grid, &blocks, ray, transfer, 1.0, wanted, true);
}

/// A ray whose function changes on its way, as where layers begin.
__global__ void change_function(MultivariateTransfer<double> first,
                                MultivariateTransfer<double> second, MultivariateSpan<double> span,
                                RayTolerance wanted, RayResult* result) {
  MultivariateRayIntegrator integrator(first, 1.0, wanted, 2 * span.length);
  integrator.add_stretch(span, {0, span.length}, PrimitiveSet{}, 0, 0);
  integrator.set_transfer(second);
  integrator.add_stretch(span, {span.length, 2 * span.length}, PrimitiveSet{}, 0, 0);
  *result = integrator.result();
}

}  // namespace pellucid
