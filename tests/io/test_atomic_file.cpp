// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "scratch_folder.h"

namespace pellucid::test_atomic_file {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::error_of;

class AtomicFileTest : public test::ScratchFolder {};

TEST_F(AtomicFileTest, AppearsWholeOnCommitOnly) {
  {
    AtomicFile file(path("out.txt"));
    EXPECT_EQ(file.temporary_path().parent_path(), folder_);
    std::ofstream(file.temporary_path()) << "whole";
    EXPECT_FALSE(fs::exists(path("out.txt")));
    file.commit();
    EXPECT_EQ(read(path("out.txt")), "whole");
  }
  EXPECT_EQ(files(), std::vector<std::string>{"out.txt"});
}

TEST_F(AtomicFileTest, LeavesNothingWithoutCommit) {
  write("out.txt", "before");
  {
    AtomicFile file(path("out.txt"));
    std::ofstream(file.temporary_path()) << "half";
  }
  EXPECT_EQ(files(), std::vector<std::string>{"out.txt"});
  EXPECT_EQ(read(path("out.txt")), "before");
}

TEST_F(AtomicFileTest, TwoWritersDoNotMeet) {
  AtomicFile one(path("out.txt")), two(path("out.txt"));
  EXPECT_NE(one.temporary_path(), two.temporary_path());
}

TEST_F(AtomicFileTest, HasThePermissionsOfAnyNewFile) {
  const mode_t mask = umask(022);
  write_text_file(path("out.txt"), "text");
  umask(mask);
  struct stat status {};
  ASSERT_EQ(stat(path("out.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0644u);
}

TEST_F(AtomicFileTest, RefusesWhatCannotBeWritten) {
  fs::create_directory(path("folder"));
  EXPECT_TRUE(contains(error_of([&] { AtomicFile f(path("none/out.txt")); }), "does not exist"));
  EXPECT_TRUE(contains(error_of([&] { AtomicFile f(path("folder")); }), "is a folder"));
  EXPECT_TRUE(contains(error_of([&] { AtomicFile f(""); }), "not a file name"));
  EXPECT_TRUE(contains(error_of([&] { AtomicFile f("/dev/null"); }), "not a regular file"));
  EXPECT_TRUE(contains(error_of([&] { AtomicFile f("/proc/pellucid.txt"); }), "cannot write"));
  write("plain", "");
  EXPECT_TRUE(contains(error_of([&] { AtomicFile f(path("plain/out.txt")); }), "does not exist"));
  EXPECT_EQ(files(), (std::vector<std::string>{"folder", "plain"}));
}

TEST_F(AtomicFileTest, RefusesWhereThereIsNoPermission) {
  write("secret.txt", "text");
  fs::permissions(path("secret.txt"), fs::perms::none);
  fs::permissions(folder_, fs::perms(0555));
  const uid_t user = geteuid();
  // Root may write and read everything; nobody may not.
  const int changed = user == 0 ? seteuid(65534) : 0;
  const std::string writing = error_of([&] { AtomicFile f(path("out.txt")); });
  const std::string checking = error_of([&] { check_writable(path("out.txt")); });
  const std::string reading = error_of([&] { read_text_file(path("secret.txt")); });
  const int restored = user == 0 ? seteuid(0) : 0;
  ASSERT_EQ(changed, 0);
  ASSERT_EQ(restored, 0);
  fs::permissions(folder_, fs::perms(0755));
  EXPECT_TRUE(contains(writing, "cannot write in the folder")) << writing;
  EXPECT_TRUE(contains(checking, "cannot write in the folder")) << checking;
  EXPECT_TRUE(contains(reading, "cannot read the file")) << reading;
  EXPECT_EQ(files(), std::vector<std::string>{"secret.txt"});
}

TEST_F(AtomicFileTest, ReplacesTheFileBehindALink) {
  fs::create_directory(path("elsewhere"));
  write("elsewhere/real.txt", "before");
  fs::create_symlink(path("elsewhere/real.txt"), path("link.txt"));
  write_text_file(path("link.txt"), "after");
  EXPECT_TRUE(fs::is_symlink(path("link.txt")));
  EXPECT_EQ(read(path("elsewhere/real.txt")), "after");
}

TEST_F(AtomicFileTest, CheckWritableLeavesNoTrace) {
  check_writable(path("out.png"));
  EXPECT_TRUE(files().empty());
  write("old.png", "old");
  check_writable(path("old.png"));
  EXPECT_EQ(read(path("old.png")), "old");
  EXPECT_TRUE(contains(error_of([&] { check_writable(path("none/out.png")); }), "does not exist"));
  EXPECT_TRUE(contains(error_of([&] { check_writable(folder_); }), "is a folder"));
}

// A disk that is full, in the smallest: no file of this process may grow beyond a few bytes.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t largest) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{largest, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallFiles(const SmallFiles&) = delete;
  SmallFiles& operator=(const SmallFiles&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(AtomicFileTest, NoPartialFileWhenTheDiskIsFull) {
  write("old.txt", "old");
  Image image;
  image.width = image.height = 64;
  // Noise, so that no compression makes it small.
  unsigned state = 1;
  for (int i = 0; i < 64 * 64; ++i) {
    std::array<float, 4> pixel{};
    for (float& value : pixel) {
      state = state * 1664525u + 1013904223u;
      value = static_cast<float>(state >> 8) * 0x1p-24F;
    }
    image.pixels.push_back(pixel);
  }
  std::string text_error, png_error, exr_error;
  {
    const SmallFiles limit(2048);
    text_error = error_of([&] { write_text_file(path("old.txt"), std::string(100000, 'x')); });
    png_error = error_of([&] { write_png(image, path("out.png")); });
    exr_error = error_of([&] { write_exr(image, path("out.exr")); });
  }
  EXPECT_TRUE(contains(text_error, "cannot write")) << text_error;
  EXPECT_TRUE(contains(png_error, "cannot write")) << png_error;
  EXPECT_TRUE(contains(exr_error, "cannot write")) << exr_error;
  EXPECT_EQ(files(), std::vector<std::string>{"old.txt"});
  EXPECT_EQ(read(path("old.txt")), "old");
}

TEST_F(AtomicFileTest, TextIsReadBack) {
  const std::string text("a\0b\r\n\xff", 6);
  write_text_file(path("t.txt"), text);
  EXPECT_EQ(read_text_file(path("t.txt")), text);
  write_text_file(path("t.txt"), "");
  EXPECT_EQ(read_text_file(path("t.txt")), "");
}

TEST_F(AtomicFileTest, TextIsReadWithoutItsMark) {
  write_text_file(path("t.txt"), "\xef\xbb\xbf{}");
  EXPECT_EQ(read_text_file(path("t.txt")), "{}");
  EXPECT_EQ(read_bytes(path("t.txt"), 5), "\xef\xbb\xbf{}");
  for (const char* mark : {"\xff\xfe", "\xfe\xff"}) {
    write_text_file(path("t.txt"), mark);
    EXPECT_TRUE(contains(error_of([&] { read_text_file(path("t.txt")); }), "is text in UTF-16"));
    EXPECT_EQ(read_bytes(path("t.txt"), 2), mark);
  }
}

TEST_F(AtomicFileTest, TextThatCannotBeReadIsAnError) {
  write("long.txt", "12345");
  EXPECT_EQ(read_text_file(path("long.txt"), 5), "12345");
  EXPECT_TRUE(contains(error_of([&] { read_text_file(path("long.txt"), 4); }), "at most 4"));
  EXPECT_TRUE(contains(error_of([&] { read_text_file(path("none.txt")); }), "no such file"));
  EXPECT_TRUE(contains(error_of([&] { read_text_file(folder_); }), "is a folder"));
  EXPECT_TRUE(contains(error_of([&] { read_text_file("/dev/zero"); }), "not a regular file"));
}

}  // namespace
}  // namespace pellucid::test_atomic_file
