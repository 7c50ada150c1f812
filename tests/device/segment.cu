// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/classical.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/segment/constant.h"
#include "pellucid/segment/cubic.h"
#include "pellucid/segment/gauss_panel.h"
#include "pellucid/segment/gaussian_kniss.h"
#include "pellucid/segment/gaussian_panels.h"
#include "pellucid/segment/line_rule.h"
#include "pellucid/segment/linear.h"
#include "pellucid/segment/piecewise_linear.h"
#include "pellucid/transfer/piecewise_linear.h"
#include "tests/device/kernel.h"

namespace pellucid {

template <class T>
PELLUCID_HD void put(const SegmentResult<T>& s, T* out) noexcept {
  out[0] += s.radiance.r + s.radiance.g + s.radiance.b;
  out[1] += s.optical_depth + s.opacity + s.transparency;
}

template <class T>
PELLUCID_HD Material<T> some_material(const T* in) noexcept {
  return {in[0], Rgb<T>{in[1], in[2], in[3]}};
}

template <class T>
PELLUCID_HD void classical(const T* in, T* out) noexcept {
  const Material<T> f = some_material(in), m = some_material(in + 4), b = some_material(in + 8);
  const T length = in[12];
  put(rectangle_segment(f, length), out);
  put(taylor_segment(f, length), out);
  put(midpoint_segment(m, length), out);
  put(average_segment(f, b, length), out);
  put(trapezoid_segment(f, b, length), out);
  put(simpson_segment(f, m, b, length), out);
  put(constant_segment(f.extinction, f.color, length), out);
  put(segment_of_depth(length, f.color), out);
  out[2] = attenuation(length).opacity;
}
PELLUCID_DEVICE_KERNEL(classical)

template <class T>
PELLUCID_HD void linear(const T* in, T* out) noexcept {
  const Material<T> f = some_material(in), b = some_material(in + 4);
  const T length = in[8];
  const auto one = linear_segment(f.extinction, b.extinction, f.color, b.color, length);
  const auto two = linear_segment(f.extinction, b.extinction, f.color, length);
  const auto three =
      linear_segment_independent(f.extinction, b.extinction, f.color, b.color, length);
  put(compose(one, two), out);
  FrontToBackCompositor<double> fold(static_cast<double>(in[9]));
  fold.add(one);
  if (!fold.done()) fold.add(three);
  out[2] = static_cast<T>(fold.radiance().r + fold.opacity() + fold.optical_depth() +
                          fold.transparency() + fold.result().opacity);
  out[3] = linear_weights(f.extinction, b.extinction, length).psi +
           emission_weights(f.extinction, b.extinction, length).weight_f;
}
PELLUCID_DEVICE_KERNEL(linear)

template <class T>
PELLUCID_HD void panels(const T* in, T* out) noexcept {
  const auto material_at = [&](T u) {
    return Material<T>{in[0] + u * in[1], Rgb<T>{in[2], in[3], u}};
  };
  put(gauss_panel<2>(in[4], material_at), out);
  put(gauss_panel<5>(in[4], in[5], material_at), out);
  put(gauss_panel_independent<4>(in[4], material_at), out);
}
PELLUCID_DEVICE_KERNEL(panels)

template <class T>
PELLUCID_HD void cubic(const T* in, T* out) noexcept {
  const CubicBernstein<T> data{{in[0], in[1], in[2], in[3]}};
  const Material<T> materials[2] = {some_material(in), some_material(in + 4)};
  const PiecewiseLinear<T> table{in, materials, 2};
  put(piecewise_linear_segment(table, in[0], in[3], in[4]), out);
  put(integrate_cubic(data, in[4], table, in[5]), out);
  out[2] = optical_depth_cubic(data, in[4], table);
  out[3] = table.evaluate(in[6]).extinction + table.evaluate_in(1, in[6]).extinction;
}
PELLUCID_DEVICE_KERNEL(cubic)

template <class T>
PELLUCID_HD void lines(const T* in, T* out) noexcept {
  const Material<T> material[2] = {some_material(in), some_material(in + 4)};
  const PiecewiseLinear<T> table{in + 8, material, 2};
  const RangeSummary<T> node[2]{};
  const PiecewiseLinearAntiderivative<T> antiderivative{node, 1, T(0)};
  const CubicBernstein<T> data{{in[10], in[11], in[12], in[13]}};
  put(line_rule(data, in[14], table, antiderivative).segment, out);
  put(line_emission_rule(data, in[14], table, antiderivative).segment, out);
}
PELLUCID_DEVICE_KERNEL(lines)

template <class T>
PELLUCID_HD void gaussians(const T* in, T* out) noexcept {
  Gaussian<T> two[2]{};
  for (int i = 0; i < 2; ++i) {
    two[i].channels = two[i].rows = 2;
    two[i].matrix[0][0] = two[i].matrix[1][1] = in[i];
    two[i].peak = in[2];
    two[i].color = {in[3], in[4], T(i)};
  }
  const GaussianMixture<T> mixture{two, 2};
  const T *v1 = in + 5, *v2 = in + 7;
  const T length = in[9], tolerance = in[10];
  put(gaussian_segment(two[0], v1, v2, length), out);
  put(gaussian_mixture_mean(mixture, v1, v2, length).segment, out);
  put(integrate_gaussians(mixture, v1, v2, length, tolerance, Grade::proved).segment, out);
  put(integrate_gaussians(mixture, v1, v2, length, tolerance, Grade::estimated).segment, out);
  out[2] = kniss_mean_density(two[1], v1, v2) + gaussian_mixture_depth(mixture, v1, v2, length);
  out[3] = gaussian_rounding(two[0], v1, v2, in[11]) + mixture.evaluate(v1).extinction;
}
PELLUCID_DEVICE_KERNEL(gaussians)

}  // namespace pellucid
