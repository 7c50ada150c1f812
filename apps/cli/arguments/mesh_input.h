// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "command_line.h"
#include "overwriting.h"
#include "pellucid/io/mesh_source.h"

namespace pellucid::cli {

/// Adds --time and --time-between, into these, and returns them.
std::array<Option*, 2> add_time_options(CommandLine& command, std::optional<double>& time,
                                        std::string& between);
/// Returns what --time-between says; "": the nearest step. Throws UsageError where there is no
/// time.
TimeBetween between_steps(const std::string& text, bool has_time);

/// The options that say what of a mesh file is read.
struct MeshOptions {
  std::string q;
  std::optional<double> time;
  std::string time_between;         ///< "nearest", "linear"; empty: not given
  bool has_times = false;           ///< True if times of data come from a film.
  std::vector<std::string> arrays;  ///< [NAME=]ARRAY[:C]
  std::vector<Option*> given;       ///< all of them, to ask which were used

  /// Adds the options; `--array` where the command looks at arrays.
  void add_to(CommandLine& command, bool with_arrays);
  /// Throws UsageError where an option is used, saying that it does not apply to `what`.
  void refuse(const std::string& what) const;
  /// Throws the same for options other than those of time.
  void refuse_but_times(const std::string& what) const;
  /// Puts the time into the options of a volume or a mesh. Throws UsageError.
  template <class Options>
  void set_time(Options& options) const {
    options.time = time;
    options.time_between = between_steps(time_between, time.has_value() || has_times);
  }
  /// Throws the same for `--solution` alone: volume files have arrays and times too.
  void refuse_q(const std::string& what) const;
};

/// Returns the kinds of INPUT besides a volume, for help texts.
std::string mesh_input_help();
/// Returns what INPUT of a command that shows data may be, for help.
std::string scene_input_help();

/// Returns whether INPUT is a mesh: by --solution, or by the file.
bool is_mesh(const std::string& input, const MeshOptions& options);
/// Throws UsageError.
MeshSource mesh_source(const std::string& input, const MeshOptions& options);
/// Returns the files that are read, to be kept from being written.
std::vector<NamedFile> data_files(const MeshSource& source);

}  // namespace pellucid::cli
