// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/internal/temporary_folder.h"

#include <cstdlib>
#include <system_error>

#include "pellucid/scene/error.h"

namespace pellucid {

TemporaryFolder::TemporaryFolder(const std::string& purpose) {
  std::string pattern = (std::filesystem::temp_directory_path() / "pellucid-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw Error(pattern + ": cannot make a temporary folder for " + purpose +
                "; set TMPDIR to one that is writable");
  }
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace pellucid
