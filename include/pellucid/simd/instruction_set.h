// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/config.h"

/// Sources that are compiled once per instruction set (cmake/PellucidInstructionSets.cmake), and
/// which of them may run on this machine.
namespace pellucid {

/// The last that is_supported() is the fastest.
enum class InstructionSet { scalar, sse4, avx2, avx512 };

/// Of one register of floats.
constexpr int lanes_of(InstructionSet set) noexcept {
  return set == InstructionSet::avx512 ? 16
         : set == InstructionSet::avx2 ? 8
         : set == InstructionSet::sse4 ? 4
                                       : 1;
}

constexpr const char* name_of(InstructionSet set) noexcept {
  return set == InstructionSet::avx512 ? "avx512"
         : set == InstructionSet::avx2 ? "avx2"
         : set == InstructionSet::sse4 ? "sse4"
                                       : "scalar";
}

/// Whether the processor has every instruction that the set's sources are compiled for, and the
/// system keeps its registers.
inline bool is_supported(InstructionSet set) noexcept {
#if defined(__x86_64__) && defined(__GNUC__)
  switch (set) {
    case InstructionSet::scalar:
      return true;
    case InstructionSet::sse4:
      return __builtin_cpu_supports("sse4.1");
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx2") &&
             __builtin_cpu_supports("fma");
  }
  return false;
#else
  return set == InstructionSet::scalar;
#endif
}

}  // namespace pellucid

/// In a source that is compiled once per set: PELLUCID_ENTRY(f) is f_sse4, f_avx2 or f_avx512, the
/// name of a function that is declared extern "C" outside of namespace pellucid.
#if defined(PELLUCID_INSTRUCTION_SET)
#define PELLUCID_PASTE_NAMES(a, b) a##_##b
#define PELLUCID_PASTE(a, b) PELLUCID_PASTE_NAMES(a, b)
#define PELLUCID_ENTRY(name) PELLUCID_PASTE(name, PELLUCID_INSTRUCTION_SET)
#endif
