// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Batch<T, N> and BatchMask<N>: N = 4, 8, 16 lanes that are computed on together, each where the
/// compiler may use SSE4.1 or NEON, AVX2 with FMA, or AVX-512 (F, CD, DQ, BW, VL); nothing without.
/// The names are those of simd/scalar.h. Host only; needs the headers of xsimd (8.1 or later),
/// which nothing outside of this folder names.
///
/// Sources that include this are compiled once per instruction set, each with the namespace renamed
/// (cmake/PellucidInstructionSets.cmake): an inline function compiled for one must never be linked
/// into code that runs on a machine without it.
#include "pellucid/simd/native_base.h"
#include "pellucid/simd/scalar.h"

#if PELLUCID_HAS_BATCH_4
#include "pellucid/simd/batch_exp.h"
#include "pellucid/simd/batch_mask.h"
#include "pellucid/simd/batch_memory.h"
#include "pellucid/simd/batch_number.h"
#endif
