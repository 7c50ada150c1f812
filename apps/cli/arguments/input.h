// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_line.h"
#include "pellucid/io/channel_source.h"
#include "pellucid/io/field_source.h"

namespace pellucid::cli {

/// Returns the kinds of INPUT, for help texts.
std::string input_help();

/// The options that say, or replace, what a volume file says about itself.
struct VolumeOptions {
  std::string dimensions, type, axes, spacing, origin, centering, array, series, component;
  bool big_endian = false;
  std::size_t skip_bytes = 0;
  std::optional<int> components, level;
  std::vector<Option*> given;  ///< all of them, to ask which were used

  /// Adds the options; `--array` and `--axes` where no other option of the command has this name.
  void add_to(CommandLine& command, bool with_array = true, bool with_axes = true);
  /// Throws UsageError where an option is used, saying that it does not apply to `what`.
  void refuse(const std::string& what) const;
  ReadOptions read_options() const;
};

/// Returns whether the text names the axes of an array: x, y and z, and c or t, in any order.
bool is_array_axes(const std::string& text);

/// Returns the source of the input: "builtin:NAME[:POINTS]" or a volume file. Throws Error.
FieldSource field_source(const std::string& input, const VolumeOptions& options);
/// Has notes on what is read printed, unless it is to be quiet.
void set_notes(FieldSource& field, bool quiet);
void set_notes(std::vector<ChannelSource>& channels, bool quiet);
/// Returns a channel of "NAME=SOURCE". Of a file the options say the rest; a component in brackets
/// goes before theirs. Throws Error.
ChannelSource channel_source(const std::string& text, const VolumeOptions& options);
/// Throws UsageError where an option is used, but none of the channels is a file.
void refuse_options_without_files(const std::vector<ChannelSource>& channels,
                                  const VolumeOptions& options);

}  // namespace pellucid::cli
