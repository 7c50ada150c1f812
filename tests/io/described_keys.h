// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "volume_files.h"

// The table "What descriptions say" of docs/reference/formats.md, row by row. Each row is a test
// that reads a small file with the key; a test compares the table with the rows that are here.
namespace pellucid::test {

enum class Treatment { honored, told, refused };

/// One row: a key of a format's description, and what a reader does with it.
struct DescribedKey {
  std::string format;  ///< as the heading of the table says
  std::string key;     ///< as the file writes it
  Treatment treatment;
};

/// Rows of this executable, in no order.
inline std::vector<DescribedKey>& described_keys() {
  static std::vector<DescribedKey> keys;
  return keys;
}

/// Base of the rows' tests: a scratch folder and the row's own words.
class DescribedKeys : public ScratchFolder {
 protected:
  /// Expects a note of the reading to name `key`.
  static void expect_told(const std::vector<std::string>& notes, const std::string& key) {
    for (const std::string& note : notes) {
      EXPECT_EQ(note.find('\n'), std::string::npos) << note;
      if (contains(note, key)) return;
    }
    std::string all;
    for (const std::string& note : notes) all += "  " + note + "\n";
    ADD_FAILURE() << "no note names " << key << ":\n" << all;
  }
  /// Expects an Error of one line that names `key`.
  template <class Function>
  static void expect_refused(const Function& function, const std::string& key) {
    const std::string text = error_of(function);
    EXPECT_TRUE(contains(text, key)) << text;
  }
};

}  // namespace pellucid::test

/// A row and its test: PELLUCID_DESCRIBED_KEY(nrrd_space, "NRRD", "space", honored) { … }. The body
/// reads a file with the key and expects it to be honored, told (expect_told()) or refused
/// (expect_refused()).
#define PELLUCID_DESCRIBED_KEY(name, format, key, treatment)              \
  [[maybe_unused]] static const bool described_##name = [] {              \
    ::pellucid::test::described_keys().push_back(                         \
        {format, key, ::pellucid::test::Treatment::treatment});           \
    return true;                                                          \
  }();                                                                    \
  class DescribedKeys_##name : public ::pellucid::test::DescribedKeys {}; \
  TEST_F(DescribedKeys_##name, Read)
