// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace pellucid::cli {

/// A subcommand: what CLI11 parses, and what runs afterwards and returns the exit code.
struct Command {
  CLI::App* arguments;
  std::function<int()> run;
};

Command add_render(CLI::App& app);
Command add_info(CLI::App& app);
Command add_evaluate(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_histogram(CLI::App& app);
Command add_suggest(CLI::App& app);
Command add_convert(CLI::App& app);
Command add_presets(CLI::App& app);
Command add_transfer_function(CLI::App& app);

}  // namespace pellucid::cli
