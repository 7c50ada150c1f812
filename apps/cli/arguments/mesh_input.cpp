// SPDX-License-Identifier: Apache-2.0
#include "mesh_input.h"

#include <fmt/format.h>

#include "input.h"
#include "parse.h"

namespace pellucid::cli {

namespace {

constexpr const char* mesh_group = "Options of mesh files";

}  // namespace

std::array<Option*, 2> add_time_options(CommandLine& command, std::optional<double>& time,
                                        std::string& between) {
  Option* const at = command
                         .add_option("--time", time,
                                     "Read the step nearest to this time. Default: the first of a "
                                     "mesh")
                         ->option_text("T");
  Option* const how =
      command
          .add_option("--time-between", between,
                      "Values at a time between two steps: nearest, those of the nearest step "
                      "(default), or linear, of both")
          ->one_of({"nearest", "linear"})
          ->option_text("HOW");
  return {at, how};
}

TimeBetween between_steps(const std::string& text, bool has_time) {
  if (!text.empty() && !has_time) throw UsageError("--time-between needs a --time");
  return text == "linear" ? TimeBetween::linear : TimeBetween::nearest;
}

void MeshOptions::add_to(CommandLine& command, bool with_arrays) {
  const auto add = [&](Option* option) { given.push_back(option->group(mesh_group)); };
  if (with_arrays) {
    add(command
            .add_option(
                "--array", arrays,
                "Show this array, or its component C, from 0. Without C a vector of a mesh gives "
                "its length. May be repeated: several arrays are channels for Gaussians, called "
                "NAME. Default: the active scalars, else the first point array with one component")
            ->option_text("[NAME=]ARRAY[:C]")
            ->allow_extra_args(false));
  }
  for (Option* const option : add_time_options(command, time, time_between)) add(option);
  add(command.add_option("--solution", q, "PLOT3D solution; INPUT is then a PLOT3D grid")
          ->option_text("FILE"));
}

namespace {

void refuse_option(const Option& option, const std::string& what) {
  if (option.count() == 0) return;
  throw UsageError(fmt::format("{} applies to mesh files, not to {}", option.get_name(), what));
}

bool is_of_time(const Option& option) {
  return option.get_name().starts_with("--time");
}

}  // namespace

void MeshOptions::refuse(const std::string& what) const {
  for (const Option* option : given) {
    if (option->count() > 0 && is_of_time(*option)) {
      throw UsageError(fmt::format("{}: {} has no steps in time", option->get_name(), what));
    }
    refuse_option(*option, what);
  }
}

void MeshOptions::refuse_but_times(const std::string& what) const {
  for (const Option* option : given) {
    if (!is_of_time(*option)) refuse_option(*option, what);
  }
}

void MeshOptions::refuse_q(const std::string& what) const {
  if (!q.empty())
    throw UsageError(fmt::format("--solution applies to mesh files, not to {}", what));
}

std::string mesh_input_help() {
  return fmt::format("mesh ({})", mesh_extensions());
}

std::string scene_input_help() {
  return input_help() + ", " + mesh_input_help() + ", SCENE.json or builtin:NAME[:POINTS]";
}

bool is_mesh(const std::string& input, const MeshOptions& options) {
  return !input.empty() && !input.starts_with("builtin:") &&
         (!options.q.empty() || is_mesh_file(input));
}

MeshSource mesh_source(const std::string& input, const MeshOptions& options) {
  MeshSource source;
  source.file = input;
  options.set_time(source.options);
  source.options.q = options.q;
  try {
    for (const std::string& text : options.arrays) {
      source.channels.push_back(parse_mesh_array(text));
    }
    check_mesh_source(source);
  } catch (const Error& error) {
    throw UsageError(fmt::format("--array: {}", error.what()));
  }
  return source;
}

std::vector<NamedFile> data_files(const MeshSource& source) {
  return {{"mesh", source.file.string()}, {"--solution", source.options.q.string()}};
}

}  // namespace pellucid::cli
