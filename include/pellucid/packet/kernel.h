// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/instruction_set.h"

/// PELLUCID_KERNEL(name, Job) declares a kernel, which is compiled once per instruction set: to be
/// written within extern "C" outside of namespace pellucid.
#define PELLUCID_KERNEL(name, Job) \
  using name##_job = Job;          \
  PELLUCID_DECLARE_ENTRIES(void, name, (name##_job * job))

/// PELLUCID_DEFINE_KERNEL(name) { … } defines it, in a source that is compiled once per set, with
/// the job as `job`.
#define PELLUCID_DEFINE_KERNEL(name) extern "C" void PELLUCID_ENTRY(name)(name##_job * job)

/// PELLUCID_KERNEL_OF(set, name) is the kernel for a set, null where there is none: in sources of a
/// target that pellucid_instruction_sets() adds kernels to.
#if defined(PELLUCID_HAS_PACKETS) && PELLUCID_HAS_PACKETS
#define PELLUCID_KERNEL_OF(set, name) pellucid::entry_of(set, PELLUCID_ENTRIES(name))
#else
#define PELLUCID_KERNEL_OF(set, name) \
  (static_cast<void>(set), static_cast<void (*)(name##_job*)>(nullptr))
#endif
