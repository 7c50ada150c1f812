// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/channel_source.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "pellucid/scene/derived_channels.h"
#include "pellucid/scene/error.h"
#include "pellucid/transfer/gaussian.h"
#include "text/printable.h"

namespace pellucid {
namespace {

using Kind = DerivedSource::Kind;

constexpr std::array kinds{Kind::gradient_magnitude, Kind::second_derivative, Kind::smoothed};

[[noreturn]] void fail(std::string_view text, const std::string& what) {
  throw Error("channel " + printable(text) + ": " + what);
}

std::string no_name(std::string_view name) {
  return "\"" + printable(name) +
         "\" is no name of a channel; give 1 to 64 bytes without spaces and , : ; = ~";
}

/// Cuts off and returns the text before the first such character, which goes with it.
std::string_view cut(std::string_view& rest, char separator) {
  const std::size_t at = rest.find(separator);
  const std::string_view part = rest.substr(0, at);
  rest.remove_prefix(at == std::string_view::npos ? rest.size() : at + 1);
  return part;
}

/// Returns the C of "FILE[C]", which is taken off.
std::optional<int> take_component(std::string_view& text) {
  const std::size_t open = text.rfind('[');
  if (!text.ends_with(']') || open == std::string_view::npos) return std::nullopt;
  int component = 0;
  const char* const end = text.data() + text.size() - 1;
  const auto result = std::from_chars(text.data() + open + 1, end, component);
  if (result.ec != std::errc() || result.ptr != end || component < 0) return std::nullopt;
  text = text.substr(0, open);
  return component;
}

double sigma_of(std::string_view text, std::string_view number) {
  double sigma = 0;
  const char* const end = number.data() + number.size();
  const auto result = std::from_chars(number.data(), end, sigma);
  if (result.ec != std::errc() || result.ptr != end || !(sigma > 0) || !std::isfinite(sigma)) {
    fail(text, "\"" + printable(number) +
                   "\" is no standard deviation; give a positive length in world units, as in "
                   "smoothed:CHANNEL:2.5");
  }
  return sigma;
}

/// Reads "KIND:CHANNEL" or "smoothed:CHANNEL:SIGMA".
DerivedSource derived_source(std::string_view text, Kind kind, std::string_view rest) {
  DerivedSource source{kind, std::string(cut(rest, ':')), 0};
  if (source.channel.empty())
    fail(text, "it does not say of which channel; name it behind the colon");
  if (kind == Kind::smoothed) {
    source.sigma = sigma_of(text, rest);
  } else if (!rest.empty()) {
    fail(text, "\"" + printable(rest) + "\" stands behind the channel; remove it");
  }
  return source;
}

Volume derive(const Volume& volume, const DerivedSource& source, const ParallelFor& parallel) {
  switch (source.kind) {
    case Kind::gradient_magnitude:
      return gradient_magnitude(volume, parallel);
    case Kind::second_derivative:
      return second_derivative(volume, parallel);
    case Kind::smoothed:
      break;
  }
  return smoothed(volume, source.sigma, parallel);
}

}  // namespace

std::string_view derived_name(Kind kind) noexcept {
  switch (kind) {
    case Kind::gradient_magnitude:
      return "gradient_magnitude";
    case Kind::second_derivative:
      return "second_derivative";
    case Kind::smoothed:
      break;
  }
  return "smoothed";
}

bool is_channel_name(std::string_view name) noexcept {
  constexpr std::size_t longest = 64;
  return !name.empty() && name.size() <= longest &&
         std::none_of(name.begin(), name.end(), [](char c) {
           return static_cast<unsigned char>(c) <= ' ' || c == '\x7f' ||
                  std::string_view(",:;=~").find(c) != std::string_view::npos;
         });
}

std::string to_channel_name(std::string_view text) {
  constexpr std::size_t longest = 56;  // leaves room for a number behind it
  std::string name;
  for (const char c : text.substr(0, longest)) {
    name += is_channel_name(std::string_view(&c, 1)) ? c : '_';
  }
  return name.empty() ? "channel" : name;
}

ChannelSource parse_channel_source(std::string_view text) {
  std::string_view rest = text;
  const std::string_view name = cut(rest, '=');
  if (name.size() == text.size()) {
    fail(text, "expected NAME=SOURCE, as in t1=T1.nii.gz or edge=gradient_magnitude:t1");
  }
  if (!is_channel_name(name)) {
    fail(text, no_name(name));
  }
  for (const Kind kind : kinds) {
    const std::string_view word = derived_name(kind);
    if (rest != word && !rest.starts_with(std::string(word) + ":")) continue;
    cut(rest, ':');
    return {std::string(name), "", derived_source(text, kind, rest)};
  }
  const std::optional<int> component = take_component(rest);
  FieldSource field = parse_field_source(rest);
  if (component && !field.builtin.empty()) {
    fail(text, "a built-in field has no components; remove the brackets");
  }
  field.options.component = component;
  return {std::string(name), "", std::move(field)};
}

std::vector<std::string> channel_names(const std::vector<ChannelSource>& sources) {
  std::vector<std::string> names;
  names.reserve(sources.size());
  for (const ChannelSource& source : sources) names.push_back(source.name);
  return names;
}

void check_channel_sources(const std::vector<ChannelSource>& sources) {
  if (sources.empty() || sources.size() > static_cast<std::size_t>(max_channels)) {
    throw Error("channels: there are " + std::to_string(sources.size()) +
                ", but must be from 1 to 8");
  }
  for (auto source = sources.begin(); source != sources.end(); ++source) {
    const auto before = [&](std::string_view name) {
      return std::any_of(sources.begin(), source,
                         [&](const ChannelSource& other) { return other.name == name; });
    };
    if (!is_channel_name(source->name)) {
      throw Error("channels: " + no_name(source->name));
    }
    if (before(source->name)) {
      throw Error("channels: the name \"" + printable(source->name) +
                  "\" stands twice; give each channel its own");
    }
    const auto* derived = std::get_if<DerivedSource>(&source->source);
    if (derived != nullptr && !before(derived->channel)) {
      throw Error("channels: \"" + printable(source->name) + "\" is made of a channel \"" +
                  printable(derived->channel) + "\", which is not before it; name one that is");
    }
  }
}

Channels load_channels(const std::vector<ChannelSource>& sources, const ParallelFor& parallel,
                       const std::vector<Channel>& kept) {
  check_channel_sources(sources);
  std::vector<Channel> channels;
  for (const ChannelSource& source : sources) {
    const auto known = std::ranges::find(kept, source.name, &Channel::name);
    if (known != kept.end()) {
      channels.push_back({source.name, source.unit, known->volume});
      continue;
    }
    if (const auto* field = std::get_if<FieldSource>(&source.source)) {
      channels.push_back(
          {source.name, source.unit, std::make_shared<const Volume>(load_field(*field))});
      continue;
    }
    const auto& derived = std::get<DerivedSource>(source.source);
    const auto of = std::find_if(channels.begin(), channels.end(),
                                 [&](const Channel& c) { return c.name == derived.channel; });
    auto volume = std::make_shared<const Volume>(derive(*of->volume, derived, parallel));
    channels.push_back({source.name, source.unit, std::move(volume)});
  }
  return Channels(std::move(channels));
}

}  // namespace pellucid
