// SPDX-License-Identifier: Apache-2.0
#pragma once

// PELLUCID_SANITIZED: a sanitizer keeps memory of its own, so no limit of memory can be tested.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PELLUCID_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#define PELLUCID_SANITIZED
#endif
#endif
