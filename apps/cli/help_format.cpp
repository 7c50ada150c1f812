// SPDX-License-Identifier: Apache-2.0
#include "help_format.h"

namespace pellucid::cli {

std::string HelpFormat::make_option_opts(const CLI::Option* option) const {
  const std::string& text = option->get_option_text();
  return text.empty() || option->get_positional() ? "" : " " + text;
}

std::string HelpFormat::make_option_desc(const CLI::Option* option) const {
  constexpr std::size_t help_width = 100;
  const std::size_t width = help_width - get_column_width();
  std::string wrapped, rest = option->get_description();
  while (rest.size() > width) {
    std::size_t cut = rest.rfind(' ', width);
    if (cut == std::string::npos) break;
    wrapped += rest.substr(0, cut) + '\n';
    rest.erase(0, cut + 1);
  }
  return wrapped + rest;
}

}  // namespace pellucid::cli
