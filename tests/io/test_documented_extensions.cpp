// SPDX-License-Identifier: Apache-2.0
//
// The tables of docs/reference/command-line.md name the extensions that the formats have.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include "pellucid/io/write_volume.h"
#include "src/io/meshes/mesh_format.h"
#include "src/io/volumes/volume_format.h"

namespace pellucid::test_documented_extensions {
namespace {

using Words = std::set<std::string>;

std::string command_line_page() {
  std::ifstream file(PELLUCID_SOURCE_DIR "/docs/reference/command-line.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the extensions in backticks of a cell: "`.st`, each also `.gz`" is two.
Words extensions_in(const std::string& cell) {
  Words found;
  for (std::size_t begin = 0; (begin = cell.find("`.", begin)) != std::string::npos;) {
    const std::size_t end = cell.find('`', begin + 1);
    found.insert(cell.substr(begin + 1, end - begin - 1));
    begin = end + 1;
  }
  if (found.erase(".gz") == 0) return found;
  Words both = found;
  for (const std::string& one : found) both.insert(one + ".gz");
  return both;
}

/// Returns the extensions in a column of the first table behind a heading, from 0.
Words extensions_of_table(const std::string& page, const std::string& heading, int column) {
  Words found;
  const std::size_t begin = page.find("\n|", page.find("\n" + heading));
  std::istringstream rows(page.substr(begin + 1, page.find("\n\n", begin) - begin));
  for (std::string row; std::getline(rows, row);) {
    std::istringstream cells(row.substr(1));
    std::string cell;
    for (int i = 0; i <= column; ++i) std::getline(cells, cell, '|');
    found.merge(extensions_in(cell));
  }
  return found;
}

Words words_of(const std::string& text) {
  std::istringstream list(text);
  return {std::istream_iterator<std::string>(list), {}};
}

Words difference(const Words& all, const Words& known) {
  Words left = all;
  for (const std::string& word : known) left.erase(word);
  return left;
}

TEST(DocumentedExtensions, OfInputAreThoseOfTheFormats) {
  const Words documented = extensions_of_table(command_line_page(), "**Input.**", 1);
  Words known;
  for (const VolumeFormat* format : volume_formats()) {
    known.merge(words_of(std::string(format->extensions)));
  }
  for (const MeshFormat* format : mesh_formats()) {
    known.merge(words_of(std::string(format->extensions)));
  }
  EXPECT_EQ(difference(known, documented), Words{});
#if defined(PELLUCID_HAVE_VTK) && defined(PELLUCID_HAVE_HDF5) && defined(PELLUCID_HAVE_NETCDF) && \
    defined(PELLUCID_HAVE_OPENVDB)
  // Scenes, and headers that are known by their content.
  EXPECT_EQ(difference(documented, known), (Words{".dat", ".json"}));
#endif
}

TEST(DocumentedExtensions, OfOutputAreThoseOfTheWriters) {
  const Words documented = extensions_of_table(command_line_page(), "## pellucid convert", 0);
  Words known = words_of(writable_volume_extensions());
  known.insert(".vtu");  // tetrahedra
  EXPECT_EQ(documented, known);
}

TEST(DocumentedExtensions, AreFoundInATable) {
  const std::string page =
      "**Input.** Text\n\n| input | names |\n|---|---|\n| a `.no` | `.a`, `.b.c` |\n"
      "| b | `.d`, each also `.gz` |\n\n| c | `.e` |\n";
  EXPECT_EQ(extensions_of_table("x\n" + page, "**Input.**", 1),
            (Words{".a", ".b.c", ".d", ".d.gz"}));
}

}  // namespace
}  // namespace pellucid::test_documented_extensions
