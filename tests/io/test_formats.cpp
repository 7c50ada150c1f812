// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>

#include "pellucid/io/read_volume.h"
#include "src/io/meshes/mesh_format.h"
#include "src/io/volumes/volume_format.h"
#include "src/io/volumes/volume_writers.h"

namespace pellucid::test_formats {
namespace {

std::vector<std::string> words(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> list;
  for (std::string word; stream >> word;) list.push_back(word);
  return list;
}

TEST(VolumeFormats, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const VolumeFormat* const format : volume_formats()) {
    EXPECT_FALSE(format->name.empty());
    EXPECT_TRUE(names.insert(format->name).second) << format->name;
  }
}

/// By "a.hdr.gz" no other format is meant than by ".hdr.gz".
TEST(VolumeFormats, ShareNoExtension) {
  for (const VolumeFormat* const format : volume_formats()) {
    for (const std::string& extension : words(format->extensions)) {
      EXPECT_TRUE(extension.starts_with('.') && extension.size() > 1) << extension;
      EXPECT_TRUE(std::ranges::none_of(extension, [](char c) { return c >= 'A' && c <= 'Z'; }))
          << extension;
      for (const VolumeFormat* const other : volume_formats()) {
        const auto known = words(other->extensions);
        EXPECT_EQ(std::ranges::count_if(
                      known, [&](const std::string& end) { return extension.ends_with(end); }),
                  other == format ? 1 : 0)
            << extension << " of " << format->name << " and " << other->name;
      }
      EXPECT_EQ(volume_format_by_name("A" + extension), format) << extension;
    }
  }
}

TEST(VolumeFormats, AreRecognizedByNameOrContent) {
  for (const VolumeFormat* const format : volume_formats()) {
    EXPECT_TRUE(!format->extensions.empty() || format->takes_path || format->content_owner ||
                format->takes_unknown_name)
        << format->name;
    EXPECT_NE(format->open, nullptr) << format->name;
    EXPECT_TRUE(!format->is_json || format->takes_path) << format->name;
  }
}

TEST(VolumeFormats, AreListedForMessages) {
  std::size_t listed = words(volume_extensions()).size(), known = 0;
  for (const VolumeFormat* const format : volume_formats()) {
    known += words(format->extensions).size();
  }
  EXPECT_EQ(listed, known);
  EXPECT_GT(known, 50u);
}

/// Only one kind of folder can be what no format takes before.
TEST(VolumeFormats, TakeOtherFoldersOnce) {
  EXPECT_EQ(std::ranges::count_if(volume_formats(),
                                  [](const VolumeFormat* f) { return f->takes_other_folders; }),
            1);
}

TEST(MeshFormats, HaveNamesAndExtensionsOfTheirOwn) {
  std::set<std::string> names, extensions;
  for (const MeshFormat* const format : mesh_formats()) {
    EXPECT_TRUE(names.insert(std::string(format->name)).second) << format->name;
    EXPECT_NE(format->read, nullptr) << format->name;
    EXPECT_FALSE(format->extensions.empty()) << format->name;
    for (const std::string& extension : words(format->extensions)) {
      // path::extension() gives one point.
      EXPECT_EQ(extension.rfind('.'), 0u) << extension;
      EXPECT_TRUE(extensions.insert(extension).second) << extension;
    }
  }
  EXPECT_EQ(words(mesh_extensions()).size(), extensions.size());
}

/// PLOT3D alone has the solution in a file of its own, by which the format is known.
TEST(MeshFormats, TakeASolutionOnce) {
  EXPECT_EQ(
      std::ranges::count_if(mesh_formats(), [](const MeshFormat* f) { return f->takes_solution; }),
      1);
}

TEST(VolumeWriters, WriteWhatIsRead) {
  std::set<std::string_view> extensions;
  for (const VolumeWriter* const writer : volume_writers()) {
    EXPECT_TRUE(extensions.insert(writer->extension).second) << writer->extension;
    EXPECT_NE(volume_format_by_name("a" + std::string(writer->extension)), nullptr)
        << writer->extension;
    EXPECT_NE(writer->write, nullptr) << writer->extension;
  }
  EXPECT_GE(extensions.size(), 5u);
}

}  // namespace
}  // namespace pellucid::test_formats
