// SPDX-License-Identifier: Apache-2.0
#pragma once

/// PELLUCID_HD marks a function that runs on the host and, where nvcc compiles it, on the device.
/// It stands on every kernel of the header-only core; nothing else in the core names CUDA.
#if defined(__CUDACC__)
#define PELLUCID_HD __host__ __device__
#else
#define PELLUCID_HD
#endif

/// 1 while a kernel is compiled for the device, else 0: for the rare kernel that takes another way
/// to the same numbers there (a fused multiply-add is one instruction on every device).
#if defined(__CUDA_ARCH__)
#define PELLUCID_ON_DEVICE 1
#else
#define PELLUCID_ON_DEVICE 0
#endif

/// 1 where the compiler has vectors of numbers as types of its own.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define PELLUCID_HAS_VECTOR_TYPES 1
#else
#define PELLUCID_HAS_VECTOR_TYPES 0
#endif
