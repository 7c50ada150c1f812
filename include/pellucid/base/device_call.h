// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/config.h"

/// Marks a large function that devices call instead of inlining it: it is compiled once for all its
/// callers, which would take nvcc many minutes otherwise. The host's compiler decides by itself.
#if defined(__CUDACC__)
#define PELLUCID_DEVICE_CALL __noinline__
#else
#define PELLUCID_DEVICE_CALL
#endif
