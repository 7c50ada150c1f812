// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "output.h"
#include "parse.h"

namespace pellucid::cli {

namespace {

/// Help texts in 100 columns: an option shows what it takes (Option::option_text) and no more;
/// the rest stands in its description.
class HelpFormat : public CLI::Formatter {
 public:
  HelpFormat() { column_width(28); }

  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string& text = option->get_option_text();
    return text.empty() || option->get_positional() ? "" : " " + text;
  }

  std::string make_option_desc(const CLI::Option* option) const override {
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
};

std::string command_names(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands({})) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return names;
}

}  // namespace

Option* Option::option_text(const std::string& text) {
  option_->option_text(text);
  return this;
}
Option* Option::group(const std::string& name) {
  option_->group(name);
  return this;
}
Option* Option::required() {
  option_->required();
  return this;
}
Option* Option::allow_extra_args(bool allowed) {
  option_->allow_extra_args(allowed);
  return this;
}
Option* Option::one_of(const std::vector<std::string>& values) {
  option_->check(CLI::IsMember(values));
  return this;
}
Option* Option::in_range(int least, int greatest) {
  option_->check(CLI::Range(least, greatest));
  return this;
}
Option* Option::excludes(Option* other) {
  option_->excludes(other->option_);
  return this;
}
Option* Option::excludes(const std::string& name) {
  option_->excludes(name);
  return this;
}
std::size_t Option::count() const {
  return option_->count();
}
std::string Option::get_name() const {
  return option_->get_name();
}

namespace {

/// Refuses an empty text, which CLI11 takes for no number, or for 0.
std::string no_empty_number(const std::string& text) {
  return text.empty() ? "needs a number, and was given an empty text" : std::string();
}

/// Adds an option of texts, which may not be empty: that would mean as much as no option. What
/// stands without a name is checked by the command.
template <class Value>
CLI::Option* add_text(CLI::App& app, const std::string& names, Value& value,
                      const std::string& help) {
  CLI::Option* const option = app.add_option(names, value, help);
  if (!names.starts_with('-')) return option;
  return option->check([](const std::string& text) {
    return text.empty() ? "needs a value, and was given an empty text" : std::string();
  });
}

/// Returns the arguments behind the name of the program, the last one first, as CLI11 takes them,
/// with --solution for --q, which later versions than Debian 12 has take for -q.
std::vector<std::string> arguments_of(int argc, char** argv) {
  constexpr std::string_view name = "--q";
  std::vector<std::string> arguments(argv + std::min(1, argc), argv + argc);
  for (std::string& argument : arguments) {
    if (argument == "--") break;
    if (argument == name || argument.starts_with("--q=")) {
      argument.replace(0, name.size(), "--solution");
    }
  }
  std::ranges::reverse(arguments);
  return arguments;
}

}  // namespace

CommandLine::CommandLine(const std::string& description, const std::string& name)
    : program_(std::make_unique<CLI::App>(description, name)), app_(program_.get()) {
  app_->set_help_flag("-h,--help", "Print this help and exit");
  app_->formatter(std::make_shared<HelpFormat>());
  app_->require_subcommand(1);
}
CommandLine::CommandLine(CLI::App* app) : app_(app) {}
CommandLine::~CommandLine() = default;

CommandLine* CommandLine::add_subcommand(const std::string& name, const std::string& description) {
  CLI::App* const command = app_->add_subcommand(name, description);
  commands_.push_back(std::unique_ptr<CommandLine>(new CommandLine(command)));
  return commands_.back().get();
}

Option* CommandLine::keep(CLI::Option* option) {
  options_.push_back(std::make_unique<Option>(option));
  return options_.back().get();
}
Option* CommandLine::add_option(const std::string& names, std::string& value,
                                const std::string& help) {
  return keep(add_text(*app_, names, value, help));
}
Option* CommandLine::add_option(const std::string& names, std::vector<std::string>& value,
                                const std::string& help) {
  return keep(add_text(*app_, names, value, help));
}
Option* CommandLine::add_option(const std::string& names, std::optional<std::string>& value,
                                const std::string& help) {
  return keep(add_text(*app_, names, value, help));
}
Option* CommandLine::add_option(const std::string& names, int& value, const std::string& help) {
  return keep(app_->add_option(names, value, help)->check(no_empty_number));
}
Option* CommandLine::add_option(const std::string& names, std::optional<int>& value,
                                const std::string& help) {
  return keep(app_->add_option(names, value, help)->check(no_empty_number));
}
Option* CommandLine::add_option(const std::string& names, double& value, const std::string& help) {
  return keep(app_->add_option(names, value, help)->check(no_empty_number));
}
Option* CommandLine::add_option(const std::string& names, std::optional<double>& value,
                                const std::string& help) {
  return keep(app_->add_option(names, value, help)->check(no_empty_number));
}
Option* CommandLine::add_option(const std::string& names, std::size_t& value,
                                const std::string& help) {
  return keep(app_->add_option(names, value, help)->check(no_empty_number));
}
Option* CommandLine::add_flag(const std::string& names, bool& value, const std::string& help) {
  return keep(app_->add_flag(names, value, help));
}

void CommandLine::add_threads(int& threads) {
  add_option("--threads", threads, "Number of threads; 0 (default): one per core")
      ->option_text("N")
      ->in_range(0, 4096);
}

void CommandLine::footer(const std::string& text) {
  app_->footer(text);
}
void CommandLine::take_any_arguments() {
  app_->allow_extras();
}
std::string CommandLine::get_name() const {
  return app_->get_name();
}
bool CommandLine::parsed() const {
  return app_->parsed();
}

bool CommandLine::parse(int argc, char** argv, const std::string& version) {
  app_->set_version_flag("--version", version, "Print the version and exit");
  try {
    app_->parse(arguments_of(argc, argv));
  } catch (const CLI::CallForHelp&) {
    print_text(app_->help());
    return false;
  } catch (const CLI::CallForAllHelp&) {
    print_text(app_->help());
    return false;
  } catch (const CLI::CallForVersion&) {
    print_text(version + '\n');
    return false;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app_->get_subcommands();
    if (chosen.empty() && argc > 1 && argv[1][0] != '-') {
      throw UsageError(
          fmt::format("unknown command '{}'; the commands are {} (see 'pellucid --help')", argv[1],
                      command_names(*app_)));
    }
    const std::string name = chosen.empty() ? "" : " " + chosen.back()->get_name();
    throw UsageError(fmt::format("{} (see 'pellucid{} --help')", error.what(), name));
  }
  return true;
}

}  // namespace pellucid::cli
