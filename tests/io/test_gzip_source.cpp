// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <span>
#include <string>

#include "src/io/files/gzip_source.h"
#include "volume_files.h"

namespace pellucid::test_gzip_source {
namespace {

using test::error_of;

class GzipSource : public test::ScratchFolder {
 protected:
  static std::string part(const ByteSource& source, std::uintmax_t from, std::size_t bytes) {
    std::string text(bytes, ' ');
    source.read(from, std::as_writable_bytes(std::span(text)));
    return text;
  }
};

TEST_F(GzipSource, ReadsInAnyOrder) {
  const ByteSource source = gzip_source(write("a.gz", test::gzipped("0123456789abcdef")));
  EXPECT_EQ(source.size, 16U);
  EXPECT_EQ(part(source, 2, 3), "234");
  EXPECT_EQ(part(source, 5, 2), "56");
  EXPECT_EQ(part(source, 10, 6), "abcdef");
  EXPECT_EQ(part(source, 0, 4), "0123");
  EXPECT_EQ(part(source, 3, 1), "3");
}

TEST_F(GzipSource, MembersFollowEachOther) {
  write("a.gz", test::gzipped("0123") + test::gzipped("4567"));
  const ByteSource source = gzip_source(path("a.gz"));
  EXPECT_EQ(source.size, 8U);
  EXPECT_EQ(part(source, 3, 3), "345");
}

TEST_F(GzipSource, WhatIsNotGzippedIsTakenAsItIs) {
  EXPECT_EQ(plain_or_gzip_source(write("a", "0123")).size, 4U);
  EXPECT_EQ(plain_or_gzip_source(write("b", test::gzipped("0123456789"))).size, 10U);
  error_of([&] { gzip_source(write("c", "0123")); });
}

}  // namespace
}  // namespace pellucid::test_gzip_source
