// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/support/document.h"

#include <cstdarg>
#include <cstdio>

#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"

namespace pellucid::bench {

void replace_section(const std::filesystem::path& file, const std::string& name,
                     const std::string& text) {
  std::string document = read_text_file(file);
  const std::string begin = "<!-- " + name + ": begin -->\n", end = "<!-- " + name + ": end -->\n";
  const std::size_t from = document.find(begin), to = document.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    throw Error(file.string() + ": the lines " + begin.substr(0, begin.size() - 1) + " and " +
                end.substr(0, end.size() - 1) + " are not there; put them where the table belongs");
  }
  document.replace(from + begin.size(), to - from - begin.size(), text);
  write_text_file(file, document);
}

std::string format(const char* pattern, ...) {
  char text[256];
  std::va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

}  // namespace pellucid::bench
