// SPDX-License-Identifier: Apache-2.0
#include "src/io/files/memory_limit.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <limits>
#include <string>

#include "scratch_folder.h"
#include "src/io/volumes/components.h"
#include "tests/io/mutants/sanitized.h"

namespace pellucid::test_memory_limit {
namespace {

constexpr std::uintmax_t mebi = std::uintmax_t{1} << 20;

/// A folder in the place of "/", with what the system says in it.
class MemoryLimitTest : public test::ScratchFolder {
 protected:
  void SetUp() override {
    test::ScratchFolder::SetUp();
    say("proc/meminfo",
        "MemTotal:       65536000 kB\nMemFree:          100 kB\nMemAvailable:   2097152 kB\n"
        "SwapTotal:       2000000 kB\nSwapFree:        1048576 kB\n");
  }
  void say(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories(path(file).parent_path());
    write(file, text);
  }
  std::uintmax_t mebibytes() const { return memory_limit(folder_).bytes / mebi; }
};

TEST_F(MemoryLimitTest, OfTheMachineIsWhatIsFreeWithSwap) {
  EXPECT_EQ(mebibytes(), 3072u);
  EXPECT_EQ(memory_limit(folder_).of, "this machine");
}

TEST_F(MemoryLimitTest, WithoutMeminfoThePhysicalMemoryCounts) {
  std::filesystem::remove(path("proc/meminfo"));
  const std::uintmax_t physical = static_cast<std::uintmax_t>(sysconf(_SC_PHYS_PAGES)) *
                                  static_cast<std::uintmax_t>(sysconf(_SC_PAGE_SIZE));
  EXPECT_LE(memory_limit(folder_).bytes, physical);  // less under a ulimit
}

TEST_F(MemoryLimitTest, OfControlGroupsOfVersion2IsTheLeastUpwards) {
  say("proc/self/cgroup", "0::/user.slice/app\n");
  say("sys/fs/cgroup/user.slice/app/memory.max", "max\n");
  EXPECT_EQ(mebibytes(), 3072u);
  say("sys/fs/cgroup/user.slice/memory.max", "1073741824\n");
  EXPECT_EQ(mebibytes(), 1024u);
  EXPECT_NE(memory_limit(folder_).of.find("control group /user.slice"), std::string::npos);
  say("sys/fs/cgroup/user.slice/app/memory.max", "536870912\n");
  EXPECT_EQ(mebibytes(), 512u);
  say("sys/fs/cgroup/memory.max", "268435456\n");
  EXPECT_EQ(mebibytes(), 256u);
  say("sys/fs/cgroup/other/memory.max", "1\n");  // not around this process
  EXPECT_EQ(mebibytes(), 256u);
}

TEST_F(MemoryLimitTest, OfControlGroupsOfVersion1) {
  say("proc/self/cgroup", "11:cpu,cpuacct:/x\n4:memory:/docker/abc\n0::/\n");
  say("sys/fs/cgroup/cpu,cpuacct/x/memory.limit_in_bytes", "1\n");
  say("sys/fs/cgroup/memory/docker/abc/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(mebibytes(), 3072u);
  say("sys/fs/cgroup/memory/docker/abc/memory.limit_in_bytes", "134217728\n");
  EXPECT_EQ(mebibytes(), 128u);
}

TEST_F(MemoryLimitTest, InAContainerThatDoesNotSeeItsOwnPath) {
  say("proc/self/cgroup", "4:memory:/docker/abc\n");
  say("sys/fs/cgroup/memory/memory.limit_in_bytes", "67108864\n");
  EXPECT_EQ(mebibytes(), 64u);
  say("proc/self/cgroup", "0::/../../elsewhere\n");
  say("sys/fs/cgroup/memory.max", "33554432\n");
  EXPECT_EQ(mebibytes(), 32u);
}

TEST_F(MemoryLimitTest, FilesThatSayNothingLimitNothing) {
  say("proc/self/cgroup", "nonsense\n\n0:\n:::\n4:memory:\n");
  say("sys/fs/cgroup/memory.max", "");
  say("sys/fs/cgroup/memory/memory.limit_in_bytes", "-1\n");
  EXPECT_EQ(mebibytes(), 3072u);
}

TEST_F(MemoryLimitTest, IsRefusedInOneLineWithBothNumbers) {
  say("proc/self/cgroup", "0::/\n");
  say("sys/fs/cgroup/memory.max", "134217728\n");
  check_memory(128 * mebi, "a.nii.gz: its values", folder_);
  const std::string text =
      test::error_of([&] { check_memory(128 * mebi + 1, "a.nii.gz: its values", folder_); });
  for (const char* part : {"a.nii.gz", "128 MiB", "control group", "crop"}) {
    EXPECT_TRUE(test::contains(text, part)) << text;
  }
  EXPECT_TRUE(test::contains(test::error_of([&] {
                               check_memory(std::numeric_limits<std::uintmax_t>::max(),
                                            "a.raw: its values", folder_);
                             }),
                             "memory"));
}

#ifndef PELLUCID_SANITIZED

/// Whether `condition` holds in a child process that has a limit of so many bytes.
template <class Resource, class Condition>
bool holds_under(Resource resource, rlim_t bytes, const Condition& condition) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{bytes, bytes};
    setrlimit(resource, &limit);
    _exit(condition() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST_F(MemoryLimitTest, OfThisProcessIsWhatItHasNotTaken) {
  say("proc/self/statm", "1024 500 300 100 0 512 0\n");
  const auto page = static_cast<std::uintmax_t>(sysconf(_SC_PAGE_SIZE));
  EXPECT_TRUE(holds_under(RLIMIT_AS, 1 << 30, [&] {
    const MemoryLimit limit = memory_limit(folder_);
    return limit.bytes == (1 << 30) - 1024 * page && limit.of.find("ulimit -v") != limit.of.npos;
  }));
  EXPECT_TRUE(holds_under(RLIMIT_DATA, 1 << 30, [&] {
    const MemoryLimit limit = memory_limit(folder_);
    return limit.bytes == (1 << 30) - 512 * page && limit.of.find("ulimit -d") != limit.of.npos;
  }));
}

// One point of 2e9 components takes 16e9 bytes on the way, also where one of them is asked for.
TEST_F(MemoryLimitTest, CountsComponentsThatAreReadOnlyToBePassedOver) {
  EXPECT_TRUE(holds_under(RLIMIT_AS, 1 << 30, [] {
    const ByteSource source = memory_source({}, "a.mha");
    const std::string text = test::error_of([&] {
      read_components(source, {"f64", false, 0, 2'000'000'000, true}, 1, {1, 1});
    });
    return test::contains(text, "a.mha: its values would take 15258 MiB");
  }));
}

#endif

}  // namespace
}  // namespace pellucid::test_memory_limit
