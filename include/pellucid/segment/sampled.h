// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/constant.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// A stretch of a ray in four steps of one length, and how far it is from the same in two.
template <class T>
struct SampledSegment {
  SegmentResult<T> segment;
  T difference;  ///< the largest of opacity and the channels of radiance
};

namespace detail {

/// The trapezoidal rule: a mean of the ends' extinctions, and of their colors weighted by these.
template <class T>
SegmentResult<T> trapezoid(const Material<T>& front, const Material<T>& back, T length) noexcept {
  const T mass = front.extinction + back.extinction;
  const Attenuation<T> a = attenuation(T(0.5) * length * mass);
  const T share = select(mass > T(0), a.opacity / mass, T(0));
  return {T(0.5) * length * mass, a.opacity, a.transparency,
          (share * front.extinction) * front.color + (share * back.extinction) * back.color};
}

/// Two steps: by Richardson from these two and from both as one, which takes off what the
/// trapezoidal rule errs in h².
template <class T>
SegmentResult<T> two_steps(const Material<T>& front, const Material<T>& middle,
                           const Material<T>& back, T length) noexcept {
  const SegmentResult<T> p = trapezoid(front, middle, length), q = trapezoid(middle, back, length),
                         whole = trapezoid(front, back, T(2) * length);
  const auto improved = [](T fine, T coarse) noexcept {
    return max(fine + T(scalar_t<T>(1.0 / 3)) * (fine - coarse), T(0));
  };
  SegmentResult<T> r;
  r.optical_depth = improved(p.optical_depth + q.optical_depth, whole.optical_depth);
  r.opacity = min(improved(p.opacity + p.transparency * q.opacity, whole.opacity), T(1));
  r.transparency = T(1) - r.opacity;
  r.radiance = {improved(p.radiance.r + p.transparency * q.radiance.r, whole.radiance.r),
                improved(p.radiance.g + p.transparency * q.radiance.g, whole.radiance.g),
                improved(p.radiance.b + p.transparency * q.radiance.b, whole.radiance.b)};
  return r;
}

}  // namespace detail

/// The segment of four steps of this length, from the material at their five ends: Simpson's rule
/// in effect, of which `difference` takes the same at twice the length. What the segment itself
/// errs is a small part of it where the data are smooth (a sixteenth where they are so smooth that
/// this says all), and less than it where they bend at places that the samples do not know.
/// tests/segment holds it against quadrature.
///
/// Not accurate to the last digits where opacity is small: of a stretch among others of a ray.
template <class T>
SampledSegment<T> sampled_segment(const Material<T>* at, T length) noexcept {
  const SegmentResult<T> p = detail::two_steps(at[0], at[1], at[2], length),
                         q = detail::two_steps(at[2], at[3], at[4], length),
                         coarse = detail::two_steps(at[0], at[2], at[4], T(2) * length);
  SampledSegment<T> r;
  SegmentResult<T>& s = r.segment;
  s.optical_depth = p.optical_depth + q.optical_depth;
  s.opacity = p.opacity + p.transparency * q.opacity;
  s.transparency = p.transparency * q.transparency;
  s.radiance = p.radiance + p.transparency * q.radiance;
  r.difference =
      max(max(abs(s.opacity - coarse.opacity), abs(s.radiance.r - coarse.radiance.r)),
          max(abs(s.radiance.g - coarse.radiance.g), abs(s.radiance.b - coarse.radiance.b)));
  return r;
}

}  // namespace pellucid
