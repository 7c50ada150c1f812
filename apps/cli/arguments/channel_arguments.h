// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "command_line.h"
#include "input.h"
#include "overwriting.h"
#include "pellucid/io/channel_source.h"

namespace pellucid::cli {

/// Data arguments of `histogram` and `suggest`.
struct ChannelArguments {
  std::vector<std::string> inputs;    ///< FILE …
  std::vector<std::string> channels;  ///< NAME=SOURCE
  std::string axes;                   ///< NAME,NAME; empty: the default
  int threads = 0;
  VolumeOptions volume;
  std::string command;  ///< its name, for messages

  void add_to(CommandLine& app);
  /// Returns whether the input is one volume alone, whose channels have the names that they have in
  /// a scene.
  bool is_one_volume() const { return inputs.size() == 1 && channels.empty(); }
  /// Returns the inputs, for messages.
  std::string source_text() const;
};

/// Which channels, where they come from, and which of them are looked at.
struct ChannelSelection {
  std::vector<ChannelSource> sources;  ///< of the axes, and of what these are made of
  std::vector<std::string> axes;       ///< names, in the order asked for
};

/// Returns names of the channels of files: "value" of a single one, else what stands before the
/// first dot of each file's name, without what no name may hold, and "_2" and so on where that was
/// there.
std::vector<std::string> file_channel_names(const std::vector<std::string>& inputs);

/// Selects at most `most` axes. Throws UsageError where there is nothing, a name is not there or
/// stands twice, or there are more.
ChannelSelection select_channels(const ChannelArguments& arguments, int most);

/// The channels, read and made, and the index of each axis in them.
struct LoadedChannels {
  Channels channels;
  std::vector<int> which;
};
LoadedChannels load_channels(const ChannelSelection& selection, int threads, bool quiet = false);

/// Returns the files that are read, to be kept from being written.
std::vector<NamedFile> data_files(const std::vector<ChannelSource>& sources);

}  // namespace pellucid::cli
