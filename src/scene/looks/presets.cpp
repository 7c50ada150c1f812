// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/presets.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mean_chord.h"
#include "message.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/look.h"
#include "pellucid/scene/srgb.h"
#include "preset_points.h"
#include "readable_numbers.h"
#include "value_sample.h"

namespace pellucid {
namespace {

/// Scale of relative presets.
struct Scale {
  double first = 0, last = 1;
  double chord = 1;
};

/// Values above this share of the range are no air, and the last point of a preset that is relative
/// to tissue lies at so many of their medians.
constexpr double air = 0.125, medians = 1.65;

template <class Data>
Scale scale_of(PresetScale kind, const Data& data, double chord) {
  if (kind == PresetScale::hounsfield) return {};
  const std::vector<double> sample = value_sample(data);
  if (sample.empty()) return {0, 1, chord};
  const double first = sample.front(), last = sample.back();
  if (kind == PresetScale::range || !(first < last)) return {first, last, chord};
  const auto tissue = std::upper_bound(sample.begin(), sample.end(), first + air * (last - first));
  const double median = *(tissue + (sample.end() - tissue) / 2);
  return {first, first + medians * (median - first), chord};
}

TransferFunction make(const NamedPreset& preset, const Scale& scale,
                      const std::optional<std::array<double, 2>>& range) {
  const std::vector<PresetPoint> points = preset.points();
  const double begin = points.front().at, end = points.back().at;
  const bool hounsfield = preset.scale == PresetScale::hounsfield;
  double first = hounsfield ? begin : scale.first;
  double last = hounsfield ? end : scale.last;
  if (range) {
    first = (*range)[0];
    last = (*range)[1];
  }
  // Data of one value: what is above it is not there.
  if (!(first < last)) last = first + std::max(std::abs(first), 1.0);
  const bool as_written = hounsfield && !range;
  std::vector<TransferFunction::Point> made;
  for (const PresetPoint& p : points) {
    const double share = (p.at - begin) / (end - begin);
    const double value =
        std::clamp(first + share * (last - first), -largest_data_value, largest_data_value);
    // Five digits tell the narrowest peaks apart.
    const double place = as_written || range ? value
                                             : std::clamp(readable(value, (last - first) / 100),
                                                          -largest_data_value, largest_data_value);
    const double extinction = hounsfield ? p.strength : two_digits(p.strength / scale.chord);
    const Rgb<double> color = srgb_to_linear(p.srgb);
    const Rgb<double> rounded_color{rounded(color.r, 3), rounded(color.g, 3), rounded(color.b, 3)};
    // Two at one value, of a range that is a few doubles wide.
    if (!made.empty() && !(made.back().value < place)) continue;
    made.push_back(
        {as_written ? p.at : place, std::min(extinction, largest_number), rounded_color});
  }
  return TransferFunction(std::move(made));
}

const NamedPreset& named(std::string_view name) {
  for (const NamedPreset& preset : named_presets()) {
    if (preset.name == name) return preset;
  }
  std::string names;
  for (const NamedPreset& preset : named_presets()) {
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  }
  throw Error("preset: there is none of the name \"" + std::string(name.substr(0, 64)) +
              "\"; there are " + names);
}

void check(const std::optional<std::array<double, 2>>& range) {
  if (!range) return;
  const auto [a, b] = *range;
  if (a < b && std::abs(a) <= largest_data_value && std::abs(b) <= largest_data_value) return;
  throw Error("preset: the range is " + number(a) + " to " + number(b) +
              ", but must be two ascending numbers up to 2.1e37");
}

/// Returns the range that a preset in Hounsfield units has for these data; none: its own.
/// `air_value`: that of air, if they seem to be in those units or a multiple of them.
std::optional<std::array<double, 2>> hounsfield_range(const NamedPreset& preset,
                                                      const VolumeStatistics& data,
                                                      const std::optional<double>& air_value) {
  const std::vector<PresetPoint> points = preset.points();
  const std::array<double, 2> own{points.front().at, points.back().at};
  if (air_value) {
    if (*air_value == -1000) return std::nullopt;
    return std::array{own[0] + *air_value + 1000, own[1] + *air_value + 1000};
  }
  check_hounsfield("preset " + std::string(preset.name) + " (" + number(own[0]) + " to " +
                       number(own[1]) + " unless a range moves it)",
                   data);
  return std::nullopt;
}

}  // namespace

std::span<const Preset> presets() noexcept {
  static const std::vector<Preset> list = [] {
    std::vector<Preset> made;
    for (const NamedPreset& preset : named_presets()) {
      made.push_back(
          {preset.name, preset.description, preset.scale == PresetScale::hounsfield, preset.lit});
    }
    return made;
  }();
  return list;
}

const Preset* find_preset(std::string_view name) noexcept {
  const std::span<const Preset> list = presets();
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const Preset& preset) { return preset.name == name; });
  return found == list.end() ? nullptr : &*found;
}

TransferFunction make_preset(std::string_view name, const Volume& volume,
                             const std::optional<std::array<double, 2>>& range) {
  const NamedPreset& preset = named(name);
  check(range);
  if (preset.scale == PresetScale::hounsfield && !range) {
    const auto moved = hounsfield_range(preset, volume.statistics(), hounsfield_air(volume));
    return make(preset, {}, moved);
  }
  return make(preset, scale_of(preset.scale, volume, mean_chord(volume)), range);
}

TransferFunction make_preset(std::string_view name, const MeshChannels& mesh,
                             const std::optional<std::array<double, 2>>& range) {
  const NamedPreset& preset = named(name);
  check(range);
  if (preset.scale == PresetScale::hounsfield && !range) {
    return make(preset, {}, hounsfield_range(preset, mesh.statistics(0), std::nullopt));
  }
  return make(preset, scale_of(preset.scale, mesh, mean_chord(mesh.mesh().bounds())), range);
}

}  // namespace pellucid
