// SPDX-License-Identifier: Apache-2.0
#include "threads.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <map>
#include <optional>

namespace pellucid {
namespace {

/// Returns the calling thread's arena of so many threads. oneTBB keeps some 50 kB of each arena
/// that is destroyed until all workers have left it, which takes long where other work keeps the
/// cores busy; so they are made once.
tbb::task_arena& arena_of(int threads) {
  thread_local std::map<int, tbb::task_arena> arenas;
  return arenas.try_emplace(threads, threads).first->second;
}

}  // namespace

int default_thread_count() {
  return tbb::info::default_concurrency();
}

ParallelFor parallel_for(int threads) {
  return [threads](int count, const std::function<void(int, int)>& body) {
    arena_of(threads).execute([&] {
      tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, count, 64),
                          [&](const auto& range) { body(range.begin(), range.end()); });
      });
    });
  };
}

void parallel_for_ordered(std::size_t count, int threads,
                          const std::function<bool(std::size_t)>& body) {
  // oneTBB keeps to the number of cores, and prints a warning, unless it is told otherwise.
  std::optional<tbb::global_control> more_threads_than_cores;
  if (threads > default_thread_count()) {
    more_threads_than_cores.emplace(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  }
  std::atomic<std::size_t> next{0};
  tbb::task_group_context context;
  const auto take_all = [&](const tbb::blocked_range<int>&) {
    while (!context.is_group_execution_cancelled()) {
      const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
      if (i >= count) return;
      if (!body(i)) context.cancel_group_execution();
    }
  };
  arena_of(threads).execute([&] {
    tbb::parallel_for(tbb::blocked_range<int>(0, threads, 1), take_all, tbb::simple_partitioner(),
                      context);
  });
}

}  // namespace pellucid
