// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <string>

#include "commands.h"
#include "help_format.h"
#include "output.h"
#include "parse.h"
#include "pellucid/base/version.h"
#include "progress.h"

namespace pellucid::cli {

namespace {

int fail(int exit_code, const std::string& message) {
  // Nothing is left to be done where stderr itself cannot be written.
  std::fputs(("pellucid: error: " + one_line(message) + '\n').c_str(), stderr);
  return exit_code;
}

std::string command_names(std::span<const Command> commands) {
  std::string names;
  for (const Command& command : commands) {
    names += (names.empty() ? "" : ", ") + command.arguments->get_name();
  }
  return names;
}

int run(int argc, char** argv) {
  CLI::App app("Renders volumes by the volume rendering integral itself instead of samples of it.",
               "pellucid");
  app.footer(
      "Examples:\n"
      "  pellucid render brain.nii.gz -o brain.png\n"
      "  pellucid render builtin:marschner_lobb -o ml.exr --size 1024x768\n"
      "  pellucid info brain.nii.gz\n"
      "  pellucid suggest brain.nii.gz -o brain.json\n"
      "  pellucid compare exact.exr midpoint.exr\n"
      "\n"
      "'pellucid COMMAND --help' shows the options and examples of a command.\n"
      "Exit codes: 0 done, 1 failed, 2 wrong arguments, 3 over the tolerance, 130 interrupted. A\n"
      "failure is one line on stderr and leaves no partial file.");
  app.set_version_flag("--version", "pellucid " PELLUCID_VERSION_STRING,
                       "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.formatter(std::make_shared<HelpFormat>());
  app.require_subcommand(1);
  const Command commands[] = {add_render(app),  add_info(app),    add_histogram(app),
                              add_suggest(app), add_convert(app), add_evaluate(app),
                              add_compare(app), add_presets(app), add_transfer_function(app)};

  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    print_text(app.help());
    return 0;
  } catch (const CLI::CallForAllHelp&) {
    print_text(app.help());
    return 0;
  } catch (const CLI::CallForVersion&) {
    print_text("pellucid " PELLUCID_VERSION_STRING "\n");
    return 0;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    if (chosen.empty() && argc > 1 && argv[1][0] != '-') {
      throw UsageError(
          fmt::format("'{}' is no command; the commands are {} (see 'pellucid --help')", argv[1],
                      command_names(commands)));
    }
    const std::string name = chosen.empty() ? "" : " " + chosen.back()->get_name();
    throw UsageError(fmt::format("{} (see 'pellucid{} --help')", error.what(), name));
  }
  for (const Command& command : commands) {
    if (command.arguments->parsed()) return command.run();
  }
  return 0;
}

}  // namespace

}  // namespace pellucid::cli

int main(int argc, char** argv) {
  using namespace pellucid::cli;
  try {
    return run(argc, argv);
  } catch (const UsageError& error) {
    return fail(2, error.what());
  } catch (const OverTolerance& error) {
    return fail(3, error.what());
  } catch (const Interrupted& interrupted) {
    return fail(128 + interrupted.signal, "interrupted; nothing more was written");
  } catch (const pellucid::Error& error) {
    return fail(1, error.what());
  } catch (const std::bad_alloc&) {
    return fail(1, "not enough memory; use a smaller volume or image, or more memory");
  } catch (const std::exception& error) {
    return fail(1, fmt::format("{}; this is a defect of pellucid, please report it", error.what()));
  } catch (...) {
    return fail(1, "unknown exception; this is a defect of pellucid, please report it");
  }
}
