// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/kernels/packet_table.h"

#include <algorithm>
#include <string_view>

#include "benchmarks/support/document.h"

namespace pellucid::bench {
namespace {

struct Column {
  const char* title;
  const char* suffix;
  int lanes;
};
constexpr Column columns[] = {{"libm", "/libm/1", 1},
                              {"ours, one", "/pellucid/1", 1},
                              {"4 lanes, SSE4", "/pellucid/4", 4},
                              {"8 lanes, AVX2", "/pellucid/8", 8},
                              {"16 lanes, AVX-512", "/pellucid/16", 16},
                              {"SLEEF, 4 lanes", "/SLEEF/4", 4},
                              {"SLEEF, 8 lanes", "/SLEEF/8", 8},
                              {"SLEEF, 16 lanes", "/SLEEF/16", 16}};

/// "packet/exp/SLEEF/4" is of kernel "packet/exp".
std::string kernel_of(const std::string& name) {
  const std::size_t lanes = name.rfind('/');
  return name.substr(0, name.rfind('/', lanes - 1));
}

}  // namespace

std::string packet_markdown(const std::vector<std::string>& order,
                            const std::map<std::string, double>& nanoseconds) {
  constexpr std::string_view prefix = "packet/";
  std::vector<std::string> kernels;
  for (const std::string& name : order) {
    if (!name.starts_with(prefix)) continue;
    const std::string kernel = kernel_of(name);
    if (std::find(kernels.begin(), kernels.end(), kernel) == kernels.end()) {
      kernels.push_back(kernel);
    }
  }
  if (kernels.empty()) return {};
  std::string text = "| kernel, float |", line = "|---|";
  for (const Column& column : columns) {
    text += std::string(" ") + column.title + " |";
    line += "---|";
  }
  text += "\n" + line + "\n";
  for (const std::string& kernel : kernels) {
    text += "| " + kernel.substr(prefix.size()) + " |";
    for (const Column& column : columns) {
      const auto found = nanoseconds.find(kernel + column.suffix);
      if (found == nanoseconds.end()) {
        text += " — |";
      } else if (column.lanes == 1) {
        text += format(" %.2f |", found->second);
      } else {
        text += format(" %.2f (%.1f) |", found->second, found->second * column.lanes);
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace pellucid::bench
