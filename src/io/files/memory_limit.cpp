// SPDX-License-Identifier: Apache-2.0
#include "memory_limit.h"

#include <sys/resource.h>
#include <unistd.h>

#include <charconv>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t unlimited = std::numeric_limits<std::uintmax_t>::max();

std::optional<std::uintmax_t> number_in(const std::string& text) {
  std::uintmax_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end == text.data()) return std::nullopt;
  return number;
}

/// Returns the number that a file begins with; nothing where it is missing or says "max".
std::optional<std::uintmax_t> number_in_file(const fs::path& path) {
  std::ifstream file(path);
  std::string word;
  file >> word;
  return number_in(word);
}

void lower(MemoryLimit& limit, std::uintmax_t bytes, const std::string& of) {
  if (bytes < limit.bytes) limit = {bytes, of};
}

/// Lines "name:   number kB" of /proc/meminfo.
void apply_machine(const fs::path& root, MemoryLimit& limit) {
  std::ifstream file(root / "proc/meminfo");
  std::string line;
  std::optional<std::uintmax_t> available, swap;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string name, number;
    words >> name >> number;
    if (name == "MemAvailable:") available = number_in(number);
    if (name == "SwapFree:") swap = number_in(number);
  }
  if (available) {
    lower(limit, (*available + swap.value_or(0)) * 1024, "this machine");
    return;
  }
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
  if (pages <= 0 || page <= 0) return;
  lower(limit, static_cast<std::uintmax_t>(pages) * static_cast<std::uintmax_t>(page),
        "this machine");
}

/// Applies the limit of the group and of all above it. In a container the path may be that of the
/// host, of which only the end is there, or nothing: the walk upwards then finds the container's
/// own.
void apply_group(const fs::path& folder, const fs::path& group, const char* file,
                 MemoryLimit& limit) {
  for (fs::path at = group.relative_path();; at = at.parent_path()) {
    if (const auto bytes = number_in_file(folder / at / file)) {
      lower(limit, *bytes, "the control group /" + at.string());
    }
    if (at.empty()) return;
  }
}

/// Lines "id:controllers:path"; no controllers are named for version 2.
void apply_groups(const fs::path& root, MemoryLimit& limit) {
  std::ifstream file(root / "proc/self/cgroup");
  const fs::path groups = root / "sys/fs/cgroup";
  std::string line;
  while (std::getline(file, line)) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string path = line.substr(second + 1);
    if (controllers == ",,") {
      apply_group(groups, path, "memory.max", limit);
      apply_group(groups / "unified", path, "memory.max", limit);
    } else if (controllers.find(",memory,") != std::string::npos) {
      apply_group(groups / "memory", path, "memory.limit_in_bytes", limit);
    }
  }
}

template <class Resource>
void apply_resource(Resource resource, std::uintmax_t taken, const char* of, MemoryLimit& limit) {
  rlimit set{};
  if (getrlimit(resource, &set) != 0) return;
  if (set.rlim_cur == RLIM_INFINITY) return;
  lower(limit, set.rlim_cur > taken ? set.rlim_cur - taken : 0, of);
}

/// Applies the limits of the process. /proc/self/statm has pages of address space, resident,
/// shared, of code, 0, of data and stack.
void apply_resources(const fs::path& root, MemoryLimit& limit) {
  std::ifstream file(root / "proc/self/statm");
  std::uintmax_t space = 0, resident = 0, shared = 0, code = 0, none = 0, data = 0;
  file >> space >> resident >> shared >> code >> none >> data;
  const auto page = static_cast<std::uintmax_t>(sysconf(_SC_PAGE_SIZE));
  apply_resource(RLIMIT_AS, space * page, "the limit of address space (ulimit -v)", limit);
  apply_resource(RLIMIT_DATA, data * page, "the limit of data (ulimit -d)", limit);
}

}  // namespace

MemoryLimit memory_limit(const fs::path& root) {
  MemoryLimit limit{unlimited, "this machine"};
  apply_machine(root, limit);
  apply_groups(root, limit);
  apply_resources(root, limit);
  return limit;
}

}  // namespace pellucid
