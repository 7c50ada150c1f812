// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "pellucid/io/read_volume.h"
#include "volume_files.h"

namespace pellucid::test_unread_formats {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::error_of;

class UnreadFormats : public test::ScratchFolder {};

TEST_F(UnreadFormats, AreNamed) {
  const auto error = [&](const fs::path& file) { return error_of([&] { read_volume(file); }); };
  // MINC 2 is HDF5, MINC 1 is NetCDF.
  EXPECT_TRUE(contains(error(write("a.mnc", "\x89HDF\r\n\x1a\n")), "is a file of MINC"));
  EXPECT_TRUE(contains(error(write("b.MNC", std::string("CDF\1", 4))), "is a file of MINC"));
  EXPECT_TRUE(contains(error(write("c.mnc.gz", "")), "is a file of MINC"));
  fs::create_directories(path("a.n5/setup0/s0"));
  EXPECT_TRUE(contains(error(path("a.n5")), "is a store of N5"));
  fs::create_directories(path("b/s0"));
  write("b/attributes.json", "{\"n5\": \"2.5.1\"}");
  EXPECT_TRUE(contains(error(path("b")), "is a store of N5"));
  write("b/s0/attributes.json",
        "{\"dimensions\": [5, 4, 3], \"blockSize\": [5, 4, 3], \"dataType\": \"uint8\"}");
  EXPECT_TRUE(contains(error(path("b/s0")), "is a store of N5"));
  EXPECT_TRUE(contains(error(path("b/s0/attributes.json")), "is a store of N5"));
  fs::create_directories(path("c"));
  write("c/attributes.json", "{\"name\": 3}");
  EXPECT_FALSE(contains(error(path("c")), "N5"));
  write("c/attributes.json", "{");
  EXPECT_FALSE(contains(error(path("c")), "N5"));
}

}  // namespace
}  // namespace pellucid::test_unread_formats
