// SPDX-License-Identifier: Apache-2.0
#include "private_folder.h"

#include <unistd.h>

#include <cstdlib>
#include <string>
#include <system_error>

#include "pellucid/scene/error.h"

namespace pellucid::view {

PrivateFolder::PrivateFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "pellucid-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw Error(name +
                ": cannot make a folder for temporary files; set TMPDIR to one that is writable");
  }
  path_ = name;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace pellucid::view
