// SPDX-License-Identifier: Apache-2.0
//
// What src/cpu/threads.h says, of oneTBB's threads (test_cpu) and of the pool that stands in for
// them in pages (test_thread_pool).
#include "src/cpu/threads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace pellucid::test_threads {
namespace {

/// Returns whether `threads` threads are within the body at the same time.
bool meet(int threads) {
  std::atomic<int> here{0};
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  parallel_for_ordered(static_cast<std::size_t>(threads), threads, [&](std::size_t) {
    ++here;
    while (here < threads && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    return here == threads;
  });
  return here == threads;
}

TEST(ParallelForOrdered, HasAllThreadsAtWorkAgainAndAgain) {
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(meet(2)) << i;
  EXPECT_TRUE(meet(3));
  EXPECT_TRUE(meet(2));
}

TEST(ParallelForOrdered, TakesEachOnceAndInOrder) {
  for (const int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> taken(1000);
    std::vector<std::size_t> order;
    std::mutex mutex;
    parallel_for_ordered(taken.size(), threads, [&](std::size_t i) {
      ++taken[i];
      const std::lock_guard lock(mutex);
      order.push_back(i);
      return true;
    });
    for (const auto& times : taken) EXPECT_EQ(times, 1);
    if (threads > 1) continue;
    EXPECT_TRUE(std::ranges::is_sorted(order));
  }
}

TEST(ParallelForOrdered, StopsWithinWhatTheThreadsHaveTaken) {
  constexpr std::size_t stopping = 100;
  for (const int threads : {1, 2, 7}) {
    std::atomic<std::size_t> taken{0}, after{0};
    std::atomic<bool> stopped{false};
    parallel_for_ordered(100000, threads, [&](std::size_t) {
      if (stopped) ++after;
      if (++taken >= stopping) stopped = true;
      std::this_thread::sleep_for(std::chrono::microseconds(10));
      return !stopped;
    });
    EXPECT_GE(taken, stopping);
    EXPECT_LE(taken, stopping + 2 * static_cast<std::size_t>(threads)) << threads << " threads";
    EXPECT_LE(after, static_cast<std::size_t>(threads)) << threads << " threads";
  }
}

TEST(ParallelForOrdered, AnExceptionEndsItAndComesOut) {
  for (const int threads : {1, 3}) {
    std::atomic<std::size_t> taken{0};
    EXPECT_THROW(parallel_for_ordered(100000, threads,
                                      [&](std::size_t i) {
                                        ++taken;
                                        if (i == 10) throw std::runtime_error("here");
                                        std::this_thread::sleep_for(std::chrono::microseconds(10));
                                        return true;
                                      }),
                 std::runtime_error);
    EXPECT_LT(taken, 1000u);
  }
}

TEST(ParallelForOrdered, WorksWithinItselfAndBesideItself) {
  std::atomic<int> calls{0};
  const auto work = [&] {
    parallel_for_ordered(20, 3, [&](std::size_t) {
      parallel_for_ordered(10, 3, [&](std::size_t) {
        ++calls;
        return true;
      });
      return true;
    });
  };
  std::thread other(work);
  work();
  other.join();
  EXPECT_EQ(calls, 2 * 20 * 10);
}

TEST(ParallelFor, CoversEachIndexOnce) {
  for (const int threads : {1, 2, 7}) {
    for (const int count : {0, 1, 63, 64, 65, 1000, 100001}) {
      std::vector<std::atomic<int>> covered(static_cast<std::size_t>(count));
      parallel_for(threads)(count, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) ++covered[static_cast<std::size_t>(i)];
      });
      EXPECT_TRUE(std::ranges::all_of(covered, [](const auto& times) { return times == 1; }))
          << count << " by " << threads << " threads";
    }
  }
}

TEST(ParallelFor, AnExceptionComesOut) {
  for (const int threads : {1, 3}) {
    EXPECT_THROW(parallel_for(threads)(1000,
                                       [](int begin, int) {
                                         if (begin >= 0) throw std::runtime_error("here");
                                       }),
                 std::runtime_error);
  }
}

}  // namespace
}  // namespace pellucid::test_threads
