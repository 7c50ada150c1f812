// SPDX-License-Identifier: Apache-2.0
#pragma once

// What we use of oneTBB, over std::thread, for the thread sanitizer alone (preset tsan).
//
// Debian's oneTBB is not built with the sanitizer, which therefore cannot see how it synchronises:
// nearly every task looks like a race with the code that started it. Suppressions would have to
// name functions of oneTBB, which stand in the stack of every task, and so would hide the races of
// our own. Here all that synchronises is visible, and a report is a defect.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {

namespace info {
inline int default_concurrency() {
  return 4;
}
}  // namespace info

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t) {}
};

class task_group_context {
 public:
  void cancel_group_execution() { cancelled_ = true; }
  bool is_group_execution_cancelled() const { return cancelled_; }

 private:
  std::atomic<bool> cancelled_{false};
};

namespace stand_in {
inline thread_local int concurrency = info::default_concurrency();
}

class task_arena {
 public:
  explicit task_arena(int threads) : threads_(threads) {}
  template <class Function>
  void execute(const Function& function) {
    const int before = stand_in::concurrency;
    stand_in::concurrency = threads_;
    function();
    stand_in::concurrency = before;
  }

 private:
  int threads_;
};

template <class T>
class blocked_range {
 public:
  blocked_range(T begin, T end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
  T begin() const { return begin_; }
  T end() const { return end_; }
  std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }

  std::vector<blocked_range> pieces() const {
    std::vector<blocked_range> result;
    for (T first = begin_; first < end_;) {
      const T last =
          first + static_cast<T>(std::min(grain_, static_cast<std::size_t>(end_ - first)));
      result.emplace_back(first, last, grain_);
      first = last;
    }
    return result;
  }

 private:
  T begin_, end_;
  std::size_t grain_;
};

template <class T>
class blocked_range2d {
 public:
  blocked_range2d(T row_begin, T row_end, std::size_t row_grain, T column_begin, T column_end,
                  std::size_t column_grain)
      : rows_(row_begin, row_end, row_grain), columns_(column_begin, column_end, column_grain) {}
  const blocked_range<T>& rows() const { return rows_; }
  const blocked_range<T>& cols() const { return columns_; }

  std::vector<blocked_range2d> pieces() const {
    std::vector<blocked_range2d> result;
    for (const auto& row : rows_.pieces()) {
      for (const auto& column : columns_.pieces()) {
        result.emplace_back(row.begin(), row.end(), row.size(), column.begin(), column.end(),
                            column.size());
      }
    }
    return result;
  }

 private:
  blocked_range<T> rows_, columns_;
};

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body, task_group_context& context) {
  const std::vector<Range> pieces = range.pieces();
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr exception;
  const auto work = [&] {
    for (std::size_t i = next++; i < pieces.size(); i = next++) {
      if (context.is_group_execution_cancelled()) return;
      try {
        body(pieces[i]);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!exception) exception = std::current_exception();
        context.cancel_group_execution();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < stand_in::concurrency; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (exception) std::rethrow_exception(exception);
}

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body) {
  task_group_context context;
  parallel_for(range, body, context);
}

/// The ranges here are always cut to their grain.
struct simple_partitioner {};
template <class Range, class Body>
void parallel_for(const Range& range, const Body& body, const simple_partitioner&,
                  task_group_context& context) {
  parallel_for(range, body, context);
}

namespace this_task_arena {
template <class Body>
void isolate(const Body& body) {
  body();
}
}  // namespace this_task_arena

}  // namespace tbb
