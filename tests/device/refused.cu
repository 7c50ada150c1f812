// SPDX-License-Identifier: Apache-2.0
#include "pellucid/base/config.h"
#include "tests/device/kernel.h"

// Must not compile for the device: a kernel that calls a function without PELLUCID_HD. Between two
// functions nvcc only warns of that by itself; this shows that the test's flags make it an error.
namespace pellucid {

template <class T>
T host_only(T x) noexcept {
  return x + x;
}

template <class T>
PELLUCID_HD void forgotten(const T* in, T* out) noexcept {
  out[0] = host_only(in[0]);
}
PELLUCID_DEVICE_KERNEL(forgotten)

}  // namespace pellucid
