// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/native.h"

#if PELLUCID_HAS_BATCH_4
namespace pellucid {

/// While it lives, results on this thread that are below the smallest normal number are 0 (the flag
/// FTZ of MXCSR). Powers of small depths and transparencies get there in binary32, where each such
/// operation takes a processor a hundred times as long; and of what is gathered along a ray 1e-38
/// is nothing. Numbers that are given as denormal are taken as they are.
///
/// On AArch64 it does nothing: the flag there would also take denormal numbers that are given for
/// 0. WebAssembly has no such flag.
#if PELLUCID_HAS_NEON64 || defined(__wasm__)
class [[maybe_unused]] FlushToZero {
 public:
  static constexpr bool flushes = false;
  FlushToZero() noexcept {}
  ~FlushToZero() {}
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;
};
#else
class FlushToZero {
 public:
  static constexpr bool flushes = true;
  FlushToZero() noexcept : before_(__builtin_ia32_stmxcsr()) {
    __builtin_ia32_ldmxcsr(before_ | 0x8000u);
  }
  ~FlushToZero() { __builtin_ia32_ldmxcsr(before_); }
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;

 private:
  unsigned before_;
};
#endif

}  // namespace pellucid
#endif
