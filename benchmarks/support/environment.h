// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace pellucid::bench {

/// What a figure must be read with.
struct Environment {
  std::string machine;   ///< CPU model
  unsigned cores = 0;    ///< that the program may use
  std::string compiler;  ///< name and version
  std::string flags;     ///< build type and optimisation flags
  std::string commit;    ///< short hash, "-dirty" where the tree differs
  std::string date;      ///< UTC
};

Environment environment(const std::string& commit);
std::string to_markdown(const Environment& environment);
nlohmann::ordered_json to_json(const Environment& environment);

}  // namespace pellucid::bench
