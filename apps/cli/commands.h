// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "arguments/command_line.h"

namespace pellucid::cli {

/// A subcommand: what CLI11 parses, and what runs afterwards and returns the exit code.
struct Command {
  CommandLine* arguments;
  std::function<int()> run;
};

Command add_render(CommandLine& app);
Command add_animate(CommandLine& app);
Command add_view(CommandLine& app);
Command add_info(CommandLine& app);
Command add_evaluate(CommandLine& app);
Command add_compare(CommandLine& app);
Command add_histogram(CommandLine& app);
Command add_suggest(CommandLine& app);
Command add_convert(CommandLine& app);
Command add_export(CommandLine& app);
Command add_presets(CommandLine& app);
Command add_transfer_function(CommandLine& app);

/// Adds a command to the program.
using AddCommand = Command (*)(CommandLine& app);

/// Returns what adds the program's commands, in the order of --help.
std::span<const AddCommand> command_table();

}  // namespace pellucid::cli
