// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>

namespace pellucid {

/// Where the real volumes lie that are too large to keep here: the folder that the environment
/// variable PELLUCID_TEST_DATA names, else shared/data beside the checkout. Tests that find nothing
/// there skip.
inline std::filesystem::path test_data_folder() {
  if (const char* folder = std::getenv("PELLUCID_TEST_DATA")) return folder;
  return std::filesystem::path(PELLUCID_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace pellucid
