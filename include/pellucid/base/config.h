// SPDX-License-Identifier: Apache-2.0
#pragma once

/// PELLUCID_HD marks a function that runs on the host and, where nvcc compiles it, on the device.
/// Every kernel of the header-only core has it; nothing else in the core refers to CUDA.
#if defined(__CUDACC__)
#define PELLUCID_HD __host__ __device__
#else
#define PELLUCID_HD
#endif

/// 1 while a kernel is compiled for the device, else 0. For the rare kernel that computes the same
/// numbers differently there (a fused multiply-add is one instruction on every device).
#if defined(__CUDA_ARCH__)
#define PELLUCID_ON_DEVICE 1
#else
#define PELLUCID_ON_DEVICE 0
#endif

/// 1 if the compiler has built-in vector types.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define PELLUCID_HAS_VECTOR_TYPES 1
#else
#define PELLUCID_HAS_VECTOR_TYPES 0
#endif
