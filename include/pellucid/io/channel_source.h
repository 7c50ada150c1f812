// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pellucid/io/field_source.h"
#include "pellucid/scene/channels.h"

namespace pellucid {

/// A channel made of another one by scene/derived_channels.h.
struct DerivedSource {
  enum class Kind { gradient_magnitude, second_derivative, smoothed };
  Kind kind = Kind::gradient_magnitude;
  std::string channel;  ///< the name of a channel before this one
  double sigma = 0;     ///< of smoothed: the standard deviation, world length
};

/// A channel as a scene names it: nothing is read yet.
struct ChannelSource {
  std::string name;
  std::string unit;
  std::variant<FieldSource, DerivedSource> source;
};

/// The name of a scene's one field where Gaussians look at it.
inline constexpr std::string_view field_channel = "value";
/// "gradient_magnitude", "second_derivative", "smoothed".
std::string_view derived_name(DerivedSource::Kind kind) noexcept;

/// "NAME=SOURCE": a field (parse_field_source), "FILE[C]" (component C of a file that has several),
/// "gradient_magnitude:CHANNEL", "second_derivative:CHANNEL" or "smoothed:CHANNEL:SIGMA". Throws
/// Error.
ChannelSource parse_channel_source(std::string_view text);

/// A name is 1 to 64 bytes without spaces, control characters and , : ; = ~ which stand around
/// names on command lines.
bool is_channel_name(std::string_view name) noexcept;
/// What a name may hold of a text, at most 56 bytes, and "_" in the place of the rest.
std::string to_channel_name(std::string_view text);

std::vector<std::string> channel_names(const std::vector<ChannelSource>& sources);

/// Throws Error where there are none or more than eight, a name is not one or stands twice, or a
/// derived channel is not made of one before it.
void check_channel_sources(const std::vector<ChannelSource>& sources);

/// Reads the fields, each once, and computes the others. Throws Error.
Channels load_channels(const std::vector<ChannelSource>& sources, const ParallelFor& parallel = {});

}  // namespace pellucid
