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

/// Returns a name with # for each number in it, and for what stands for one: %04d, *.
std::string without_numbers(const std::string& name) {
  std::string made;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto is_digit = [&](std::size_t at) {
      return at < name.size() && name[at] >= '0' && name[at] <= '9';
    };
    bool is_number = is_digit(i) || name[i] == '*';
    std::size_t end = i;
    if (name[i] == '%') {
      while (is_digit(end + 1)) ++end;
      is_number = end + 1 < name.size() && name[end + 1] == 'd';
      if (is_number) ++end;
    } else if (is_number) {
      while (is_digit(end + 1)) ++end;
    }
    made += is_number ? '#' : name[i];
    if (is_number) i = end;
  }
  return made;
}

/// Returns whether a file may be one of several that an input stands for: of a folder, of numbered
/// files, or of a list of files.
bool may_be_among(const fs::path& file, const fs::path& input) {
  std::error_code error;
  if (file.parent_path() == input) {
    return fs::is_directory(input, error) &&
           (fs::exists(file, error) || file.filename().string().find('%') != std::string::npos);
  }
  if (file.parent_path() != input.parent_path()) return false;
  const std::string extension = input.extension().string();
  if (extension == ".pvd" || extension == ".series") {
    return fs::exists(file, error) && file.extension().string().starts_with(".vt");
  }
  const std::string name = without_numbers(input.filename().string());
  return name.find('#') != std::string::npos && fs::exists(input.parent_path(), error) &&
         (fs::exists(file, error) || file.filename().string().find('%') != std::string::npos) &&
         name == without_numbers(file.filename().string());
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
    for (const auto& [path, input] : read) {
      if (!may_be_among(file, path)) continue;
      throw UsageError(
          fmt::format("{} {}: may overwrite one of the files of the input {} {}; give another "
                      "folder or another name to write to",
                      output.argument, output.path, input->argument, input->path));
    }
    if (const auto [other, is_new] = written.emplace(file, &output); !is_new) {
      throw UsageError(
          fmt::format("{} {}: the same file is written twice, also by {} {}; give another name",
                      output.argument, output.path, other->second->argument, other->second->path));
    }
  }
}

}  // namespace pellucid::cli
