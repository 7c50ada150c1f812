// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "arguments/output.h"
#include "arguments/parse.h"
#include "commands.h"
#include "pellucid/base/version.h"
#include "render/progress.h"
#include "render/render.h"

namespace pellucid::cli {

namespace {

int fail(int exit_code, const std::string& message) {
  // Nothing is left to be done where stderr itself cannot be written.
  std::fputs(("pellucid: error: " + one_line(message) + '\n').c_str(), stderr);
  return exit_code;
}

/// Reports wrong arguments: of ranks by one of them.
int wrong_use(int argc, char** argv, const std::string& message) {
  if (!is_rank(argc, argv)) return fail(2, message);
  try {
    return fail_on_ranks(message);
  } catch (const Error&) {
    return fail(2, message);
  }
}

int run(int argc, char** argv) {
  CommandLine app("Renders volumes and meshes. You give a tolerance instead of a step size.",
                  "pellucid");
  app.footer(
      "Examples:\n"
      "  pellucid render brain.nii.gz -o brain.png\n"
      "  pellucid render builtin:marschner_lobb -o ml.exr --size 1024x768\n"
      "  pellucid view brain.nii.gz\n"
      "  pellucid info brain.nii.gz\n"
      "  pellucid suggest brain.nii.gz -o brain.json\n"
      "  pellucid compare exact.exr midpoint.exr\n"
      "\n"
      "'pellucid COMMAND --help' prints the options of a command, with examples.\n"
      "Exit status: 0 success, 1 failure, 2 wrong arguments, 3 over the tolerance, 130 "
      "interrupted.\n"
      "A failure prints one line on stderr and leaves no partial file.");
  std::vector<Command> commands;
  for (const AddCommand add : command_table()) commands.push_back(add(app));

  if (!app.parse(argc, argv, "pellucid " PELLUCID_VERSION_STRING)) return 0;
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
    return wrong_use(argc, argv, error.what());
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
