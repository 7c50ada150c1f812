// SPDX-License-Identifier: Apache-2.0
#pragma once

/// PELLUCID_DEVICE_KERNEL(body): `body<T>(in, out)`, which calls what is under test, as a kernel in
/// float and in double. A function that may not run on the device does not compile here.
#define PELLUCID_DEVICE_KERNEL(body)                             \
  __global__ void body##_float(const float* in, float* out) {    \
    body(in, out);                                               \
  }                                                              \
  __global__ void body##_double(const double* in, double* out) { \
    body(in, out);                                               \
  }
