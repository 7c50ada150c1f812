// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/cuda/device_backend.h"
#include "pellucid/scene/error.h"

namespace pellucid {

/// Returns why there is no card to test on; empty if there is one.
inline std::string missing_card() {
  try {
    make_cuda_backend();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace pellucid
