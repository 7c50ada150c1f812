// SPDX-License-Identifier: Apache-2.0
#include "view/server/uploads.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "pellucid/io/internal/temporary_folder.h"
#include "pellucid/scene/error.h"
#include "view/server/folders.h"

namespace pellucid::view::uploads_test {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path) {
  std::ofstream(path) << "x";
}

TEST(Uploads, NamesStayInTheirFolder) {
  for (const char* name : {"", ".", "..", "/etc/passwd", "a/../b", "a//b", "a/", "../a", "a/./b"}) {
    EXPECT_THROW(checked_upload_name(name), Error) << name;
  }
  EXPECT_THROW(checked_upload_name(std::string("a\0b", 3)), Error);
  EXPECT_THROW(checked_upload_name(std::string(300, 'a')), Error);
  std::string deep = "a";
  for (int i = 0; i < 20; ++i) deep += "/a";
  EXPECT_THROW(checked_upload_name(deep), Error);
  EXPECT_EQ(checked_upload_name("series 1/a.dcm"), fs::path("series 1/a.dcm"));
}

TEST(Uploads, AreDecoded) {
  EXPECT_EQ(percent_decoded("a%20b%2Fc"), "a b/c");
  EXPECT_THROW(percent_decoded("a%2"), Error);
  EXPECT_THROW(percent_decoded("%zz"), Error);
}

TEST(Uploads, KeepNoMoreThanTheLimit) {
  Uploads uploads(100);
  const fs::path path = uploads.place(1, "a/b.raw", 60);
  EXPECT_TRUE(fs::is_directory(path.parent_path()));
  EXPECT_EQ(uploads.find(1, "a/b.raw"), path);
  EXPECT_THROW(uploads.place(1, "c", 41), Error);
  EXPECT_THROW(uploads.place(1, "c", ~std::uint64_t{0}), Error);
  uploads.place(1, "c", 40);
}

TEST(Uploads, AreNotOverwritten) {
  Uploads uploads(100);
  write(uploads.place(1, "a", 1));
  EXPECT_THROW(uploads.place(1, "a", 1), Error);
  EXPECT_THROW(uploads.place(1, "a/b", 1), Error);
}

TEST(Uploads, ANewSetReplacesThoseThatAreNotShown) {
  Uploads uploads(100);
  const fs::path shown = uploads.place(1, "a", 1);
  uploads.keep(1);
  const fs::path pending = uploads.place(2, "a", 1);
  write(pending);
  uploads.place(3, "a", 1);
  EXPECT_FALSE(fs::exists(pending));
  EXPECT_TRUE(fs::exists(shown.parent_path()));
  EXPECT_THROW(uploads.find(2, "a"), Error);
  EXPECT_EQ(uploads.find(1, "a"), shown);
  // Whoever shows it has the folder, however many come after it.
  const auto folder = uploads.folder(1);
  uploads.keep(3);
  uploads.place(4, "a", 1);
  EXPECT_TRUE(fs::exists(folder->path()));
  EXPECT_EQ(fs::status(folder->path()).permissions(), fs::perms::owner_all);
}

TEST(Folders, ListFoldersThenFiles) {
  const TemporaryFolder folder("a test");
  for (const char* name : {"b.nrrd", "A.txt", ".hidden", "caf\xe9.nrrd"}) {
    write(folder.path() / name);
  }
  fs::create_directory(folder.path() / "z");
  fs::create_directory(folder.path() / "store.zarr");
  const Json json = folder_json(folder.path().string());
  EXPECT_EQ(json["parent"], fs::canonical(folder.path()).parent_path().string());
  ASSERT_EQ(json["entries"].size(), 4U);
  EXPECT_EQ(json["entries"][0]["name"], "store.zarr");
  EXPECT_EQ(json["entries"][0]["known"], true);
  EXPECT_EQ(json["entries"][1]["folder"], true);
  EXPECT_EQ(json["entries"][1]["known"], false);
  EXPECT_EQ(json["entries"][2], (Json{{"name", "A.txt"}, {"bytes", 1}, {"known", false}}));
  EXPECT_EQ(json["entries"][3], (Json{{"name", "b.nrrd"}, {"bytes", 1}, {"known", true}}));
  EXPECT_TRUE(folder_json("/")["parent"].is_null());
  EXPECT_THROW(folder_json((folder.path() / "none").string()), Error);
  EXPECT_THROW(folder_json((folder.path() / "b.nrrd").string()), Error);
}

}  // namespace
}  // namespace pellucid::view::uploads_test
