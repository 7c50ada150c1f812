// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pellucid/base/config.h"

/// Sources that are compiled once per instruction set (cmake/PellucidInstructionSets.cmake), and
/// which of them may run on this machine.
namespace pellucid {

/// Instruction sets of x86-64, the fastest last, that of AArch64 and that of WebAssembly.
enum class InstructionSet { scalar, sse4, avx2, avx512, neon64, wasm128 };

/// The sets of this kind of processor, the fastest last: PELLUCID_EACH_SET(f) is f(sse4) f(avx2)
/// f(avx512), f(neon64) or f(wasm128).
#if defined(__aarch64__)
#define PELLUCID_EACH_SET(f) f(neon64)
#elif defined(__wasm__)
#define PELLUCID_EACH_SET(f) f(wasm128)
#else
#define PELLUCID_EACH_SET(f) f(sse4) f(avx2) f(avx512)
#endif

#define PELLUCID_LIST_SET(set) InstructionSet::set,
inline constexpr InstructionSet packet_sets[] = {PELLUCID_EACH_SET(PELLUCID_LIST_SET)};
/// The same, and one ray at a time.
inline constexpr InstructionSet instruction_sets[] = {InstructionSet::scalar,
                                                      PELLUCID_EACH_SET(PELLUCID_LIST_SET)};
#undef PELLUCID_LIST_SET
inline constexpr std::size_t packet_set_count = sizeof packet_sets / sizeof *packet_sets;

/// Returns the entry of `set` of one entry per set (PELLUCID_ENTRIES below), null for a set that is
/// not among packet_sets.
template <class Function, class... Functions>
constexpr Function* entry_of(InstructionSet set, Function* first, Functions*... others) noexcept {
  static_assert(1 + sizeof...(others) == packet_set_count);
  Function* const all[] = {first, others...};
  for (std::size_t i = 0; i < packet_set_count; ++i) {
    if (packet_sets[i] == set) return all[i];
  }
  return nullptr;
}

/// Returns the number of lanes of one register of floats.
constexpr int lanes_of(InstructionSet set) noexcept {
  return set == InstructionSet::avx512   ? 16
         : set == InstructionSet::avx2   ? 8
         : set == InstructionSet::scalar ? 1
                                         : 4;
}

constexpr const char* name_of(InstructionSet set) noexcept {
  return set == InstructionSet::avx512    ? "avx512"
         : set == InstructionSet::avx2    ? "avx2"
         : set == InstructionSet::sse4    ? "sse4"
         : set == InstructionSet::neon64  ? "neon64"
         : set == InstructionSet::wasm128 ? "wasm128"
                                          : "scalar";
}

/// Returns whether the processor has every instruction that the set's sources are compiled for, and
/// the system keeps its registers.
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
    case InstructionSet::neon64:
    case InstructionSet::wasm128:
      return false;
  }
  return false;
#elif defined(__aarch64__)
  return set == InstructionSet::scalar || set == InstructionSet::neon64;
#elif defined(__wasm__)
  return set == InstructionSet::scalar || set == InstructionSet::wasm128;
#else
  return set == InstructionSet::scalar;
#endif
}

}  // namespace pellucid

/// PELLUCID_DECLARE_ENTRIES(type, f, (arguments)) declares the functions of all sets, f_sse4 to
/// f_avx512, or f_neon64, or f_wasm128: to be written within extern "C" outside of namespace
/// pellucid. PELLUCID_ENTRIES(f) lists them as packet_sets lists the sets.
#if defined(__aarch64__)
#define PELLUCID_ENTRIES(name) name##_neon64
#define PELLUCID_DECLARE_ENTRIES(type, name, arguments) type name##_neon64 arguments
#elif defined(__wasm__)
#define PELLUCID_ENTRIES(name) name##_wasm128
#define PELLUCID_DECLARE_ENTRIES(type, name, arguments) type name##_wasm128 arguments
#else
#define PELLUCID_ENTRIES(name) name##_sse4, name##_avx2, name##_avx512
#define PELLUCID_DECLARE_ENTRIES(type, name, arguments) \
  type name##_sse4 arguments;                           \
  type name##_avx2 arguments;                           \
  type name##_avx512 arguments
#endif

/// In a source that is compiled once per set: PELLUCID_ENTRY(f) is f_sse4, f_avx2, f_avx512,
/// f_neon64 or f_wasm128.
#if defined(PELLUCID_INSTRUCTION_SET)
#define PELLUCID_PASTE_NAMES(a, b) a##_##b
#define PELLUCID_PASTE(a, b) PELLUCID_PASTE_NAMES(a, b)
#define PELLUCID_ENTRY(name) PELLUCID_PASTE(name, PELLUCID_INSTRUCTION_SET)
#endif
