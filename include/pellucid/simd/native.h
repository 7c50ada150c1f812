// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Operations that the SIMD library lacks or gets wrong, per width: Native<N> for N = 4 (SSE4.1 or
/// NEON; WebAssembly by SSE4.1's functions), 8 (AVX2 with FMA) and 16 (AVX-512 F, CD, DQ, BW, VL),
/// each only where the compiler may use those instructions. Batches are made of these; nothing
/// outside of this folder names them.
#include "pellucid/simd/native_avx2.h"
#include "pellucid/simd/native_avx512.h"
#include "pellucid/simd/native_neon64.h"
#include "pellucid/simd/native_sse4.h"
