// SPDX-License-Identifier: Apache-2.0
//
// Stands in for threads.cpp where there is no oneTBB: in pages that may have threads. Those are
// made once, and wait between works.
//
// Nothing here but the caller catches an exception by its type: Debian's clang 14 has one place for
// all threads where it looks for that (cmake/web/unwind.cpp).
#include "threads.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace pellucid {

namespace {

/// Threads that a page makes before it works (apps/web/CMakeLists.txt).
constexpr int most_threads = 16;

class ThreadPool {
 public:
  ThreadPool() = default;
  ~ThreadPool() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    wakes_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Calls work() here and on up to `threads` - 1 others, and returns, or throws what one threw,
  /// once all that began are done. Work within work, or beside it, has the calling thread alone.
  void run(int threads, const std::function<void()>& work) {
    if (threads <= 1 || is_busy_.exchange(true)) {
      work();
      return;
    }
    {
      const std::lock_guard lock(mutex_);
      make(static_cast<std::size_t>(std::min(threads, most_threads)) - 1);
      work_ = &work;
      to_begin_ = std::min(threads_.size(), static_cast<std::size_t>(threads) - 1);
    }
    wakes_.notify_all();
    call(work);
    std::unique_lock lock(mutex_);
    to_begin_ = 0;  // there is nothing left for who has not begun
    is_done_.wait(lock, [this] { return begun_ == 0; });
    const std::exception_ptr error = std::exchange(error_, nullptr);
    lock.unlock();
    is_busy_ = false;
    if (error) std::rethrow_exception(error);
  }

 private:
  /// Makes threads until there are so many, or no more are to be had.
  void make(std::size_t count) {
    try {
      while (threads_.size() < count) threads_.emplace_back([this] { wait_for_work(); });
    } catch (...) {
      // Those that are there do it.
    }
  }

  void wait_for_work() {
    std::unique_lock lock(mutex_);
    while (true) {
      wakes_.wait(lock, [this] { return ended_ || to_begin_ > 0; });
      if (ended_) return;
      --to_begin_;
      ++begun_;
      const std::function<void()>& work = *work_;
      lock.unlock();
      call(work);
      lock.lock();
      if (--begun_ == 0) is_done_.notify_one();
    }
  }

  void call(const std::function<void()>& work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
  }

  std::atomic<bool> is_busy_{false};
  std::mutex mutex_;  ///< guards all below
  std::condition_variable wakes_, is_done_;
  std::vector<std::thread> threads_;
  const std::function<void()>* work_ = nullptr;
  std::size_t to_begin_ = 0;  ///< threads that may still take the work up
  std::size_t begun_ = 0;     ///< threads that are at it, without the caller
  std::exception_ptr error_;
  bool ended_ = false;
};

ThreadPool& pool() {
  static ThreadPool one;
  return one;
}

}  // namespace

int default_thread_count() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, most_threads);
}

ParallelFor parallel_for(int threads) {
  return [threads](int count, const std::function<void(int, int)>& body) {
    const int part = std::max(64, count / (8 * std::max(threads, 1)));
    const auto parts = static_cast<std::size_t>((std::max(count, 0) + part - 1) / part);
    parallel_for_ordered(parts, threads, [&](std::size_t i) {
      const int begin = static_cast<int>(i) * part;
      body(begin, begin + std::min(part, count - begin));
      return true;
    });
  };
}

void parallel_for_ordered(std::size_t count, int threads,
                          const std::function<bool(std::size_t)>& body) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> is_over{false};
  const int most = static_cast<int>(std::min(count, static_cast<std::size_t>(most_threads)));
  pool().run(std::min(threads, most), [&] {
    try {
      while (!is_over) {
        const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
        if (i >= count) return;
        if (!body(i)) is_over = true;
      }
    } catch (...) {
      is_over = true;
      throw;
    }
  });
}

}  // namespace pellucid
