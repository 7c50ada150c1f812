// SPDX-License-Identifier: Apache-2.0
//
// Stands in for Emscripten's libunwind in modules with threads, where clang is older than 15, as
// Debian 12's is. For each exception that is caught by its type, such a clang writes where it is
// caught to one place for all threads, and asks there which of the catches takes it. The library
// has a place per thread, so that nothing would be caught.
//
// With one place, two threads must not catch by type at once. Threads of the pool do not
// (src/cpu/thread_pool.cpp): `catch (...)` and destructors ask nothing.
#include <cstdint>

namespace {

/// _Unwind_Exception, as it begins.
struct ThrownException {
  std::uint64_t type;
  void (*destroy)(int reason, ThrownException* exception);
};

struct LandingPad {
  std::uintptr_t index;
  std::uintptr_t table;
  std::uintptr_t selector;  ///< of the catch that takes the exception
};

constexpr int is_foreign = 1;  // _URC_FOREIGN_EXCEPTION_CAUGHT
constexpr int cleanup = 2;     // _UA_CLEANUP_PHASE

}  // namespace

extern "C" {

LandingPad __wasm_lpad_context;

int __gxx_personality_wasm0(int version, int actions, std::uint64_t type,
                            ThrownException* exception, LandingPad* pad);

int _Unwind_CallPersonality(ThrownException* exception) {
  __wasm_lpad_context.selector = 0;
  return __gxx_personality_wasm0(1, cleanup, exception->type, exception, &__wasm_lpad_context);
}

int _Unwind_RaiseException(ThrownException* exception) {
  __builtin_wasm_throw(0, exception);
}

void _Unwind_DeleteException(ThrownException* exception) {
  if (exception->destroy != nullptr) exception->destroy(is_foreign, exception);
}

void _Unwind_SetGR(LandingPad* pad, int index, std::uintptr_t value) {
  if (index == 1) pad->selector = value;
}

/// Returns an index that the caller takes 1 from and counts from 1.
std::uintptr_t _Unwind_GetIP(LandingPad* pad) {
  return pad->index + 2;
}

void _Unwind_SetIP(LandingPad*, std::uintptr_t) {}

std::uintptr_t _Unwind_GetLanguageSpecificData(LandingPad* pad) {
  return pad->table;
}

std::uintptr_t _Unwind_GetRegionStart(LandingPad*) {
  return 0;
}
}
