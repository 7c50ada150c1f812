// SPDX-License-Identifier: Apache-2.0
#include "overwriting.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <system_error>

#include "parse.h"

namespace pellucid::cli {

namespace {

namespace fs = std::filesystem;

// One spelling per file, for files that need not exist. weakly_canonical alone keeps the name of a
// link to a file that is not there yet, but another output may make that file. Where the system
// does not tell, the path stays as it is; using it fails with a better message than any here.
fs::path one_spelling(const fs::path& path) {
  constexpr int longest_chain = 40;  // the limit of Linux itself (path_resolution(7))
  std::error_code error;
  fs::path resolved = fs::absolute(path, error);
  if (error) return path;
  for (int links = 0; links < longest_chain && fs::is_symlink(resolved, error); ++links) {
    const fs::path target = fs::read_symlink(resolved, error);
    if (error) return path;
    resolved = resolved.parent_path() / target;
  }
  const fs::path canonical = fs::weakly_canonical(resolved, error);
  return error ? resolved.lexically_normal() : canonical;
}

}  // namespace

void refuse_overwriting(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs) {
  std::map<fs::path, const NamedFile*> read, written;
  for (const NamedFile& input : inputs) {
    if (!input.path.empty()) read.emplace(one_spelling(input.path), &input);
  }
  for (const NamedFile& output : outputs) {
    const fs::path file = one_spelling(output.path);
    if (const auto input = read.find(file); input != read.end()) {
      throw UsageError(
          fmt::format("{} {}: would overwrite the input {} {}; give another name to write to",
                      output.argument, output.path, input->second->argument, input->second->path));
    }
    if (const auto [other, is_new] = written.emplace(file, &output); !is_new) {
      throw UsageError(
          fmt::format("{} {}: the same file is written twice, also by {} {}; give another name",
                      output.argument, output.path, other->second->argument, other->second->path));
    }
  }
}

}  // namespace pellucid::cli
