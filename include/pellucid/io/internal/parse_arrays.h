// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"

namespace pellucid {

/// Read a file in memory, as fuzzers have it. `name` opens the messages. Throw Error.
Volume parse_npy(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options = {});
Volume parse_npz(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options = {});
Volume parse_raw(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options);
Volume parse_slc(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options = {});

}  // namespace pellucid
