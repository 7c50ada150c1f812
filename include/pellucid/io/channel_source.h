// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pellucid/io/field_source.h"
#include "pellucid/scene/channels.h"

namespace pellucid {

/// A channel that is computed from another one by scene/derived_channels.h.
struct DerivedSource {
  enum class Kind { gradient_magnitude, second_derivative, smoothed };
  Kind kind = Kind::gradient_magnitude;
  std::string channel;  ///< name of an earlier channel
  double sigma = 0;     ///< smoothed: standard deviation in world units
};

/// A channel as named in a scene; nothing has been read yet.
struct ChannelSource {
  std::string name;
  std::string unit;
  std::variant<FieldSource, DerivedSource> source;
};

/// The name by which Gaussians refer to a scene's single field.
inline constexpr std::string_view field_channel = "value";
/// Returns "gradient_magnitude", "second_derivative" or "smoothed".
std::string_view derived_name(DerivedSource::Kind kind) noexcept;

/// Parses "NAME=SOURCE". SOURCE is a field (parse_field_source()), "FILE[C]" (component C of a file
/// with several), "gradient_magnitude:CHANNEL", "second_derivative:CHANNEL" or
/// "smoothed:CHANNEL:SIGMA". Throws Error.
ChannelSource parse_channel_source(std::string_view text);

/// Returns whether the text is a valid name: 1 to 64 bytes without spaces, control characters and ,
/// : ; = ~ which delimit names on command lines.
bool is_channel_name(std::string_view name) noexcept;
/// Returns a valid name for a text: at most 56 bytes of it, with "_" in place of invalid
/// characters.
std::string to_channel_name(std::string_view text);

/// Returns the names of the channels.
std::vector<std::string> channel_names(const std::vector<ChannelSource>& sources);

/// Throws Error if there is no channel or more than eight, a name is invalid or a duplicate, or a
/// derived channel refers to one that is not before it.
void check_channel_sources(const std::vector<ChannelSource>& sources);

/// Reads each field once and computes the derived channels. A channel of `kept` with the name of a
/// source takes its place. Throws Error.
Channels load_channels(const std::vector<ChannelSource>& sources, const ParallelFor& parallel = {},
                       const std::vector<Channel>& kept = {});

}  // namespace pellucid
