// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace pellucid::cli {

/// A file that a command reads or writes, and the argument it is given by, as "--tf".
struct NamedFile {
  std::string argument, path;
};

/// Throws UsageError where two outputs are one file, or an output is an input, whatever way the
/// paths are written and through links. Inputs without a path are passed over. Hard links count as
/// files of their own: outputs replace a name, so that what stands at the other one stays.
void refuse_overwriting(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

}  // namespace pellucid::cli
