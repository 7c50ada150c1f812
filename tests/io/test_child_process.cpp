// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "pellucid/scene/error.h"
#include "src/io/process/child_process.h"
#include "tests/io/mutants/sanitized.h"

namespace pellucid::test_child_process {
namespace {

TEST(ChildProcess, GivesWhatWasWritten) {
  const auto filled = run_in_child(1000, [](std::span<std::byte> to) {
    std::ranges::fill(to, std::byte{7});
    return true;
  });
  ASSERT_TRUE(filled);
  EXPECT_EQ(std::count(filled.get(), filled.get() + 1000, std::byte{7}), 1000);
  EXPECT_TRUE(run_in_child(0, [](std::span<std::byte>) { return true; }));
}

TEST(ChildProcess, GivesNothingAfterAFailure) {
  const auto nothing = [](auto work) {
    return !run_in_child(10, [&](std::span<std::byte>) {
      work();
      return false;
    });
  };
  EXPECT_TRUE(nothing([] {}));
  EXPECT_TRUE(nothing([] { throw std::runtime_error("no"); }));
  EXPECT_TRUE(nothing([] { std::abort(); }));
  EXPECT_TRUE(nothing([] { std::raise(SIGSEGV); }));
  EXPECT_TRUE(nothing([] { std::raise(SIGFPE); }));
  EXPECT_TRUE(nothing([] { std::raise(SIGKILL); }));
}

TEST(ChildProcess, ErrorsComeThrough) {
  const auto message_of = [](const std::string& message) {
    try {
      run_in_child(10, [&](std::span<std::byte>) -> bool { throw Error(message); });
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing was thrown");
  };
  EXPECT_EQ(message_of("take another file"), "take another file");
  EXPECT_EQ(message_of(""), "");
  EXPECT_EQ(message_of(std::string(5000, 'x')), std::string(1000, 'x'));
}

// A program's own handlers would let its child go on.
TEST(ChildProcess, EndsBySignalsThatTheProgramHandles) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto before = std::signal(signal, SIG_IGN);
    EXPECT_FALSE(run_in_child(1, [signal](std::span<std::byte>) {
      std::raise(signal);
      return true;
    }));
    std::signal(signal, before);
  }
}

TEST(ChildProcess, NothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  EXPECT_FALSE(run_in_child(1, [](std::span<std::byte>) -> bool {
    std::fputs("noise", stderr);
    std::abort();
  }));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

double processor_seconds_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// Of a processor: however busy the machine is, it takes as much.
TEST(ChildProcess, TimeIsLimited) {
  const double before = processor_seconds_of_children();
  EXPECT_FALSE(run_in_child(1, [](std::span<std::byte> to) -> bool {
    for (;;) to.front() = std::byte{2};
  }));
  EXPECT_LT(processor_seconds_of_children() - before, 20);
}

constexpr std::uintmax_t a_gibibyte = std::uintmax_t{1} << 30;

TEST(ChildProcess, AnAnswerIsAsLongAsTheWorkSays) {
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{5000}, std::size_t{1} << 24}) {
    const ChildBytes answer = answer_in_child(
        [&](const MakeAnswer& make) {
          const std::span<std::byte> to = make(bytes);
          to.front() = std::byte{7};
          to.back() = std::byte{9};
          return to.size() == bytes;
        },
        0, a_gibibyte);
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer.size, bytes);
    EXPECT_EQ(answer.span().front(), bytes == 1 ? std::byte{9} : std::byte{7});
    EXPECT_EQ(answer.span().back(), std::byte{9});
    // What is not written is 0.
    EXPECT_EQ(std::count(answer.data.get(), answer.data.get() + bytes, std::byte{0}),
              static_cast<std::ptrdiff_t>(bytes > 1 ? bytes - 2 : 0));
  }
}

TEST(ChildProcess, AFailureAnswersNothing) {
  const auto answer = [](auto work) {
    return answer_in_child(
        [&](const MakeAnswer& make) {
          make(10).front() = std::byte{1};
          work();
          return false;
        },
        0, a_gibibyte);
  };
  EXPECT_FALSE(answer([] {}));
  EXPECT_FALSE(answer([] { std::raise(SIGSEGV); }));
  EXPECT_FALSE(answer([] { throw std::runtime_error("no"); }));
  EXPECT_THROW(answer([] { throw Error("take another file"); }), Error);
  EXPECT_FALSE(answer_in_child([](const MakeAnswer&) { return true; }, 0, a_gibibyte));
}

TEST(ChildProcess, TimeOfAnAnswerIsLimited) {
  const double before = processor_seconds_of_children();
  EXPECT_FALSE(answer_in_child(
      [](const MakeAnswer& make) -> bool {
        const std::span<std::byte> to = make(1);
        for (;;) to.front() = std::byte{2};
      },
      0, a_gibibyte));
  EXPECT_LT(processor_seconds_of_children() - before, 20);
}

#ifndef PELLUCID_SANITIZED
TEST(ChildProcess, MemoryOfAnAnswerIsLimited) {
  const auto take = [](std::size_t bytes) {
    return answer_in_child(
        [&](const MakeAnswer& make) {
          make(bytes).back() = std::byte{1};
          return true;
        },
        0, a_gibibyte);
  };
  EXPECT_FALSE(take(std::size_t{2} << 30));
  EXPECT_TRUE(take(std::size_t{1} << 29));
}

TEST(ChildProcess, MemoryGrowsWithTheFile) {
  const auto take = [](std::span<std::byte> to) {
    std::vector<std::byte> much(std::size_t{2} << 30);
    to.front() = much.back();
    return true;
  };
  EXPECT_TRUE(run_in_child(1, take, std::uintmax_t{1} << 25));
}

TEST(ChildProcess, MemoryIsLimited) {
  EXPECT_FALSE(run_in_child(1, [](std::span<std::byte> to) {
    std::vector<std::byte> much(std::size_t{2} << 30);
    to.front() = much.back();
    return true;
  }));
}
#endif

}  // namespace
}  // namespace pellucid::test_child_process
