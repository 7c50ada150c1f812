// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// CLI11 is compiled in command_line.cpp alone: every file that includes it takes seconds more.
namespace CLI {  // NOLINT: the name that CLI11 has
class App;
class Option;
}  // namespace CLI

namespace pellucid::cli {

/// An option or a flag of a command. The functions that set a property return the option.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  /// Sets the text that help shows as its value: "FILE".
  Option* option_text(const std::string& text);
  /// Sets the heading that help puts it under.
  Option* group(const std::string& name);
  Option* required();
  /// Sets whether one mention may have several values.
  Option* allow_extra_args(bool allowed);
  /// Makes other values than these wrong arguments.
  Option* one_of(const std::vector<std::string>& values);
  Option* in_range(int least, int greatest);
  /// Forbids that the two are given together.
  Option* excludes(Option* other);
  Option* excludes(const std::string& name);

  std::size_t count() const;     ///< how often it was given
  std::string get_name() const;  ///< as help has it: "--type"

 private:
  CLI::Option* option_;
};

/// The program's arguments, or those of one command of it. A value that an option sets must outlive
/// the parsing.
class CommandLine {
 public:
  /// Begins a command line. `name` is the program's.
  CommandLine(const std::string& description, const std::string& name);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  CommandLine* add_subcommand(const std::string& name, const std::string& description);

  Option* add_option(const std::string& names, std::string& value, const std::string& help);
  Option* add_option(const std::string& names, std::vector<std::string>& value,
                     const std::string& help);
  Option* add_option(const std::string& names, std::optional<std::string>& value,
                     const std::string& help);
  Option* add_option(const std::string& names, int& value, const std::string& help);
  Option* add_option(const std::string& names, std::optional<int>& value, const std::string& help);
  Option* add_option(const std::string& names, double& value, const std::string& help);
  Option* add_option(const std::string& names, std::optional<double>& value,
                     const std::string& help);
  Option* add_option(const std::string& names, std::size_t& value, const std::string& help);
  Option* add_flag(const std::string& names, bool& value, const std::string& help);
  /// Adds --threads, of which 0 stands for one per core.
  void add_threads(int& threads);
  /// Sets the text at the end of help.
  void footer(const std::string& text);

  /// Takes any arguments, which nobody reads.
  void take_any_arguments();

  std::string get_name() const;
  bool parsed() const;  ///< whether this is the command that was given

  /// Reads the arguments of the program. Returns false if help or the version was asked for and
  /// printed. Throws UsageError.
  bool parse(int argc, char** argv, const std::string& version);

 private:
  CommandLine(CLI::App* app);
  Option* keep(CLI::Option* option);

  std::unique_ptr<CLI::App> program_;  ///< null: a command of one
  CLI::App* app_;
  std::vector<std::unique_ptr<Option>> options_;
  std::vector<std::unique_ptr<CommandLine>> commands_;
};

}  // namespace pellucid::cli
