// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/support/environment.h"

#include <ctime>
#include <fstream>
#include <thread>

#include "pellucid/base/version.h"

namespace pellucid::bench {
namespace {

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string utc_date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
  return text;
}

}  // namespace

Environment environment(const std::string& commit) {
#if defined(__clang__)
  const std::string compiler = "clang " __clang_version__;
#else
  const std::string compiler = "GCC " __VERSION__;
#endif
  return {cpu_model(),          std::thread::hardware_concurrency(), compiler,
          PELLUCID_BENCH_FLAGS, commit.empty() ? "unknown" : commit, utc_date()};
}

std::string to_markdown(const Environment& e) {
  return "Pellucid " PELLUCID_VERSION_STRING ", commit " + e.commit + ", " + e.date + "; " +
         e.machine + ", " + std::to_string(e.cores) + " cores; " + e.compiler + " (" + e.flags +
         ").\n";
}

nlohmann::ordered_json to_json(const Environment& e) {
  return {{"version", PELLUCID_VERSION_STRING},
          {"commit", e.commit},
          {"date", e.date},
          {"machine", e.machine},
          {"cores", e.cores},
          {"compiler", e.compiler},
          {"flags", e.flags}};
}

}  // namespace pellucid::bench
