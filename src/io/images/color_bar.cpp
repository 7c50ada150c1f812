// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/color_bar.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <variant>

#include "cairo_module.h"
#include "legend_panel.h"
#include "pellucid/io/internal/module.h"
#include "pellucid/scene/color_map.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/axis_ticks.h"
#include "pellucid/scene/srgb.h"

namespace pellucid {
namespace {

constexpr Module cairo{"pellucid_cairo.so", "draws color bars", "Cairo (Debian: libcairo2-dev)"};
/// Labels that a legend names; of more it says how many.
constexpr std::size_t max_entries = 12;
/// Colors of a bar, and the optical depth that its strip of opacity shows the densest value with.
constexpr int samples = 1024;
constexpr double depth_shown = 3;

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " (" + unit + ")";
}

/// Returns the name of a field: its array, or its file without folder and extensions.
std::string field_name(const FieldSource& field) {
  if (!field.builtin.empty()) return field.builtin;
  if (field.file == array_in_memory) return {};
  if (field.options.array) return *field.options.array;
  std::string name = field.file.filename().string();
  for (const char* const end : {".gz", ".bz2", ".zst"}) {
    if (name.ends_with(end)) name.resize(name.size() - std::string(end).size());
  }
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos || dot == 0 ? name : name.substr(0, dot);
}

bool absorbs(const TransferFunction& function) {
  return std::ranges::any_of(function.points(),
                             [](const auto& point) { return point.extinction > 0; });
}

void add_labels(const LabelTable& table, const LabelVolume& labels, ColorBar& bar) {
  const std::set<std::int32_t> there(labels.labels().begin(), labels.labels().end());
  std::size_t left_out = 0;
  for (const LabelStyle& style : table.styles()) {
    if (!(style.extinction > 0) || there.count(style.label) == 0) continue;
    if (bar.entries.size() == max_entries) {
      ++left_out;
      continue;
    }
    bar.entries.push_back(
        {style.name.empty() ? std::to_string(style.label) : style.name, style.color});
  }
  if (left_out > 0) bar.title += " (and " + std::to_string(left_out) + " more)";
}

/// Returns the name of a variable with its unit.
std::string channel_title(const Layer& layer, int channel) {
  if (const auto* const channels = std::get_if<ChannelsContent>(&layer.content)) {
    const Channel& shown = (*channels->channels)[channel];
    return with_unit(shown.name, shown.unit);
  }
  const auto* const mesh = std::get_if<MeshContent>(&layer.content);
  if (mesh == nullptr) return {};
  return with_unit((*mesh->mesh)[channel].name, (*mesh->mesh)[channel].unit);
}

/// Returns the middle of a Gaussian, of the variables that it depends on: "t1 300, t2 80".
std::string gaussian_name(const Layer& layer, const GaussianPrimitive& gaussian) {
  std::string name;
  for (std::size_t c = 0; c < gaussian.channels.size(); ++c) {
    const bool depends = std::ranges::any_of(
        gaussian.matrix, [&](const std::vector<double>& row) { return row[c] != 0; });
    if (!depends) continue;
    name += (name.empty() ? "" : ", ") + channel_title(layer, gaussian.channels[c]) + " " +
            short_number(gaussian.center[c]);
  }
  return name.empty() ? "all values" : name;
}

/// Adds the legends of a function of several variables: a bar for each of its functions of one of
/// them, and an entry for each Gaussian.
void add_terms(const Layer& layer,
               const std::shared_ptr<const MultivariateTransferFunction>& function,
               std::vector<ColorBar>& bars) {
  for (const ChannelTransferFunction& table : function->tables()) {
    if (!absorbs(table.function)) continue;
    ColorBar bar;
    bar.title = channel_title(layer, table.channel);
    bar.function = std::shared_ptr<const TransferFunction>(function, &table.function);
    bar.range = absorbing_range(table.function);
    bars.push_back(std::move(bar));
  }
  ColorBar legend;
  legend.title = layer.name;
  std::size_t left_out = 0;
  for (const GaussianPrimitive& gaussian : function->primitives()) {
    if (!(gaussian.extinction > 0)) continue;
    if (legend.entries.size() == max_entries) {
      ++left_out;
      continue;
    }
    legend.entries.push_back({gaussian_name(layer, gaussian), gaussian.color});
  }
  if (left_out > 0) legend.title += " (and " + std::to_string(left_out) + " more)";
  if (!legend.entries.empty()) bars.push_back(std::move(legend));
}

/// Returns the function of several variables of a layer; null: it has none.
std::shared_ptr<const MultivariateTransferFunction> function_of_several(const Layer& layer) {
  if (const auto* const channels = std::get_if<ChannelsContent>(&layer.content)) {
    return channels->transfer_function;
  }
  const auto* const mesh = std::get_if<MeshContent>(&layer.content);
  if (mesh == nullptr || mesh->multivariate() == nullptr) return nullptr;
  return std::get<std::shared_ptr<const MultivariateTransferFunction>>(mesh->transfer_function);
}

/// Returns the function that a layer's legend shows; null: none.
std::shared_ptr<const TransferFunction> shown_function(const Layer& layer, bool& shows_opacity) {
  std::shared_ptr<const TransferFunction> function;
  if (const auto* const volume = std::get_if<VolumeContent>(&layer.content)) {
    function = volume->transfer_function;
  } else if (const auto* const mesh = std::get_if<MeshContent>(&layer.content);
             mesh != nullptr && mesh->univariate() != nullptr) {
    function = std::get<std::shared_ptr<const TransferFunction>>(mesh->transfer_function);
  }
  if (function && absorbs(*function)) return function;
  shows_opacity = false;
  for (const Slice& slice : layer.slices) {
    if (slice.colors || function) return slice.colors ? slice.colors : function;
  }
  for (const Isosurface& surface : layer.isosurfaces) {
    if (surface.colors) return surface.colors;
  }
  return nullptr;
}

int shown_channel(const Layer& layer) {
  if (!layer.slices.empty()) return layer.slices.front().channel;
  for (const Isosurface& surface : layer.isosurfaces) {
    if (surface.colors) return surface.color_channel;
  }
  return 0;
}

Signal signal_of(const Rgb<double>& light) {
  const auto channel = [](double x) { return linear_to_srgb(std::clamp(x, 0.0, 1.0)); };
  return {channel(light.r), channel(light.g), channel(light.b), 1};
}

DrawLegends* draw_legends() {
  return reinterpret_cast<DrawLegends*>(module_function(cairo, draw_legends_name));
}

/// Puts a pixel of Cairo over one of linear light.
void put_over(std::uint32_t argb, std::array<float, 4>& pixel) {
  const double alpha = (argb >> 24U) / 255.0;
  if (alpha == 0) return;
  for (std::size_t c = 0; c < 3; ++c) {
    const double signal = ((argb >> (16U - 8U * c)) & 0xFFU) / 255.0 / alpha;
    const double light = alpha * srgb_to_linear(std::min(signal, 1.0));
    pixel[c] = static_cast<float>(light + (1 - alpha) * static_cast<double>(pixel[c]));
  }
  pixel[3] = static_cast<float>(alpha + (1 - alpha) * static_cast<double>(pixel[3]));
}

}  // namespace

BarSamples sample_bar(const ColorBar& bar, int count) {
  BarSamples samples;
  if (!bar.function) return samples;
  double densest = 0;
  for (const auto& point : bar.function->points()) densest = std::max(densest, point.extinction);
  const auto view = bar.function->view<double>();
  const auto in_range = [](double x) { return std::clamp(x, 0.0, 1.0); };
  for (int i = 0; i < count; ++i) {
    const double share = (i + 0.5) / count;
    const auto at = view.evaluate((1 - share) * bar.range[0] + share * bar.range[1]);
    samples.colors.push_back({in_range(at.color.r), in_range(at.color.g), in_range(at.color.b)});
    if (!bar.shows_opacity || !(densest > 0)) continue;
    samples.opacity.push_back(1 - std::exp(-depth_shown * at.extinction / densest));
  }
  return samples;
}

LegendPanel panel_of(const ColorBar& bar) {
  LegendPanel panel;
  panel.title = bar.title;
  panel.range = bar.range;
  for (const ColorBar::Entry& entry : bar.entries) {
    panel.entries.push_back({entry.name, signal_of(entry.color)});
  }
  BarSamples sampled = sample_bar(bar, samples);
  for (const Rgb<double>& color : sampled.colors) panel.colors.push_back(signal_of(color));
  panel.opacity = std::move(sampled.opacity);
  return panel;
}

std::string variable_title(const LayerDescription& description, const Layer& layer, int channel) {
  if (const auto* const mesh = std::get_if<MeshContent>(&layer.content)) {
    const MeshChannel& shown = (*mesh->mesh)[channel];
    const auto index = static_cast<std::size_t>(channel);
    const bool known = description.mesh && index < description.mesh->channels.size();
    const std::string name = known ? description.mesh->channels[index].array : shown.name;
    return with_unit(layer.name.empty() ? name : layer.name, shown.unit);
  }
  if (const auto* const channels = std::get_if<ChannelsContent>(&layer.content)) {
    const Channel& shown = (*channels->channels)[channel];
    return with_unit(shown.name, shown.unit);
  }
  const FieldSource& field = description.labels ? description.labels->field : description.field;
  // Layers that are files beside another one have the names of these, with their endings.
  const bool is_file = layer.name.empty() || layer.name == field.file.filename().string();
  return is_file ? field_name(field) : layer.name;
}

std::vector<ColorBar> color_bars(const SceneDescription& description, const Scene& scene) {
  std::vector<ColorBar> bars;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const Layer& layer = scene.layers[i];
    if (!layer.visible) continue;
    if (const auto function = function_of_several(layer)) add_terms(layer, function, bars);
    ColorBar bar;
    bar.function = shown_function(layer, bar.shows_opacity);
    const int channel = bar.shows_opacity ? 0 : shown_channel(layer);
    bar.title = variable_title(description.layers[i], layer, channel);
    if (bar.function) bar.range = absorbing_range(*bar.function);
    for (const Isosurface& surface : layer.isosurfaces) {
      if (surface.colors) continue;
      bar.entries.push_back({short_number(surface.value), surface.color});
    }
    if (const auto* const labels = std::get_if<LabelContent>(&layer.content)) {
      add_labels(*labels->table, *labels->labels, bar);
    }
    if (bar.function || !bar.entries.empty()) bars.push_back(std::move(bar));
  }
  return bars;
}

void check_draws_color_bars() {
  draw_legends();
}

Image with_color_bars(const Image& image, const std::vector<ColorBar>& bars) {
  std::vector<LegendPanel> panels;
  panels.reserve(bars.size());
  for (const ColorBar& bar : bars) panels.push_back(panel_of(bar));
  std::vector<std::uint32_t> argb;
  std::string error;
  (*draw_legends())(image.width, image.height, panels, argb, error);
  if (!error.empty()) throw Error("color bar: " + error);
  Image drawn;
  drawn.width = image.width;
  drawn.height = image.height;
  drawn.pixels = image.pixels;
  drawn.metadata = image.metadata;
  for (std::size_t i = 0; i < drawn.pixels.size(); ++i) put_over(argb[i], drawn.pixels[i]);
  return drawn;
}

}  // namespace pellucid
