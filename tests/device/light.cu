// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/bernstein_roots.h"
#include "pellucid/render/multivariate_integrator.h"
#include "pellucid/segment/lit_panel.h"
#include "pellucid/segment/surface.h"
#include "tests/device/kernel.h"

namespace pellucid {

/// A lit panel with a gradient opacity, and where a polynomial changes its sign.
template <class T>
PELLUCID_HD void light(const T* in, T* out) noexcept {
  const Material<T> materials[2] = {{in[0], {in[1], in[2], in[3]}}, {in[4], {in[1], in[3], in[2]}}};
  const ChannelTable<T> table{0, {in + 5, materials, 2}};
  MultivariateTransfer<T> transfer;
  transfer.table = &table;
  transfer.tables = 1;
  const Reflection<T> reflection{in[7], in[8], in[9], in[10], in[11]};
  LightSource<T> lights[2];
  lights[1].kind = LightSource<T>::Kind::point;
  lights[1].place = {in[12], in[13], in[14]};
  LitLayer<T> layer;
  layer.transfer = &transfer;
  layer.gradient_opacity = &table.table;
  layer.reflection = &reflection;
  layer.span.data[0] = layer.magnitude = layer.gradient[0] = {{in[15], in[16], in[17], in[18]}};
  layer.span.length = in[19];
  LitStretch<T> stretch;
  stretch.layer = &layer;
  stretch.layers = 1;
  stretch.light = lights;
  stretch.lights = 2;
  stretch.length = in[19];
  stretch.direction = {T(0), T(0), T(1)};
  stretch.gradient_error = gradient_rounding<T>;
  PanelDemand<T> demand;
  const LitLayer<T> part = layer.part(in[20], in[21]);
  const auto found = integrate_lit_panel(stretch, &part, in[20], in[21], demand,
                                         [&](T opacity) noexcept { return in[22] * opacity; });
  out[0] = found.found.segment.radiance.r + found.error(in[23]) + found.cut;
  const BernsteinPolynomial<T, 3> f{{in[15], in[16], in[17], in[18]}};
  T position[3];
  out[1] = T(sign_change_positions(f, position)) + position[0];
  out[2] = error_of_three_nodes(in[0], in[1]) + error_of_six_nodes(in[0], in[1]);
  const GradientStretch<T> along{
      {layer.gradient[0], layer.gradient[0], layer.gradient[0]}, stretch.begin, in[19], {}};
  out[3] = place_doubt(reflection, lights, 2, along, in[23], in[24]);
}
PELLUCID_DEVICE_KERNEL(light)

/// Surfaces along a ray.
template <class T>
PELLUCID_HD void surfaces(const T* in, T* out) noexcept {
  MultivariateTransfer<double> transfer;
  RayTolerance wanted;
  MultivariateRayIntegrator integrator(transfer, 1e300, wanted, static_cast<double>(in[0]));
  integrator.add_surface(static_cast<double>(in[1]), {1, 0, 0}, 0, static_cast<double>(in[2]));
  integrator.charge_opacity_behind(integrator.transparency(), static_cast<double>(in[3]));
  out[0] = static_cast<T>(integrator.result().error);
  const Reflection<T> reflection{in[4], in[5], in[6], in[7], in[8]};
  const LightSource<T> head;
  GradientStretch<T> along;
  along.component[0] = {{in[9], in[10], in[11], in[12]}};
  T error = in[13];
  const T off = crossing_error(along.component[0], in[14], error);
  out[1] = light_surface(reflection, &head, 1, along, in[14], off, in[15], {in[0], in[1], in[2]},
                         T(1), error)
               .r +
           error;
}
PELLUCID_DEVICE_KERNEL(surfaces)

}  // namespace pellucid
