/* SPDX-License-Identifier: Apache-2.0
 *
 * Preloaded by `scripts/check uninitialised`, for child processes that libraries run in. Under
 * valgrind all takes thirty times as long, so their limits are lifted. What a child hands over, in
 * memory that both see, is new to its parent: the child writes it to /dev/null before it ends, and
 * valgrind looks at each byte of that. */
#include <fcntl.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

int setrlimit(__rlimit_resource_t resource, const struct rlimit* limits) {
  (void)resource;
  (void)limits;
  return 0;
}

int setrlimit64(__rlimit_resource_t resource, const struct rlimit64* limits) {
  (void)resource;
  (void)limits;
  return 0;
}

enum { most = 64 };
static struct {
  void* at;
  size_t bytes;
} shared[most];

void* mmap(void* hint, size_t bytes, int protection, int flags, int file, off_t offset) {
  void* const at = (void*)syscall(SYS_mmap, hint, bytes, protection, flags, file, offset);
  if (at == MAP_FAILED || (flags & MAP_SHARED) == 0 || (protection & PROT_WRITE) == 0) return at;
  for (int i = 0; i < most; ++i) {
    if (shared[i].at != NULL) continue;
    shared[i].at = at;
    shared[i].bytes = bytes;
    break;
  }
  return at;
}

void* mmap64(void* hint, size_t bytes, int protection, int flags, int file, off64_t offset) {
  return mmap(hint, bytes, protection, flags, file, offset);
}

int munmap(void* at, size_t bytes) {
  for (int i = 0; i < most; ++i) {
    if (shared[i].at == at) shared[i].at = NULL;
  }
  return (int)syscall(SYS_munmap, at, bytes);
}

void _exit(int status) {
  const int nowhere = open("/dev/null", O_WRONLY);
  for (int i = 0; i < most; ++i) {
    if (shared[i].at == NULL) continue;
    const ssize_t written = write(nowhere, shared[i].at, shared[i].bytes);
    (void)written;
  }
  for (;;) syscall(SYS_exit_group, status);
}
