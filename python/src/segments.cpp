// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <utility>

#include "arrays.h"
#include "handles.h"
#include "pellucid/reference/render.h"
#include "pellucid/segment/gaussian.h"
#include "pellucid/segment/linear.h"
#include "pellucid/segment/piecewise_linear.h"
#include "scenes.h"

namespace pellucid::python {

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Results of n segments, as arrays: optical depth, opacity, transparency (n) and radiance (n, 3).
class Results {
 public:
  explicit Results(py::ssize_t n)
      : optical_depth_(n), opacity_(n), transparency_(n), radiance_({n, py::ssize_t{3}}) {
    numbers_ = {optical_depth_.mutable_data(), opacity_.mutable_data(),
                transparency_.mutable_data(), radiance_.mutable_data()};
  }
  /// Needs no lock of the interpreter.
  void set(py::ssize_t i, const SegmentResult<double>& s) {
    numbers_[0][i] = s.optical_depth;
    numbers_[1][i] = s.opacity;
    numbers_[2][i] = s.transparency;
    numbers_[3][3 * i] = s.radiance.r;
    numbers_[3][3 * i + 1] = s.radiance.g;
    numbers_[3][3 * i + 2] = s.radiance.b;
  }
  py::tuple tuple() const {
    return py::make_tuple(optical_depth_, opacity_, transparency_, radiance_);
  }

 private:
  py::array_t<double> optical_depth_, opacity_, transparency_, radiance_;
  std::array<double*, 4> numbers_{};
};

Rgb<double> color_at(const double* colors, py::ssize_t i) {
  return {colors[3 * i], colors[3 * i + 1], colors[3 * i + 2]};
}

py::tuple linear(const Numbers& extinction_f, const Numbers& extinction_b, const Numbers& color_f,
                 const Numbers& color_b, const Numbers& length, bool independent) {
  const py::ssize_t n = length.size();
  Results results(n);
  const double *tau_f = extinction_f.data(), *tau_b = extinction_b.data(), *c_f = color_f.data(),
               *c_b = color_b.data(), *lengths = length.data();
  {
    const ReleasedLock released;
    for (py::ssize_t i = 0; i < n; ++i) {
      const Rgb<double> f = color_at(c_f, i), b = color_at(c_b, i);
      results.set(i, independent ? linear_segment_independent(tau_f[i], tau_b[i], f, b, lengths[i])
                                 : linear_segment(tau_f[i], tau_b[i], f, b, lengths[i]));
    }
  }
  return results.tuple();
}

py::tuple piecewise_linear(const std::shared_ptr<TransferFunction>& function,
                           const Numbers& value_f, const Numbers& value_b, const Numbers& length) {
  if (!function) throw Error("piecewise_linear_segment: expected a TransferFunction, got None");
  const py::ssize_t n = length.size();
  Results results(n);
  const double *v_f = value_f.data(), *v_b = value_b.data(), *lengths = length.data();
  {
    const ReleasedLock released;
    const PiecewiseLinear<double> table = function->view<double>();
    for (py::ssize_t i = 0; i < n; ++i) {
      results.set(i, piecewise_linear_segment(table, v_f[i], v_b[i], lengths[i]));
    }
  }
  return results.tuple();
}

py::tuple gaussian(const GaussiansHandle& handle, const Numbers& values_f, const Numbers& values_b,
                   const Numbers& length) {
  const MultivariateTransfer<double> transfer = handle.function->view();
  if (transfer.gaussians.count != 1 || transfer.tables != 0 ||
      handle.function->factor() != nullptr) {
    throw Error("gaussian_segment: expected Gaussians of a single primitive");
  }
  const py::ssize_t n = length.size(), channels = handle.function->channels();
  Results results(n);
  const double *v_f = values_f.data(), *v_b = values_b.data(), *lengths = length.data();
  {
    const ReleasedLock released;
    const Gaussian<double>& primitive = transfer.gaussians.primitive[0];
    for (py::ssize_t i = 0; i < n; ++i) {
      results.set(i, gaussian_segment(primitive, v_f + i * channels + primitive.first,
                                      v_b + i * channels + primitive.first, lengths[i]));
    }
  }
  return results.tuple();
}

/// Returns optical depth, opacity, radiance and depth of rays, by the reference.
py::tuple integrate(const py::object& scene, const Numbers& origins, const Numbers& directions) {
  Scene made = complete_scene(scene);
  const py::ssize_t n = origins.shape(0);
  py::array_t<double> optical_depth(n), opacity(n), radiance({n, py::ssize_t{3}}), depth(n);
  double *const depths = optical_depth.mutable_data(), *const opacities = opacity.mutable_data(),
                *const colors = radiance.mutable_data(), *const halves = depth.mutable_data();
  const double *const from = origins.data(), *const along = directions.data();
  {
    const ReleasedLock released;
    const ReferenceRays rays(made);
    all_cores()(static_cast<int>(n), [&](int first, int last) {
      for (int i = first; i < last; ++i) {
        const Rgb<double> o = color_at(from, i), d = color_at(along, i);
        const ReferencePixel pixel = rays({o.r, o.g, o.b}, {d.r, d.g, d.b});
        depths[i] = pixel.optical_depth;
        opacities[i] = pixel.opacity;
        halves[i] = pixel.half_opacity_depth;
        colors[3 * i] = pixel.radiance.r;
        colors[3 * i + 1] = pixel.radiance.g;
        colors[3 * i + 2] = pixel.radiance.b;
      }
    });
  }
  return py::make_tuple(optical_depth, opacity, radiance, depth);
}

}  // namespace

// pellucid/segments.py broadcasts the arguments, checks them and has the documentation.
void bind_segments(py::module_& module) {
  module.def("linear_segments", &linear);
  module.def("piecewise_linear_segments", &piecewise_linear);
  module.def("gaussian_segments", &gaussian);
  module.def("integrate_rays", &integrate);
}

}  // namespace pellucid::python
